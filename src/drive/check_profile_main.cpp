// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// check_profile FILE: says what is wrong with a drive profile, or that nothing is.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "util/text.h"

#include "inverter_bus/drive/profile.h"

namespace
{
const char* const USAGE =
    "usage: check_profile [--help] [--] FILE\n"
    "Says what is wrong with a drive profile (one line per mistake, exit status 1), or what it holds (exit status "
    "0).\n";

void printSummary(const std::string& path, const inverter_bus::drive::Profile& profile)
{
  std::printf("%s: ok, %zu parameters, %zu status items, %zu commands, %zu trip texts\n", path.c_str(),
              profile.parameters.size(), profile.status.size(), profile.sequences.size(), profile.faults.size());
  if (!profile.unconfirmed.empty())
  {
    std::printf("%s: unconfirmed commands and monitors: %s\n", path.c_str(),
                inverter_bus::util::joined(profile.unconfirmed).c_str());
  }
  if (!profile.unconfirmed_tables.empty())
  {
    std::printf("%s: unconfirmed parameters, ranges and texts: %s\n", path.c_str(),
                inverter_bus::util::joined(profile.unconfirmed_tables).c_str());
  }
}
}  // namespace

int main(int argc, char** argv)
{
  std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  const bool only_files = !arguments.empty() && arguments.front() == "--";
  if (only_files)
  {
    arguments.erase(arguments.begin());
  }
  const std::string first = arguments.empty() ? "" : arguments.front();
  if (!only_files && (first == "-h" || first == "--help"))
  {
    std::fputs(USAGE, stdout);
    return 0;
  }
  const bool option = !only_files && !first.empty() && first[0] == '-';
  if (arguments.size() != 1 || option)
  {
    std::fprintf(stderr, "%s%s", option ? ("unknown option '" + first + "'\n").c_str() : "", USAGE);
    return 2;
  }
  const std::string& path = first;
  const std::vector<std::string> mistakes = inverter_bus::drive::checkProfile(path);
  for (const std::string& mistake : mistakes)
  {
    std::printf("%s\n", mistake.c_str());
  }
  if (!mistakes.empty())
  {
    return 1;
  }
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(path, error);
  try
  {
    printSummary(path, inverter_bus::drive::loadProfile(absolute.string(), ""));
  }
  catch (const inverter_bus::drive::ConfigurationError& changed)
  {
    std::printf("%s\n", changed.what());
    return 1;
  }
  return 0;
}

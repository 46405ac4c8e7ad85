// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/command_line.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
/// As most programs answer a wrong command line.
constexpr int WRONG_USAGE = 2;

bool isHelp(const std::string& argument)
{
  return argument == "-h" || argument == "--help";
}

bool isRemapping(const std::string& argument)
{
  const std::size_t place = argument.find(":=");
  return place != std::string::npos && place > 0 && argument[0] != '-';
}
}  // namespace

std::optional<CommandLineAnswer> judgeCommandLine(const std::vector<std::string>& arguments, const std::string& usage)
{
  if (std::any_of(arguments.begin(), arguments.end(), isHelp))
  {
    return CommandLineAnswer{ 0, usage };
  }
  const auto wrong = std::find_if_not(arguments.begin(), arguments.end(), isRemapping);
  if (wrong == arguments.end())
  {
    return std::nullopt;
  }
  return CommandLineAnswer{ WRONG_USAGE,
                            "argument '" + *wrong + "': allowed: --help and ROS remappings (name:=value)\n" + usage };
}

std::optional<int> answerCommandLine(int argc, const char* const* argv, const std::string& usage)
{
  const auto answer =
      judgeCommandLine(argc > 1 ? std::vector<std::string>(argv + 1, argv + argc) : std::vector<std::string>(), usage);
  if (!answer)
  {
    return std::nullopt;
  }
  std::fputs(answer->text.c_str(), answer->status == 0 ? stdout : stderr);
  return answer->status;
}
}  // namespace ros_node
}  // namespace inverter_bus

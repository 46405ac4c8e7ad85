// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/problems.h"

#include <cstddef>

#include "inverter_bus/drive/profile.h"
#include "util/printable.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
/// Whoever has more mistakes than these mends the first ones first.
constexpr std::size_t MOST_LINES = 50;

std::string lineOf(const std::string& where, const std::string& key, const std::string& what)
{
  return oneLine(where + ": " + (key.empty() ? "" : "key '" + util::printable(key) + "': ") + what);
}
}  // namespace

std::string oneLine(const std::string& text)
{
  constexpr std::size_t LONGEST = 1000;
  return util::printable(text, LONGEST);
}

void Problems::add(const std::string& where, const std::string& key, const std::string& what)
{
  if (lines_.size() >= MOST_LINES)
  {
    ++more_;
    return;
  }
  lines_.push_back(lineOf(where, key, what));
}

void Problems::addHarmless(const std::string& where, const std::string& key, const std::string& what)
{
  if (harmless_.size() < MOST_LINES)
  {
    harmless_.push_back(lineOf(where, key, what));
  }
}

const std::vector<std::string>& Problems::harmless() const
{
  return harmless_;
}

bool Problems::empty() const
{
  return lines_.empty();
}

std::vector<std::string> Problems::lines() const
{
  std::vector<std::string> lines = lines_;
  if (more_ > 0)
  {
    lines.push_back("... and " + std::to_string(more_) + " more mistakes");
  }
  return lines;
}
}  // namespace drive
}  // namespace inverter_bus

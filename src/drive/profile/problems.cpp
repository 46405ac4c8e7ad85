// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/problems.h"

#include "inverter_bus/drive/profile.h"
#include "util/printable.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
/// With more mistakes than these, the first ones are corrected first.
constexpr std::size_t MOST_LINES = 50;
}  // namespace

std::string oneLine(const std::string& text)
{
  constexpr std::size_t LONGEST = 1000;
  return util::printable(text, LONGEST);
}

void Problems::complain(const config::Spot& spot, const std::string& what)
{
  if (lines_.size() >= MOST_LINES)
  {
    ++more_;
    return;
  }
  lines_.push_back(config::lineOf(spot, what));
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

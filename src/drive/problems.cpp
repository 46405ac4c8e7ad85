// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "problems.h"

#include <algorithm>
#include <cstddef>

#include "inverter_bus/drive/profile.h"

namespace inverter_bus
{
namespace drive
{
std::string oneLine(const std::string& text)
{
  constexpr std::size_t LONGEST = 1000;
  std::string line = text.substr(0, LONGEST) + (text.size() > LONGEST ? " ..." : "");
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, ' ');
  return line;
}

void Problems::add(const std::string& where, const std::string& key, const std::string& what)
{
  lines_.push_back(oneLine(where + ": " + (key.empty() ? "" : "key '" + key + "': ") + what));
}

bool Problems::empty() const
{
  return lines_.empty();
}

const std::vector<std::string>& Problems::lines() const
{
  return lines_;
}
}  // namespace drive
}  // namespace inverter_bus

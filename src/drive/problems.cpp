// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "problems.h"

#include <algorithm>

namespace inverter_bus
{
namespace drive
{
void Problems::add(const std::string& where, const std::string& key, const std::string& what)
{
  std::string line = where + ": " + (key.empty() ? "" : "key '" + key + "': ") + what;
  // One mistake is one line, whatever a quoted YAML text contains.
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  lines_.push_back(line);
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

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_SHOW_LIST_H
#define INVERTER_BUS_SIMULATION_SHOW_LIST_H

#include <string>

#include "inverter_bus/simulation/simulated_drive.h"

namespace inverter_bus
{
namespace simulation
{
/// The words of `NAME show`, added one by one to a list that must outlive this.
class ShowList
{
public:
  explicit ShowList(KeyValues& values) : values_(values)
  {
  }

  void text(const char* key, const std::string& value)
  {
    values_.emplace_back(key, value);
  }

  template <typename Number>
  void number(const char* key, Number value)
  {
    text(key, std::to_string(value));
  }

  void flag(const char* key, bool value)
  {
    text(key, value ? "1" : "0");
  }

private:
  KeyValues& values_;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_SHOW_LIST_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_CONFIG_VALUE_H
#define INVERTER_BUS_CONFIG_VALUE_H

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace inverter_bus
{
namespace config
{
/// A configuration value as the parameter server holds it, before anybody judged it.
struct Value
{
  enum class Type
  {
    None,
    Boolean,
    Integer,
    Number,
    Text,
    List,
    Map
  };
  Type type = Type::None;
  bool boolean = false;
  std::int64_t integer = 0;
  double number = 0.0;
  std::string text;
  std::vector<Value> list;
  std::map<std::string, Value> map;
};
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_CONFIG_VALUE_H

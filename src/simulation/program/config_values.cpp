// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/program/config_values.h"

#include <cmath>

#include "config/scalar.h"
#include "inverter_bus/simulation/bus_config.h"
#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
std::string describe(const Value* value)
{
  switch (value == nullptr ? Value::Type::None : value->type)
  {
    case Value::Type::Boolean:
      return value->boolean ? "true" : "false";
    case Value::Type::Integer:
      return std::to_string(value->integer);
    case Value::Type::Number:
      return config::numberInYaml(value->number);
    case Value::Type::Text:
      return util::printable(value->text);
    case Value::Type::List:
      return "a list";
    case Value::Type::Map:
      return "a map";
    default:
      return "nothing";
  }
}

bool is(const Value* value, Value::Type type)
{
  return value != nullptr && value->type == type;
}

std::string withHint(const Value* value, const std::string& allowed)
{
  const std::string hint = is(value, Value::Type::Text) ? config::hintFor(value->text) : "";
  return hint.empty() ? allowed : allowed + "; " + hint;
}
}  // namespace

void refuse(const std::string& place, const Value* value, const std::string& allowed)
{
  throw ConfigError(util::printable(place, 500) + ": " + describe(value) + " (allowed: " + allowed + ")");
}

const Value* find(const Value* map, const std::string& key)
{
  if (!is(map, Value::Type::Map))
  {
    return nullptr;
  }
  const auto found = map->map.find(key);
  return found == map->map.end() ? nullptr : &found->second;
}

const Value& toMap(const Value* value, const std::string& place, const std::string& allowed)
{
  if (!is(value, Value::Type::Map))
  {
    refuse(place, value, allowed);
  }
  return *value;
}

double toNumber(const Value* value, const std::string& place, double minimum, double maximum)
{
  double number = std::nan("");
  if (is(value, Value::Type::Integer))
  {
    number = static_cast<double>(value->integer);
  }
  else if (is(value, Value::Type::Number))
  {
    number = value->number;
  }
  else if (is(value, Value::Type::Text))
  {
    // As the driver does: 1e2 is a text to YAML, and nobody means one where a number is wanted.
    number = config::meantNumber(value->text).value_or(number);
  }
  if (!(number >= minimum && number <= maximum))
  {
    refuse(place, value,
           withHint(value, "a number, " + config::numberInYaml(minimum) + " to " + config::numberInYaml(maximum)));
  }
  return number;
}

int toInteger(const Value* value, const std::string& place, const std::set<int>& allowed)
{
  const bool known = is(value, Value::Type::Integer) && value->integer == static_cast<int>(value->integer) &&
                     allowed.count(static_cast<int>(value->integer)) != 0;
  if (!known)
  {
    refuse(place, value, util::joined(allowed));
  }
  return static_cast<int>(value->integer);
}

int toIntegerBetween(const Value* value, const std::string& place, int minimum, int maximum)
{
  if (!is(value, Value::Type::Integer) || value->integer < minimum || value->integer > maximum)
  {
    refuse(place, value, withHint(value, "an integer, " + std::to_string(minimum) + " to " + std::to_string(maximum)));
  }
  return static_cast<int>(value->integer);
}

bool toFlag(const Value* value, const std::string& place)
{
  if (!is(value, Value::Type::Boolean))
  {
    refuse(place, value, "true, false");
  }
  return value->boolean;
}

std::string toText(const Value* value, const std::string& place)
{
  if (!is(value, Value::Type::Text) || value->text.empty())
  {
    refuse(place, value, "text");
  }
  return value->text;
}

Parity toParity(const Value* value, const std::string& place)
{
  const std::string parity = is(value, Value::Type::Text) ? value->text : "";
  if (parity != "none" && parity != "even" && parity != "odd")
  {
    refuse(place, value, "none, even, odd");
  }
  return parity == "none" ? Parity::None : (parity == "even" ? Parity::Even : Parity::Odd);
}

bool readLineKey(const std::string& key, const Value& value, const std::string& place, LineSettings& line)
{
  if (key == "baud_rate")
  {
    // Whatever a drive or a port may have; which of them a drive really has it says itself.
    line.baud_rate = toIntegerBetween(&value, place, 300, 1000000);
  }
  else if (key == "data_bits")
  {
    line.data_bits = toInteger(&value, place, { 7, 8 });
  }
  else if (key == "stop_bits")
  {
    line.stop_bits = toInteger(&value, place, { 1, 2 });
  }
  else if (key == "parity")
  {
    line.parity = toParity(&value, place);
  }
  else
  {
    return false;
  }
  return true;
}
}  // namespace simulation
}  // namespace inverter_bus

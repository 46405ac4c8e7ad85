// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/config/value.h"

#include <algorithm>
#include <utility>

#include "config/numerals.h"
#include "config/scalar.h"

namespace inverter_bus
{
namespace config
{
namespace
{
bool sameKey(const std::string& a, const std::string& b)
{
  if (a == b)
  {
    return true;
  }
  // Only numbers can be spelled in two ways.
  const auto number = parseInteger(a);
  return number && number == parseInteger(b);
}
}  // namespace

Value Value::ofBoolean(bool boolean)
{
  Value value;
  value.type = Type::Boolean;
  value.boolean = boolean;
  value.text = boolean ? "true" : "false";
  return value;
}

Value Value::ofInteger(std::int64_t integer)
{
  Value value;
  value.type = Type::Integer;
  value.integer = integer;
  value.number = static_cast<double>(integer);
  value.text = std::to_string(integer);
  return value;
}

Value Value::ofNumber(double number)
{
  Value value;
  value.type = Type::Number;
  value.number = number;
  value.text = numberInYaml(number);
  return value;
}

Value Value::ofText(const std::string& text)
{
  Value value;
  value.type = Type::Text;
  value.text = text;
  return value;
}

Value Value::ofMap(std::vector<Entry> entries)
{
  Value value;
  value.type = Type::Map;
  value.map = std::move(entries);
  return value;
}

bool Value::isScalar() const
{
  return type != Type::None && type != Type::List && type != Type::Map;
}

Value* Value::find(const std::string& key)
{
  const auto found =
      std::find_if(map.begin(), map.end(), [&key](const Entry& entry) { return sameKey(entry.key, key); });
  return found == map.end() ? nullptr : &found->value;
}

const Value* Value::find(const std::string& key) const
{
  return const_cast<Value*>(this)->find(key);
}

void Value::erase(const std::string& key)
{
  map.erase(std::remove_if(map.begin(), map.end(), [&key](const Entry& entry) { return sameKey(entry.key, key); }),
            map.end());
}

void Value::inherit(const Value& defaults)
{
  for (const Entry& entry : defaults.map)
  {
    if (find(entry.key) == nullptr)
    {
      map.push_back(entry);
    }
  }
}

void Value::moveTo(const std::string& new_place)
{
  place = new_place;
  for (Value& element : list)
  {
    element.moveTo(new_place);
  }
  for (Entry& entry : map)
  {
    entry.value.moveTo(new_place);
  }
}
}  // namespace config
}  // namespace inverter_bus

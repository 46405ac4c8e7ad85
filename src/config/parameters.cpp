// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// From a file's tree to what the parameter server would hold.

#include <limits>

#include "config/yaml.h"
#include "util/printable.h"

namespace inverter_bus
{
namespace config
{
namespace
{
class Converter
{
public:
  explicit Converter(std::vector<YamlProblem>& problems) : problems_(problems)
  {
  }

  Value convert(const YamlNode& node, const std::string& path)
  {
    switch (node.kind)
    {
      case YamlNode::Kind::List:
        return convertList(node, path);
      case YamlNode::Kind::Map:
        return convertMap(node, path);
      default:
        return convertScalar(node, path);
    }
  }

private:
  Value convertList(const YamlNode& node, const std::string& path)
  {
    Value value;
    value.type = Value::Type::List;
    for (std::size_t i = 0; i < node.items.size(); ++i)
    {
      value.list.push_back(convert(node.items[i], path + "[" + std::to_string(i) + "]"));
    }
    return value;
  }

  Value convertMap(const YamlNode& node, const std::string& path)
  {
    Value value;
    value.type = Value::Type::Map;
    for (const YamlEntry& entry : node.entries)
    {
      const std::string key =
          path.empty() ? util::printable(entry.key.text) : path + "." + util::printable(entry.key.text);
      if (entry.key.type != Scalar::Type::Text)
      {
        problems_.push_back({ entry.line, key,
                              "the key '" + util::printable(entry.key.text) +
                                  "' is no text, and roslaunch can load no other: allowed: '" +
                                  util::printable(entry.key.text) + "' in quotes" });
      }
      value.map.emplace(entry.key.text, convert(entry.value, key));
    }
    return value;
  }

  Value convertScalar(const YamlNode& node, const std::string& path)
  {
    const Scalar& scalar = node.scalar;
    Value value;
    switch (scalar.type)
    {
      case Scalar::Type::Null:
        problems_.push_back({ node.line, path,
                              "has no value, and roslaunch can't load that: allowed: a value (a # begins a comment: "
                              "quotes around a text with it), or no such key" });
        break;
      case Scalar::Type::Boolean:
        value.type = Value::Type::Boolean;
        value.boolean = scalar.boolean;
        break;
      case Scalar::Type::Integer:
        value.type = Value::Type::Integer;
        value.integer = scalar.integer;
        checkSize(scalar.integer, node.line, path);
        break;
      case Scalar::Type::Number:
        value.type = Value::Type::Number;
        value.number = scalar.number;
        break;
      case Scalar::Type::Text:
        value.type = Value::Type::Text;
        value.text = scalar.text;
        break;
    }
    return value;
  }

  void checkSize(std::int64_t integer, int line, const std::string& path)
  {
    constexpr std::int64_t LOWEST = std::numeric_limits<std::int32_t>::min();
    constexpr std::int64_t HIGHEST = std::numeric_limits<std::int32_t>::max();
    if (integer < LOWEST || integer > HIGHEST)
    {
      problems_.push_back(
          { line, path,
            "value " + std::to_string(integer) +
                " has more than 32 bits, and roslaunch can't load that: allowed: " + std::to_string(LOWEST) + " to " +
                std::to_string(HIGHEST) + "; a bit mask with station 31 in quotes, '0x80000002'" });
    }
  }

  std::vector<YamlProblem>& problems_;
};
}  // namespace

Value toParameters(const YamlNode& node, std::vector<YamlProblem>& problems)
{
  return Converter(problems).convert(node, "");
}
}  // namespace config
}  // namespace inverter_bus

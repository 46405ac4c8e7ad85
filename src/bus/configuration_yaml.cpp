// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "configuration_yaml.h"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <regex>
#include <sstream>

#include <yaml-cpp/yaml.h>

#include "inverter_bus/wire/shown.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
/// Deeper than any scan list; an alias that contains itself would have no bottom.
constexpr int DEEPEST = 20;
/// More than any scan list; a few nested aliases can stand for billions of values.
constexpr int MOST_VALUES = 100000;
constexpr std::size_t LONGEST_WORD = 100;

/// Reads scalars as roslaunch (YAML 1.1) does, so that a file means the same here and on the parameter server.
class ValueReader
{
public:
  explicit ValueReader(const std::string& path) : path_(path)
  {
  }

  Value read(const YAML::Node& node, int depth)
  {
    if (depth > DEEPEST || ++count_ > MOST_VALUES)
    {
      fail(node.Mark(), depth > DEEPEST ? "is nested too deeply" : "holds too many values");
    }
    switch (node.Type())
    {
      case YAML::NodeType::Scalar:
        return readScalar(node);
      case YAML::NodeType::Sequence:
        return readList(node, depth);
      case YAML::NodeType::Map:
        return readMap(node, depth);
      default:
        return Value();
    }
  }

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& problem) const
  {
    throw drive::ConfigurationError(drive::oneLine(path_ + ":" + std::to_string(mark.line + 1) + ": " + problem));
  }

private:
  Value readScalar(const YAML::Node& node) const
  {
    const std::string& text = node.Scalar();
    Value value;
    // No number or word of YAML is that long, and std::regex recurses once per character.
    const bool plain = node.Tag() != "!" && text.size() <= LONGEST_WORD;
    if (!plain || !(readWord(text, value) || readInteger(text, value) || readNumber(text, value)))
    {
      value.type = Value::Type::Text;
      value.text = text;
    }
    return value;
  }

  static bool readWord(const std::string& text, Value& value)
  {
    static const std::regex TRUE_WORD("yes|Yes|YES|true|True|TRUE|on|On|ON");
    static const std::regex FALSE_WORD("no|No|NO|false|False|FALSE|off|Off|OFF");
    static const std::regex NULL_WORD("~|null|Null|NULL|");
    value.boolean = std::regex_match(text, TRUE_WORD);
    if (value.boolean || std::regex_match(text, FALSE_WORD))
    {
      value.type = Value::Type::Boolean;
      return true;
    }
    return std::regex_match(text, NULL_WORD);
  }

  static bool readInteger(const std::string& text, Value& value)
  {
    static const std::regex INTEGER("[-+]?(0|[1-9][0-9]*|0x[0-9a-fA-F]+|0[0-7]+)");
    if (!std::regex_match(text, INTEGER))
    {
      return false;
    }
    errno = 0;
    value.integer = std::strtoll(text.c_str(), nullptr, 0);
    value.type = Value::Type::Integer;
    if (errno == ERANGE)
    {
      // Still a number, so that the message speaks of its range and not of its type.
      value.type = Value::Type::Number;
      value.number = std::strtod(text.c_str(), nullptr);
    }
    return true;
  }

  static bool readNumber(const std::string& text, Value& value)
  {
    static const std::regex NUMBER("[-+]?([0-9]+(\\.[0-9]*)?|\\.[0-9]+)([eE][-+]?[0-9]+)?");
    static const std::regex INFINITE("[-+]?\\.(inf|Inf|INF)");
    static const std::regex NOT_A_NUMBER("\\.(nan|NaN|NAN)");
    if (std::regex_match(text, NUMBER))
    {
      value.number = std::strtod(text.c_str(), nullptr);
    }
    else if (std::regex_match(text, INFINITE))
    {
      const double infinity = std::numeric_limits<double>::infinity();
      value.number = text[0] == '-' ? -infinity : infinity;
    }
    else if (std::regex_match(text, NOT_A_NUMBER))
    {
      value.number = std::numeric_limits<double>::quiet_NaN();
    }
    else
    {
      return false;
    }
    value.type = Value::Type::Number;
    return true;
  }

  Value readList(const YAML::Node& node, int depth)
  {
    Value value;
    value.type = Value::Type::List;
    for (const YAML::Node& element : node)
    {
      value.list.push_back(read(element, depth + 1));
    }
    return value;
  }

  Value readMap(const YAML::Node& node, int depth)
  {
    Value value;
    value.type = Value::Type::Map;
    for (const auto& entry : node)
    {
      if (!entry.first.IsScalar())
      {
        fail(entry.first.Mark(), "a key must be a plain word; allowed: key: value");
      }
      const std::string key = entry.first.Scalar();
      if (!value.map.emplace(key, read(entry.second, depth + 1)).second)
      {
        fail(entry.first.Mark(), "key '" + wire::shown(key) + "' stands twice; allowed: once");
      }
    }
    return value;
  }

  const std::string path_;
  int count_ = 0;
};

void emit(const Value& value, YAML::Emitter& out)
{
  switch (value.type)
  {
    case Value::Type::None:
      out << YAML::Null;
      break;
    case Value::Type::Boolean:
      out << value.boolean;
      break;
    case Value::Type::Integer:
      out << value.integer;
      break;
    case Value::Type::Number:
      out << value.number;
      break;
    case Value::Type::Text:
      out << YAML::DoubleQuoted << value.text;
      break;
    case Value::Type::List:
      out << YAML::BeginSeq;
      for (const Value& element : value.list)
      {
        emit(element, out);
      }
      out << YAML::EndSeq;
      break;
    case Value::Type::Map:
      out << YAML::BeginMap;
      for (const auto& entry : value.map)
      {
        out << YAML::Key << entry.first << YAML::Value;
        emit(entry.second, out);
      }
      out << YAML::EndMap;
      break;
  }
}
}  // namespace

Value readYamlFile(const std::string& path)
{
  std::ifstream file(path);
  file.peek();  // a folder can be opened, but not read
  if (!file.is_open() || file.bad())
  {
    throw drive::ConfigurationError(path + ": cannot be read; allowed: a YAML file with the node's parameters");
  }
  std::ostringstream text;
  text << file.rdbuf();
  ValueReader reader(path);
  if (text.str().size() > drive::LARGEST_YAML || drive::yamlDepth(text.str()) > drive::DEEPEST_YAML)
  {
    throw drive::ConfigurationError(path + ": is larger than 1 MiB or nested too deeply; allowed: a scan list");
  }
  try
  {
    return reader.read(YAML::Load(text.str()), 0);
  }
  catch (const YAML::Exception& exception)
  {
    reader.fail(exception.mark, "is no valid YAML: " + exception.msg);
  }
}

std::string toYaml(const Value& value)
{
  YAML::Emitter out;
  out.SetDoublePrecision(17);
  emit(value, out);
  return out.c_str();
}
}  // namespace bus
}  // namespace inverter_bus

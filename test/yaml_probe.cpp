// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// yaml_probe FILE...: what the package's reader makes of each file, a line of JSON each: {"value": ...} or {"problem": "..."}.
// test/peers/rosparam_test.py compares it with rosparam.

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "config/yaml.h"

namespace
{
using inverter_bus::config::Value;

std::string quoted(const std::string& text)
{
  std::string result = "\"";
  for (const char c : text)
  {
    const auto byte = static_cast<unsigned char>(c);
    char escaped[8];
    std::snprintf(escaped, sizeof escaped, "\\u%04x", byte);
    result += byte < 0x20 || c == '"' || c == '\\' ? std::string(escaped) : std::string(1, c);
  }
  return result + "\"";
}

std::string numberText(double number)
{
  if (!std::isfinite(number))
  {
    return std::isnan(number) ? "NaN" : number > 0.0 ? "Infinity" : "-Infinity";
  }
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", number);
  const std::string result = text;
  return result.find_first_of(".e") == std::string::npos ? result + ".0" : result;
}

std::string json(const Value& value)
{
  std::string text;
  switch (value.type)
  {
    case Value::Type::Boolean:
      return value.boolean ? "true" : "false";
    case Value::Type::Integer:
      return std::to_string(value.integer);
    case Value::Type::Number:
      return numberText(value.number);
    case Value::Type::Text:
      return quoted(value.text);
    case Value::Type::List:
      for (const Value& element : value.list)
      {
        text += (text.empty() ? "" : ", ") + json(element);
      }
      return "[" + text + "]";
    case Value::Type::Map:
      for (const auto& entry : value.map)
      {
        text += (text.empty() ? "" : ", ") + quoted(entry.first) + ": " + json(entry.second);
      }
      return "{" + text + "}";
    default:
      return "null";
  }
}
}  // namespace

int main(int argc, char** argv)
{
  using namespace inverter_bus::config;
  for (int i = 1; i < argc; ++i)
  {
    std::string error;
    std::vector<YamlProblem> problems;
    const auto text = readTextFile(argv[i], error);
    const auto tree = text ? readYaml(*text, problems) : std::nullopt;
    const Value value = tree ? toParameters(*tree, problems) : Value();
    const bool good = text && problems.empty();
    std::printf("{\"%s\": %s}\n", good ? "value" : "problem",
                good ? json(value).c_str() : quoted(text ? problems.front().what : error).c_str());
  }
  return 0;
}

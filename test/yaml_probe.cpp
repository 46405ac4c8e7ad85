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

class FirstProblem : public inverter_bus::config::Complaints
{
public:
  void complain(const inverter_bus::config::Spot& /*spot*/, const std::string& mistake) override
  {
    what = what.empty() ? mistake : what;
  }
  std::string what;
};

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
      for (const inverter_bus::config::Entry& entry : value.map)
      {
        text += (text.empty() ? "" : ", ") + quoted(entry.key) + ": " + json(entry.value);
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
    FirstProblem problem;
    const auto tree = readYamlFile(argv[i], Purpose::Parameters, problem);
    const bool good = problem.what.empty();
    std::printf("{\"%s\": %s}\n", good ? "value" : "problem",
                good ? json(tree.value_or(Value())).c_str() : quoted(problem.what).c_str());
  }
  return 0;
}

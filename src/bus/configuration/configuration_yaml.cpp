// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/configuration/configuration_yaml.h"

#include <vector>

#include <yaml-cpp/yaml.h>

#include "config/scalar.h"
#include "config/yaml.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
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
      out << config::numberInYaml(value.number);
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
        out << YAML::Key << YAML::DoubleQuoted << entry.first << YAML::Value;
        emit(entry.second, out);
      }
      out << YAML::EndMap;
      break;
  }
}

std::string problemText(const std::string& path, const config::YamlProblem& problem)
{
  const std::string place = problem.line > 0 ? path + ":" + std::to_string(problem.line) : path;
  return place + ": " + (problem.path.empty() ? "" : "key '" + problem.path + "': ") + problem.what;
}
}  // namespace

Value readYamlFile(const std::string& path)
{
  std::string error;
  const auto text = config::readTextFile(path, error);
  if (!text)
  {
    throw drive::ConfigurationError(
        drive::oneLine(path + ": " + error + "; allowed: a YAML file with the node's parameters"));
  }
  std::vector<config::YamlProblem> problems;
  const auto tree = config::readYaml(*text, problems);
  Value value = tree ? config::toParameters(*tree, problems) : Value();
  if (!problems.empty())
  {
    throw drive::ConfigurationError(drive::oneLine(problemText(path, problems.front())));
  }
  return value;
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

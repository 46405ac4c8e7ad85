// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/configuration/configuration_refusals.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "bus/configuration/configuration_keys.h"
#include "config/yaml.h"
#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr std::size_t LONGEST_MESSAGE = 2000;

std::string describeWhole(const Value& value)
{
  std::vector<std::string> elements;
  switch (value.type)
  {
    case Value::Type::None:
      return "(empty)";
    case Value::Type::Text:
      return "'" + value.text + "'";
    case Value::Type::List:
      std::transform(value.list.begin(), value.list.end(), std::back_inserter(elements), describe);
      return "[" + util::joined(elements) + "]";
    case Value::Type::Map:
      for (const config::Entry& entry : value.map)
      {
        elements.push_back(entry.key + ": " + describe(entry.value));
      }
      return "{" + util::joined(elements) + "}";
    default:
      return value.text;
  }
}

std::string refusal(const config::Spot& spot, const std::string& given, const std::string& problem,
                    const std::string& allowed)
{
  const std::string key = spot.path.empty() ? "" : ": key '" + spot.path + "'";
  return util::printable(spot.place + key + " = " + given + ": " + problem + "; allowed: " + allowed, LONGEST_MESSAGE);
}
}  // namespace

std::string describe(const Value& value)
{
  return util::printable(describeWhole(value));
}

void Refusals::complain(const config::Spot& spot, const std::string& what)
{
  throw drive::ConfigurationError(config::lineOf(spot, what));
}

void Refusals::refuse(const config::Spot& spot, const Value& value, const std::string& problem,
                      const std::string& allowed)
{
  throw drive::ConfigurationError(refusal(spot, describe(value), problem, allowed));
}

void Refusals::miss(const config::Spot& spot, const std::string& allowed)
{
  throw drive::ConfigurationError(spot.place + ": key '" + spot.path + "' is missing; allowed: " + allowed);
}

void Refusals::refuseKey(const config::Spot& spot, const config::Entry& entry, const std::vector<std::string>& known)
{
  const std::string remark = remarkOn(entry.key);
  throw drive::ConfigurationError(spot.place + ": unknown key '" + util::printable(entry.key) +
                                  "' = " + describe(entry.value) + (remark.empty() ? "" : ": " + remark) +
                                  "; allowed: " + util::joined(known));
}

void Refusals::remark(const config::Spot& spot, const Value& value, const std::string& what)
{
  const std::string line = spot.place + ": key '" + spot.path + "' = " + describe(value) + ": " + what;
  if (std::find(remarks.begin(), remarks.end(), line) == remarks.end())
  {
    remarks.push_back(line);
  }
}

Section sectionOf(const Value& value, config::Complaints& complaints)
{
  return Section(config::Cursor(value, "", complaints));
}

void fail(const Section& section, const std::string& key, const std::string& problem, const std::string& allowed)
{
  const Value* value = section.cursor().value().find(key);
  const std::string given = value == nullptr ? "(not set)" : describe(*value);
  throw drive::ConfigurationError(refusal(section.spot(key), given, problem, allowed));
}

Limit readLimit(const Section& section, Limit fallback)
{
  const std::string inherited = fallback == Limit::Saturate ? "saturate" : "refuse";
  return section.choice("limit", { "refuse", "saturate" }, inherited) == "saturate" ? Limit::Saturate : Limit::Refuse;
}

Value readYamlFile(const std::string& path)
{
  Refusals refusals;
  std::optional<Value> tree = config::readYamlFile(path, config::Purpose::Parameters, refusals);
  // Without a tree there was a mistake.
  return tree.value_or(Value());
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/configuration/configuration_section.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bus/configuration/configuration_keys.h"
#include "config/scalar.h"
#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr int DIGITS = 9;
constexpr std::size_t LONGEST_VALUE = 100;
constexpr std::size_t LONGEST_MESSAGE = 2000;

std::string rangeText(const Range& range)
{
  const std::string unit = range.unit.empty() ? "" : " " + range.unit;
  const std::string minimum = util::numberText(range.minimum, DIGITS);
  const std::string maximum = util::numberText(range.maximum, DIGITS);
  if (range.above_minimum)
  {
    return "a number above " + minimum + " and up to " + maximum + unit;
  }
  return "a number from " + minimum + " to " + maximum + unit;
}

std::string describeList(const Value& value)
{
  std::vector<std::string> elements;
  for (const Value& element : value.list)
  {
    elements.push_back(describe(element));
  }
  return "[" + util::joined(elements) + "]";
}

std::string describeMap(const Value& value)
{
  std::vector<std::string> elements;
  for (const auto& element : value.map)
  {
    elements.push_back(element.first + ": " + describe(element.second));
  }
  return "{" + util::joined(elements) + "}";
}

std::string describeWhole(const Value& value)
{
  switch (value.type)
  {
    case Value::Type::None:
      return "(empty)";
    case Value::Type::Boolean:
      return value.boolean ? "true" : "false";
    case Value::Type::Integer:
      return std::to_string(value.integer);
    case Value::Type::Number:
      return util::numberText(value.number, DIGITS);
    case Value::Type::Text:
      return "'" + value.text + "'";
    case Value::Type::List:
      return describeList(value);
    case Value::Type::Map:
      return describeMap(value);
  }
  return "?";
}
}  // namespace

std::string describe(const Value& value)
{
  return util::printable(describeWhole(value), LONGEST_VALUE);
}

Section::Section(const Value& value, const std::string& place, std::shared_ptr<Remarks> remarks)
  : place_(util::printable(place, LONGEST_MESSAGE)), remarks_(std::move(remarks))
{
  if (value.type != Value::Type::Map)
  {
    throw drive::ConfigurationError(place_ + " = " + describe(value) +
                                    ": is no map; allowed: a map of keys and values");
  }
  for (const auto& entry : value.map)
  {
    entries_[entry.first] = Entry{ entry.second, place_ };
  }
}

const std::shared_ptr<Remarks>& Section::remarks() const
{
  return remarks_;
}

const std::string& Section::place() const
{
  return place_;
}

void Section::inherit(const Section& defaults)
{
  entries_.insert(defaults.entries_.begin(), defaults.entries_.end());
}

void Section::refuseUnknownKeys(const std::vector<std::string>& known) const
{
  for (const auto& entry : entries_)
  {
    if (std::find(known.begin(), known.end(), entry.first) == known.end())
    {
      const std::string remark = remarkOn(entry.first);
      throw drive::ConfigurationError(entry.second.place + ": unknown key '" + util::printable(entry.first) +
                                      "' = " + describe(entry.second.value) + (remark.empty() ? "" : ": " + remark) +
                                      "; allowed: " + util::joined(known));
    }
  }
}

bool Section::has(const std::string& key) const
{
  return entries_.count(key) != 0;
}

const Value* Section::find(const std::string& key) const
{
  const auto entry = entries_.find(key);
  return entry == entries_.end() ? nullptr : &entry->second.value;
}

std::string Section::placeOf(const std::string& key) const
{
  const auto entry = entries_.find(key);
  return entry == entries_.end() ? place_ : entry->second.place;
}

bool Section::boolean(const std::string& key, bool fallback) const
{
  const Value* value = find(key);
  if (value == nullptr)
  {
    return fallback;
  }
  if (value->type != Value::Type::Boolean)
  {
    fail(key, "is no truth value", withHint("true, false", *value));
  }
  return value->boolean;
}

std::int64_t Section::integer(const std::string& key, std::int64_t fallback, std::int64_t minimum,
                              std::int64_t maximum) const
{
  const Value* value = find(key);
  if (value == nullptr)
  {
    return fallback;
  }
  const std::string allowed = "a whole number from " + std::to_string(minimum) + " to " + std::to_string(maximum);
  if (value->type != Value::Type::Integer)
  {
    fail(key, "is no whole number", withHint(allowed, *value));
  }
  if (value->integer < minimum || value->integer > maximum)
  {
    fail(key, "is out of range", allowed);
  }
  return value->integer;
}

double Section::number(const std::string& key, double fallback, const Range& range) const
{
  return number(key, range).value_or(fallback);
}

std::optional<double> Section::number(const std::string& key, const Range& range) const
{
  const Value* value = find(key);
  if (value == nullptr)
  {
    return std::nullopt;
  }
  const std::optional<double> number = numberOf(key, *value);
  if (!number)
  {
    fail(key, "is no number", withHint(rangeText(range), *value));
  }
  // Written so that NaN fails too.
  const bool large_enough = range.above_minimum ? *number > range.minimum : *number >= range.minimum;
  if (!std::isfinite(*number) || !large_enough || !(*number <= range.maximum))
  {
    fail(key, std::isfinite(*number) ? "is out of range" : "is not finite", rangeText(range));
  }
  return number;
}

std::optional<double> Section::numberOf(const std::string& key, const Value& value) const
{
  switch (value.type)
  {
    case Value::Type::Integer:
      return static_cast<double>(value.integer);
    case Value::Type::Number:
      return value.number;
    case Value::Type::Text:
      break;
    default:
      return std::nullopt;
  }
  // 1e2 is a text to YAML 1.1, and 100 to whoever wrote it.
  const std::optional<double> meant = config::meantNumber(value.text);
  const std::string remark = placeOf(key) + ": key '" + key + "' = " + describe(value) +
                             ": is a text to YAML and taken as the number that it looks like; " +
                             config::hintFor(value.text);
  if (meant && std::find(remarks_->begin(), remarks_->end(), remark) == remarks_->end())
  {
    remarks_->push_back(remark);
  }
  return meant;
}

std::string Section::withHint(const std::string& allowed, const Value& value)
{
  std::string hint;
  if (value.type == Value::Type::Text)
  {
    hint = config::hintFor(value.text);
  }
  else if (value.type == Value::Type::Number && std::floor(value.number) == value.number)
  {
    hint = "write it without a decimal point";
  }
  return hint.empty() ? allowed : allowed + "; " + hint;
}

std::string Section::text(const std::string& key, const std::string& fallback) const
{
  const Value* value = find(key);
  if (value == nullptr)
  {
    return fallback;
  }
  if (value->type != Value::Type::Text || value->text.empty())
  {
    fail(key, value->type == Value::Type::Text ? "is empty" : "is no text", "a text");
  }
  return value->text;
}

std::string Section::choice(const std::string& key, const std::string& fallback,
                            const std::vector<std::string>& allowed) const
{
  const Value* value = find(key);
  if (value == nullptr)
  {
    return fallback;
  }
  if (value->type != Value::Type::Text || std::find(allowed.begin(), allowed.end(), value->text) == allowed.end())
  {
    fail(key, "is none of the choices", util::joined(allowed));
  }
  return value->text;
}

std::int64_t Section::choice(const std::string& key, std::int64_t fallback,
                             const std::vector<std::int64_t>& allowed) const
{
  const Value* value = find(key);
  if (value == nullptr)
  {
    return fallback;
  }
  if (value->type != Value::Type::Integer || std::find(allowed.begin(), allowed.end(), value->integer) == allowed.end())
  {
    std::vector<std::string> names;
    names.reserve(allowed.size());
    for (const std::int64_t number : allowed)
    {
      names.push_back(std::to_string(number));
    }
    fail(key, "is none of the choices", withHint(util::joined(names), *value));
  }
  return value->integer;
}

Limit readLimit(const Section& section, Limit fallback)
{
  const std::string inherited = fallback == Limit::Saturate ? "saturate" : "refuse";
  return section.choice("limit", inherited, { "refuse", "saturate" }) == "saturate" ? Limit::Saturate : Limit::Refuse;
}

void Section::require(const std::string& key, const std::string& allowed) const
{
  if (!has(key))
  {
    throw drive::ConfigurationError(place_ + ": key '" + key + "' is missing; allowed: " + allowed);
  }
}

void Section::fail(const std::string& key, const std::string& problem, const std::string& allowed) const
{
  const Value* value = find(key);
  const std::string given = value == nullptr ? "(not set)" : describe(*value);
  throw drive::ConfigurationError(util::printable(
      placeOf(key) + ": key '" + key + "' = " + given + ": " + problem + "; allowed: " + allowed, LONGEST_MESSAGE));
}
}  // namespace bus
}  // namespace inverter_bus

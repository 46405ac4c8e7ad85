// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/yaml_reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "drive/profile/numbers.h"
#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
YamlCursor::YamlCursor(const YamlValue& value, std::string path, Problems& problems)
  : value_(&value), path_(std::move(path)), problems_(&problems)
{
}

const YamlValue& YamlCursor::value() const
{
  return *value_;
}

const std::string& YamlCursor::path() const
{
  return path_;
}

Problems& YamlCursor::problems() const
{
  return *problems_;
}

void YamlCursor::reject(const std::string& allowed) const
{
  switch (value_->kind)
  {
    case YamlValue::Kind::Scalar:
      complain("value '" + util::printable(value_->text) + "'" + (value_->scalar.quoted ? " (a text, in quotes)" : "") +
               ": allowed: " + allowed);
      break;
    case YamlValue::Kind::List:
      complain("a list stands here: allowed: " + allowed);
      break;
    case YamlValue::Kind::Map:
      complain("a map stands here: allowed: " + allowed);
      break;
    default:
      complain("has no value: allowed: " + allowed);
      break;
  }
}

void YamlCursor::rejectNumber(const std::string& allowed) const
{
  const std::string hint = is(config::Scalar::Type::Text) ? config::hintFor(value_->text) : "";
  reject(allowed + (hint.empty() ? "" : " (" + hint + ")"));
}

void YamlCursor::rejectText(const std::string& allowed) const
{
  const bool other = value_->kind == YamlValue::Kind::Scalar && !is(config::Scalar::Type::Text);
  reject(allowed + (other ? "; in quotes, since YAML takes it for something else than a text" : ""));
}

void YamlCursor::complain(const std::string& what) const
{
  problems_->add(value_->where, path_, what);
}

bool YamlCursor::is(config::Scalar::Type type) const
{
  return value_->kind == YamlValue::Kind::Scalar && value_->scalar.type == type;
}

/// What is wanted as a number. 1e2 is a text to YAML and a number to people; nobody means a text by it here.
std::optional<double> YamlCursor::asNumber() const
{
  if (is(config::Scalar::Type::Integer) || is(config::Scalar::Type::Number))
  {
    return value_->scalar.number;
  }
  return is(config::Scalar::Type::Text) ? config::meantNumber(value_->text) : std::nullopt;
}

bool YamlCursor::isMap() const
{
  return value_->kind == YamlValue::Kind::Map;
}

bool YamlCursor::isList() const
{
  return value_->kind == YamlValue::Kind::List;
}

std::optional<std::int64_t> YamlCursor::integer(std::int64_t lowest, std::int64_t highest) const
{
  const std::int64_t value = value_->scalar.integer;
  if (!is(config::Scalar::Type::Integer) || value < lowest || value > highest)
  {
    rejectNumber("an integer from " + std::to_string(lowest) + " to " + std::to_string(highest) + ", decimal or 0x...");
    return std::nullopt;
  }
  return value;
}

std::optional<double> YamlCursor::number(double lowest, double highest) const
{
  const auto value = asNumber();
  // Written so that NaN fails too.
  if (!value || !(*value >= lowest && *value <= highest))
  {
    rejectNumber("a number from " + util::exactText(lowest) + " to " + util::exactText(highest));
    return std::nullopt;
  }
  return value;
}

std::optional<double> YamlCursor::positive() const
{
  const auto value = asNumber();
  // Resolutions and frequencies: beyond these bounds counts would leave what 32 bits and a double can hold.
  if (!value || !(*value >= 1e-9 && *value <= 1e9))
  {
    rejectNumber("a number above 0 (1e-9 to 1e9)");
    return std::nullopt;
  }
  return value;
}

std::optional<bool> YamlCursor::flag() const
{
  if (!is(config::Scalar::Type::Boolean))
  {
    rejectNumber("true or false");
    return std::nullopt;
  }
  return value_->scalar.boolean;
}

std::optional<std::string> YamlCursor::text() const
{
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (!is(config::Scalar::Type::Text) || std::any_of(value_->text.begin(), value_->text.end(), control))
  {
    rejectText("a text on one line");
    return std::nullopt;
  }
  return value_->text;
}

std::optional<std::string> YamlCursor::name() const
{
  const auto good = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; };
  const std::string& text = value_->text;
  if (!is(config::Scalar::Type::Text) || text.empty() || !std::all_of(text.begin(), text.end(), good))
  {
    rejectText("a name of letters, digits, '_' and '-'");
    return std::nullopt;
  }
  return text;
}

std::optional<std::string> YamlCursor::choice(const std::vector<std::string>& allowed) const
{
  if (!is(config::Scalar::Type::Text) || std::find(allowed.begin(), allowed.end(), value_->text) == allowed.end())
  {
    reject(util::joined(allowed));
    return std::nullopt;
  }
  return value_->text;
}

std::vector<YamlCursor> YamlCursor::list() const
{
  std::vector<YamlCursor> result;
  if (!isList())
  {
    reject("a list");
    return result;
  }
  for (std::size_t i = 0; i < value_->items.size(); ++i)
  {
    result.emplace_back(value_->items[i], path_ + "[" + std::to_string(i) + "]", *problems_);
  }
  return result;
}

std::vector<std::pair<std::string, YamlCursor>> YamlCursor::entries() const
{
  std::vector<std::pair<std::string, YamlCursor>> result;
  if (!isMap())
  {
    reject("a map");
    return result;
  }
  for (const YamlEntry& entry : value_->entries)
  {
    result.emplace_back(entry.key,
                        YamlCursor(entry.value, path_.empty() ? entry.key : path_ + "." + entry.key, *problems_));
  }
  return result;
}

YamlMap::YamlMap(const YamlCursor& cursor) : cursor_(cursor)
{
  if (!cursor.isMap())
  {
    cursor.reject("a map");
  }
}

const YamlCursor& YamlMap::cursor() const
{
  return cursor_;
}

bool YamlMap::has(const std::string& key) const
{
  return cursor_.value().find(key) != nullptr;
}

std::optional<YamlCursor> YamlMap::find(const std::string& key)
{
  asked_.insert(key);
  const YamlValue* found = cursor_.value().find(key);
  if (found == nullptr)
  {
    return std::nullopt;
  }
  return YamlCursor(*found, cursor_.path().empty() ? key : cursor_.path() + "." + key, cursor_.problems());
}

std::optional<YamlCursor> YamlMap::require(const std::string& key)
{
  auto found = find(key);
  if (!found && cursor_.isMap())
  {
    cursor_.problems().add(cursor_.value().where, cursor_.path().empty() ? key : cursor_.path() + "." + key,
                           "is missing: must be given");
  }
  return found;
}

void YamlMap::finish() const
{
  for (const YamlEntry& entry : cursor_.value().entries)
  {
    if (asked_.count(entry.key) == 0)
    {
      cursor_.problems().add(entry.where, cursor_.path().empty() ? entry.key : cursor_.path() + "." + entry.key,
                             "unknown key: allowed: " + util::joined(asked_));
    }
  }
}

std::int64_t YamlMap::integer(const std::string& key, std::int64_t lowest, std::int64_t highest, std::int64_t fallback)
{
  const auto found = find(key);
  return found ? found->integer(lowest, highest).value_or(fallback) : fallback;
}

double YamlMap::number(const std::string& key, double lowest, double highest, double fallback)
{
  const auto found = find(key);
  return found ? found->number(lowest, highest).value_or(fallback) : fallback;
}

bool YamlMap::flag(const std::string& key, bool fallback)
{
  const auto found = find(key);
  return found ? found->flag().value_or(fallback) : fallback;
}

std::string YamlMap::text(const std::string& key, const std::string& fallback)
{
  const auto found = find(key);
  return found ? found->text().value_or(fallback) : fallback;
}

std::string YamlMap::name(const std::string& key)
{
  const auto found = find(key);
  return found ? found->name().value_or("") : "";
}
}  // namespace drive
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "config/cursor.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "config/scalar.h"
#include "util/text.h"

namespace inverter_bus
{
namespace config
{
namespace
{
std::string below(const std::string& path, const std::string& key)
{
  return path.empty() ? key : path + "." + key;
}

std::string rangeText(const Range& range)
{
  constexpr int DIGITS = 9;
  const std::string unit = range.unit.empty() ? "" : " " + range.unit;
  const std::string minimum = util::numberText(range.minimum, DIGITS);
  const std::string maximum = util::numberText(range.maximum, DIGITS);
  return range.above_minimum ? "a number above " + minimum + " and up to " + maximum + unit
                             : "a number from " + minimum + " to " + maximum + unit;
}

template <typename Choice>
bool isOneOf(const std::vector<Choice>& allowed, const Choice& value)
{
  return std::find(allowed.begin(), allowed.end(), value) != allowed.end();
}
}  // namespace

const char* const NAME_FORM = "a name of letters, digits, '_' and '-'";

bool isName(const std::string& text)
{
  const auto good = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; };
  return !text.empty() && std::all_of(text.begin(), text.end(), good);
}

Cursor::Cursor(const Value& value, std::string path, Complaints& complaints)
  : value_(&value), path_(std::move(path)), complaints_(&complaints)
{
}

const Value& Cursor::value() const
{
  return *value_;
}

const std::string& Cursor::path() const
{
  return path_;
}

Spot Cursor::spot() const
{
  return { value_->place, path_ };
}

Complaints& Cursor::complaints() const
{
  return *complaints_;
}

void Cursor::reject(const std::string& allowed, const std::string& problem) const
{
  complaints_->refuse(spot(), *value_, problem, allowed);
}

void Cursor::complain(const std::string& what) const
{
  complaints_->complain(spot(), what);
}

void Cursor::rejectNumber(const std::string& allowed, const std::string& problem) const
{
  std::string hint = is(Value::Type::Text) ? hintFor(value_->text) : "";
  if (is(Value::Type::Number) && std::floor(value_->number) == value_->number && problem == "is not a whole number")
  {
    hint = "write it without a decimal point";
  }
  reject(allowed + (hint.empty() ? "" : " (" + hint + ")"), problem);
}

void Cursor::rejectText(const std::string& allowed, const std::string& problem) const
{
  const bool other = value_->isScalar() && !is(Value::Type::Text);
  reject(allowed + (other ? ", in quotes: without them YAML does not read it as a text" : ""), problem);
}

bool Cursor::is(Value::Type type) const
{
  return value_->type == type;
}

bool Cursor::isMap() const
{
  return is(Value::Type::Map);
}

bool Cursor::isList() const
{
  return is(Value::Type::List);
}

std::optional<double> Cursor::asNumber() const
{
  if (is(Value::Type::Integer) || is(Value::Type::Number))
  {
    return value_->number;
  }
  const std::optional<double> meant = is(Value::Type::Text) ? meantNumber(value_->text) : std::nullopt;
  if (meant)
  {
    complaints_->remark(spot(), *value_,
                        "is a text in YAML, read as the number it looks like; " + hintFor(value_->text));
  }
  return meant;
}

std::optional<std::int64_t> Cursor::integer(std::int64_t lowest, std::int64_t highest) const
{
  const std::int64_t value = value_->integer;
  const bool whole = is(Value::Type::Integer);
  if (!whole || value < lowest || value > highest)
  {
    rejectNumber("an integer from " + std::to_string(lowest) + " to " + std::to_string(highest) + ", decimal or 0x...",
                 whole ? "is out of range" : "is not a whole number");
    return std::nullopt;
  }
  return value;
}

std::optional<double> Cursor::number(const Range& range) const
{
  const auto value = asNumber();
  // Written so that NaN fails too.
  const bool fits = value && (range.above_minimum ? *value > range.minimum : *value >= range.minimum) &&
                    *value <= range.maximum && std::isfinite(*value);
  if (!fits)
  {
    rejectNumber(rangeText(range), !value                  ? "is not a number"
                                   : std::isfinite(*value) ? "is out of range"
                                                           : "is not finite");
    return std::nullopt;
  }
  return value;
}

std::optional<double> Cursor::positive() const
{
  const auto value = asNumber();
  // Resolutions and frequencies: beyond these bounds counts would leave what 32 bits and a double can hold.
  if (!value || !(*value >= 1e-9 && *value <= 1e9))
  {
    rejectNumber("a number above 0 (1e-9 to 1e9)", value ? "is out of range" : "is not a number");
    return std::nullopt;
  }
  return value;
}

std::optional<bool> Cursor::flag() const
{
  if (!is(Value::Type::Boolean))
  {
    rejectNumber("true or false", "is not a truth value");
    return std::nullopt;
  }
  return value_->boolean;
}

std::optional<std::string> Cursor::text() const
{
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (!is(Value::Type::Text) || std::any_of(value_->text.begin(), value_->text.end(), control))
  {
    rejectText("a text on one line", "is not a text on one line");
    return std::nullopt;
  }
  return value_->text;
}

std::optional<std::string> Cursor::filledText() const
{
  if (!is(Value::Type::Text) || value_->text.empty())
  {
    rejectText("a text", is(Value::Type::Text) ? "is empty" : "is not a text");
    return std::nullopt;
  }
  return value_->text;
}

std::optional<std::string> Cursor::name() const
{
  if (!is(Value::Type::Text) || !isName(value_->text))
  {
    rejectText(NAME_FORM, "is not a name");
    return std::nullopt;
  }
  return value_->text;
}

std::optional<std::string> Cursor::choice(const std::vector<std::string>& allowed) const
{
  if (!is(Value::Type::Text) || !isOneOf(allowed, value_->text))
  {
    reject(util::joined(allowed), "is not one of the choices");
    return std::nullopt;
  }
  return value_->text;
}

std::optional<std::int64_t> Cursor::integerOf(const std::vector<std::int64_t>& allowed) const
{
  if (!is(Value::Type::Integer) || !isOneOf(allowed, value_->integer))
  {
    rejectNumber(util::joined(std::vector<int>(allowed.begin(), allowed.end())), "is not one of the choices");
    return std::nullopt;
  }
  return value_->integer;
}

std::vector<Cursor> Cursor::list() const
{
  std::vector<Cursor> result;
  if (!isList())
  {
    reject("a list", "is not a list");
    return result;
  }
  for (std::size_t i = 0; i < value_->list.size(); ++i)
  {
    result.emplace_back(value_->list[i], path_ + "[" + std::to_string(i) + "]", *complaints_);
  }
  return result;
}

std::optional<std::vector<std::string>> Cursor::texts(const std::string& allowed) const
{
  std::vector<std::string> result;
  for (const Value& element : value_->list)
  {
    if (element.type != Value::Type::Text)
    {
      reject(allowed, "holds something other than names");
      return std::nullopt;
    }
    result.push_back(element.text);
  }
  if (!isList())
  {
    reject(allowed, "is not a list");
    return std::nullopt;
  }
  return result;
}

std::vector<std::pair<std::string, Cursor>> Cursor::entries() const
{
  std::vector<std::pair<std::string, Cursor>> result;
  if (!isMap())
  {
    reject("a map", "is not a map");
    return result;
  }
  for (const Entry& entry : value_->map)
  {
    result.emplace_back(entry.key, Cursor(entry.value, below(path_, entry.key), *complaints_));
  }
  return result;
}

Section::Section(const Cursor& cursor) : cursor_(cursor)
{
  if (!cursor.isMap())
  {
    cursor.reject("a map", "is not a map");
  }
}

const Cursor& Section::cursor() const
{
  return cursor_;
}

bool Section::has(const std::string& key) const
{
  return cursor_.value().find(key) != nullptr;
}

std::optional<Cursor> Section::find(const std::string& key) const
{
  asked_.insert(key);
  const Value* found = cursor_.value().find(key);
  if (found == nullptr)
  {
    return std::nullopt;
  }
  return Cursor(*found, below(cursor_.path(), key), cursor_.complaints());
}

std::optional<Cursor> Section::require(const std::string& key, const std::string& allowed) const
{
  auto found = find(key);
  if (!found && cursor_.isMap())
  {
    cursor_.complaints().miss(spot(key), allowed);
  }
  return found;
}

Spot Section::spot(const std::string& key) const
{
  const Value* found = cursor_.value().find(key);
  return { (found == nullptr ? cursor_.value() : *found).place, below(cursor_.path(), key) };
}

void Section::allowOnly(const std::vector<std::string>& known) const
{
  for (const Entry& entry : cursor_.value().map)
  {
    if (!isOneOf(known, entry.key))
    {
      cursor_.complaints().refuseKey({ entry.value.place, below(cursor_.path(), entry.key) }, entry, known);
    }
  }
}

void Section::finish() const
{
  allowOnly({ asked_.begin(), asked_.end() });
}

std::int64_t Section::integer(const std::string& key, std::int64_t lowest, std::int64_t highest,
                              std::int64_t fallback) const
{
  const auto found = find(key);
  return found ? found->integer(lowest, highest).value_or(fallback) : fallback;
}

double Section::number(const std::string& key, const Range& range, double fallback) const
{
  const auto found = find(key);
  return found ? found->number(range).value_or(fallback) : fallback;
}

bool Section::flag(const std::string& key, bool fallback) const
{
  const auto found = find(key);
  return found ? found->flag().value_or(fallback) : fallback;
}

std::string Section::text(const std::string& key, const std::string& fallback) const
{
  const auto found = find(key);
  return found ? found->text().value_or(fallback) : fallback;
}

std::string Section::filledText(const std::string& key, const std::string& fallback) const
{
  const auto found = find(key);
  return found ? found->filledText().value_or(fallback) : fallback;
}

std::string Section::name(const std::string& key) const
{
  const auto found = find(key);
  return found ? found->name().value_or("") : "";
}

std::string Section::choice(const std::string& key, const std::vector<std::string>& allowed,
                            const std::string& fallback) const
{
  const auto found = find(key);
  return found ? found->choice(allowed).value_or(fallback) : fallback;
}

std::int64_t Section::integerOf(const std::string& key, const std::vector<std::int64_t>& allowed,
                                std::int64_t fallback) const
{
  const auto found = find(key);
  return found ? found->integerOf(allowed).value_or(fallback) : fallback;
}
}  // namespace config
}  // namespace inverter_bus

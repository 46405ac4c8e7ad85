// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_CONFIG_CURSOR_H
#define INVERTER_BUS_SRC_CONFIG_CURSOR_H

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "config/complaints.h"
#include "inverter_bus/config/value.h"

namespace inverter_bus
{
namespace config
{
/// The names that isName() accepts, in words.
extern const char* const NAME_FORM;

/// Letters, digits, '_' and '-'; at least one.
bool isName(const std::string& text);

/// Numbers that a key may have, both ends included unless \ref above_minimum.
struct Range
{
  double minimum = 0.0;
  double maximum = 0.0;
  /// The minimum itself is too small.
  bool above_minimum = false;
  std::string unit = {};
};

/// A value, the way to it and where to complain. Every reading function returns nothing after a complaint. Value and complaints
/// must outlive it.
class Cursor
{
public:
  Cursor(const Value& value, std::string path, Complaints& complaints);

  const Value& value() const;
  const std::string& path() const;
  Spot spot() const;
  Complaints& complaints() const;

  /// "value 'x': allowed: ..."
  void reject(const std::string& allowed, const std::string& problem = "is not allowed") const;
  /// Free text.
  void complain(const std::string& what) const;

  std::optional<std::int64_t> integer(std::int64_t lowest, std::int64_t highest) const;
  std::optional<double> number(const Range& range) const;
  /// A number above 0.
  std::optional<double> positive() const;
  std::optional<bool> flag() const;
  /// A text on one line, which may be empty.
  std::optional<std::string> text() const;
  /// A text that is not empty.
  std::optional<std::string> filledText() const;
  /// A text that isName().
  std::optional<std::string> name() const;
  std::optional<std::string> choice(const std::vector<std::string>& allowed) const;
  std::optional<std::int64_t> integerOf(const std::vector<std::int64_t>& allowed) const;
  /// Each element of a list.
  std::vector<Cursor> list() const;
  /// A list of texts; \p allowed says what they should be.
  std::optional<std::vector<std::string>> texts(const std::string& allowed) const;
  /// Entries of a map whose keys are data (names, codes), not words of the schema.
  std::vector<std::pair<std::string, Cursor>> entries() const;
  bool isMap() const;
  bool isList() const;

private:
  bool is(Value::Type type) const;
  /// A value where a number is wanted. 1e2 is a text to YAML and a number to people; here it is never meant as a text.
  std::optional<double> asNumber() const;
  /// With a hint where the text looks like what was wanted.
  void rejectNumber(const std::string& allowed, const std::string& problem) const;
  /// With a hint where it is a number or a truth value to YAML.
  void rejectText(const std::string& allowed, const std::string& problem) const;

  const Value* value_;
  std::string path_;
  Complaints* complaints_;
};

/// A map whose keys are words of the schema.
class Section
{
public:
  explicit Section(const Cursor& cursor);

  const Cursor& cursor() const;
  bool has(const std::string& key) const;
  /// Nothing if the key is not there.
  std::optional<Cursor> find(const std::string& key) const;
  /// Complains if it isn't there.
  std::optional<Cursor> require(const std::string& key, const std::string& allowed = "") const;
  /// Where \p key is, or would be.
  Spot spot(const std::string& key) const;
  /// Complains about the keys that are not in \p known.
  void allowOnly(const std::vector<std::string>& known) const;
  /// Complains about the keys that were never asked for.
  void finish() const;

  // Shorthands for optional keys: \p fallback where it is absent or wrong (wrong is also a complaint).
  std::int64_t integer(const std::string& key, std::int64_t lowest, std::int64_t highest, std::int64_t fallback) const;
  double number(const std::string& key, const Range& range, double fallback) const;
  bool flag(const std::string& key, bool fallback) const;
  std::string text(const std::string& key, const std::string& fallback = "") const;
  std::string filledText(const std::string& key, const std::string& fallback) const;
  std::string name(const std::string& key) const;
  std::string choice(const std::string& key, const std::vector<std::string>& allowed,
                     const std::string& fallback) const;
  std::int64_t integerOf(const std::string& key, const std::vector<std::int64_t>& allowed, std::int64_t fallback) const;

private:
  Cursor cursor_;
  /// Only for finish(): to ask for a key changes nothing else.
  mutable std::set<std::string> asked_;
};
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_CONFIG_CURSOR_H

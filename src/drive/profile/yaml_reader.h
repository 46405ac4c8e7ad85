// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_YAML_READER_H
#define INVERTER_BUS_SRC_DRIVE_YAML_READER_H

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "drive/profile/problems.h"
#include "drive/profile/yaml_value.h"

namespace inverter_bus
{
namespace drive
{
/// A value, the way to it and where to complain. Every reading function returns nothing after a complaint.
class YamlCursor
{
public:
  YamlCursor(const YamlValue& value, std::string path, Problems& problems);

  const YamlValue& value() const;
  const std::string& path() const;
  Problems& problems() const;

  /// "value 'x': allowed: ..."
  void reject(const std::string& allowed) const;
  /// Free text.
  void complain(const std::string& what) const;

  std::optional<std::int64_t> integer(std::int64_t lowest, std::int64_t highest) const;
  std::optional<double> number(double lowest, double highest) const;
  /// A number above 0.
  std::optional<double> positive() const;
  std::optional<bool> flag() const;
  std::optional<std::string> text() const;
  /// Letters, digits, '_' and '-'.
  std::optional<std::string> name() const;
  std::optional<std::string> choice(const std::vector<std::string>& allowed) const;
  std::vector<YamlCursor> list() const;
  /// Entries of a map whose keys are data (names, codes), not words of the schema.
  std::vector<std::pair<std::string, YamlCursor>> entries() const;
  bool isMap() const;
  bool isList() const;

private:
  bool is(config::Scalar::Type type) const;
  std::optional<double> asNumber() const;
  /// With a hint where the text looks like what was wanted.
  void rejectNumber(const std::string& allowed) const;
  /// With a hint where it is a number or a truth value to YAML.
  void rejectText(const std::string& allowed) const;

  const YamlValue* value_;
  std::string path_;
  Problems* problems_;
};

/// A map whose keys are words of the schema. Keys that nobody asked for are mistakes.
class YamlMap
{
public:
  explicit YamlMap(const YamlCursor& cursor);

  const YamlCursor& cursor() const;
  bool has(const std::string& key) const;
  std::optional<YamlCursor> find(const std::string& key);
  /// Complains if it isn't there.
  std::optional<YamlCursor> require(const std::string& key);
  /// Complains about the keys that were never asked for.
  void finish() const;

  // Shorthands for optional keys: \p fallback where it is absent or wrong (wrong is also a problem).
  std::int64_t integer(const std::string& key, std::int64_t lowest, std::int64_t highest, std::int64_t fallback);
  double number(const std::string& key, double lowest, double highest, double fallback);
  bool flag(const std::string& key, bool fallback);
  std::string text(const std::string& key, const std::string& fallback = "");
  std::string name(const std::string& key);

private:
  YamlCursor cursor_;
  std::set<std::string> asked_;
};
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_YAML_READER_H

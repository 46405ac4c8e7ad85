// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_YAML_VALUE_H
#define INVERTER_BUS_SRC_DRIVE_YAML_VALUE_H

#include <optional>
#include <string>
#include <vector>

#include "config/scalar.h"
#include "drive/profile/problems.h"

namespace inverter_bus
{
namespace drive
{
struct YamlEntry;

/// A YAML tree in which every value remembers where it stands, also when two documents are merged.
struct YamlValue
{
  enum class Kind
  {
    Empty,
    Scalar,
    List,
    Map
  };
  Kind kind = Kind::Empty;
  /// As written, without quotes.
  std::string text;
  /// What the text is to YAML: "3" in quotes is a text, 3 is a number.
  config::Scalar scalar;
  /// "file:line", or the scan list entry of an override.
  std::string where;
  std::vector<YamlValue> items;
  std::vector<YamlEntry> entries;

  YamlValue* find(const std::string& key);
  const YamlValue* find(const std::string& key) const;
  void erase(const std::string& key);
};

struct YamlEntry
{
  std::string key;
  std::string where;
  YamlValue value;
};

/// Whether two keys are the same; 0x21 and 33 are.
bool sameKey(const std::string& a, const std::string& b);

/// Reads one document (config/yaml.h). \p source file name or place; \p with_lines whether line numbers mean something to the
/// user. What is no YAML is a problem, and no value.
std::optional<YamlValue> parseYaml(const std::string& text, const std::string& source, bool with_lines,
                                   Problems& problems);

/// The file's text, or a problem that names the file.
std::optional<std::string> readTextFile(const std::string& path, Problems& problems);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_YAML_VALUE_H

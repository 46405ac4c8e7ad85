// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_YAML_VALUE_H
#define INVERTER_BUS_SRC_DRIVE_YAML_VALUE_H

#include <optional>
#include <string>
#include <vector>

#include "problems.h"

namespace inverter_bus
{
namespace drive
{
struct YamlEntry;

/// A YAML tree in which every value remembers where it stands. yaml-cpp's own nodes lose that when two documents are
/// merged, and silently keep duplicate keys.
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
  std::string text;
  /// "3" in quotes is a text, 3 is a number.
  bool quoted = false;
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

/// Reads one document. \p source file name or place; \p with_lines whether line numbers mean something to the user.
/// Malformed text, several documents, duplicate keys, aliases into themselves: a problem, and no value.
std::optional<YamlValue> parseYaml(const std::string& text, const std::string& source, bool with_lines,
                                   Problems& problems);

/// The file's text, or a problem that names the file.
std::optional<std::string> readTextFile(const std::string& path, Problems& problems);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_YAML_VALUE_H

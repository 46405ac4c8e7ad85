// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_CONFIG_YAML_H
#define INVERTER_BUS_CONFIG_YAML_H

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "config/scalar.h"
#include "inverter_bus/config/value.h"

namespace inverter_bus
{
namespace config
{
/// More text than any file of this package has.
constexpr std::size_t LARGEST_YAML = 1048576;

struct YamlEntry;

/// A YAML document in which every value knows its line. Merge keys (<<) are resolved, no key stands twice.
struct YamlNode
{
  enum class Kind
  {
    Scalar,
    List,
    Map
  };
  Kind kind = Kind::Scalar;
  Scalar scalar;
  int line = 0;  ///< from 1
  std::vector<YamlNode> items;
  std::vector<YamlEntry> entries;
};

struct YamlEntry
{
  Scalar key;
  int line = 0;
  YamlNode value;
};

/// A mistake in a text: one line of any bytes (fit it for a log with util::printable()).
struct YamlProblem
{
  int line = 0;      ///< from 1; 0: the whole text
  std::string path;  ///< "scan_list[0].node"; empty: no key
  std::string what;  ///< "is ...: allowed: ..."
};

/// Reads the one document of \p text as PyYAML does, and refuses what not everybody reads alike: a key twice, leading zeros,
/// 1:30, dates, several documents, tabs between words. \return nothing where the text is no YAML document at all; with
/// \p problems the tree is incomplete and must not be used.
std::optional<YamlNode> readYaml(const std::string& text, std::vector<YamlProblem>& problems);

/// As it reaches the node through the parameter server, which carries no empty values, no keys but texts and no whole numbers
/// beyond 32 bits: each of those is a problem (roslaunch ends with a traceback there).
Value toParameters(const YamlNode& node, std::vector<YamlProblem>& problems);

/// The text of a regular file of at most LARGEST_YAML bytes. \return nothing, and \p error says why in a few words
std::optional<std::string> readTextFile(const std::string& path, std::string& error);
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_CONFIG_YAML_H

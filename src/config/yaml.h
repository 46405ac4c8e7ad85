// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_CONFIG_YAML_H
#define INVERTER_BUS_CONFIG_YAML_H

#include <cstddef>
#include <optional>
#include <string>

#include "config/complaints.h"
#include "inverter_bus/config/value.h"

namespace inverter_bus
{
namespace config
{
/// More text than any file of this package has.
constexpr std::size_t LARGEST_YAML = 1048576;

enum class Purpose
{
  /// A file that only this package reads: empty values and keys of any type are there.
  Profile,
  /// As it reaches the node through the parameter server, which sorts the keys and carries no empty values, no keys but texts and
  /// no whole numbers beyond 32 bits: each of those is a mistake (roslaunch ends with a traceback there).
  Parameters
};

/// Reads the one document of \p text as PyYAML does, and refuses what not everybody reads alike: a key twice, leading zeros,
/// 1:30, dates, several documents, tabs between words. Merge keys (<<) are resolved.
/// \param source file name for the places ("source:line"); empty: these are "line 7"
/// \return nothing where the text is no YAML document at all; after a complaint the tree is incomplete and must not be used
std::optional<Value> readYaml(const std::string& text, const std::string& source, Purpose purpose,
                              Complaints& complaints);

/// The same from a regular file of at most LARGEST_YAML bytes.
std::optional<Value> readYamlFile(const std::string& path, Purpose purpose, Complaints& complaints);
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_CONFIG_YAML_H

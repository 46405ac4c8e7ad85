// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_YAML_MEASURE_H
#define INVERTER_BUS_SRC_DRIVE_YAML_MEASURE_H

#include <string>

namespace inverter_bus
{
namespace drive
{
/// Documents in \p yaml: 0, 1, or 2 for more. Looks at the text before nodes are made of it, since yaml-cpp collects
/// documents without end where a comma stands at the beginning of one.
/// \throws YAML::Exception for malformed text, and for one that is nested more deeply than a parser should recurse
int countDocuments(const std::string& yaml);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_YAML_MEASURE_H

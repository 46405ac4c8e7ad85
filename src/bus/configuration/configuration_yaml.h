// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_BUS_CONFIGURATION_YAML_H
#define INVERTER_BUS_SRC_BUS_CONFIGURATION_YAML_H

#include <string>

#include "inverter_bus/bus/configuration.h"

namespace inverter_bus
{
namespace bus
{
/// \p value as YAML text from which the same types are read again: texts are quoted, numbers are not.
std::string toYaml(const Value& value);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_BUS_CONFIGURATION_YAML_H

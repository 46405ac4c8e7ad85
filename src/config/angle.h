// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_CONFIG_ANGLE_H
#define INVERTER_BUS_SRC_CONFIG_ANGLE_H

#include <optional>
#include <string>

namespace inverter_bus
{
namespace config
{
/// What rosparam makes of rad(\p expression): numbers, pi, + - * / ** and parentheses, with Python's precedence. (rosparam
/// evaluates any Python; nothing else makes sense in a file of numbers.) Empty: it is not such an expression.
std::optional<double> radians(const std::string& expression);

/// What rosparam makes of deg(\p number): the angle in radians. Empty: it is not a number.
std::optional<double> degrees(const std::string& number);
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_CONFIG_ANGLE_H

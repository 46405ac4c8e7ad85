// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_CONFIG_SCALAR_H
#define INVERTER_BUS_CONFIG_SCALAR_H

#include <optional>
#include <string>

#include "inverter_bus/config/value.h"

namespace inverter_bus
{
namespace config
{
/// One scalar of a YAML file, read as roslaunch reads it: PyYAML's SafeLoader (YAML 1.1) with rosparam's angles.
struct Scalar : Value
{
  /// Empty, or why it should not be written like this (no reader of YAML 1.1 accepts it, or some read it as something else: 010,
  /// 1:30), and what to write instead.
  std::string trap;
};

/// \p tag as yaml-cpp reports it: "?" or empty: none and no quotes; "!": quotes.
Scalar readScalar(const std::string& text, const std::string& tag = "?");

/// The number that \p text means to people and to most programs, although it is a text to YAML 1.1: 1e2, 5e-3, 1.5e3, +.5.
/// Empty for anything that could mean two numbers (08), or none.
std::optional<double> meantNumber(const std::string& text);

/// What to write in place of a text where a number or a truth value is wanted: "write 100.0", "write 8", ...; empty: no idea.
std::string hintFor(const std::string& text);

/// \p number so that every reader of YAML reads it as a number, and as the same one: 100.0, 0.005, 1.0e-10.
std::string numberInYaml(double number);
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_CONFIG_SCALAR_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_CONFIG_NUMERALS_H
#define INVERTER_BUS_SRC_CONFIG_NUMERALS_H

#include <cstdint>
#include <optional>
#include <string>

namespace inverter_bus
{
namespace config
{
/// A whole number in one of YAML 1.1's five notations.
struct WholeNumeral
{
  bool fits = true;  ///< into 64 bits
  std::int64_t integer = 0;
  double number = 0.0;
  /// Empty, or why it should not be written like this, and what to write.
  std::string trap;
};

/// \p text of one of the forms 10, 1_0, 0x0A, 0b1010, 012, 1:30, with a sign or without.
WholeNumeral readWholeNumeral(const std::string& text);

/// An integer as keys and names spell it: decimal (12, -3) or hexadecimal (0x110A). Strict: no leading zeros (010 is octal to
/// some readers and ten to others), no sign but '-', nothing around it, at most 32 bits.
std::optional<std::int64_t> parseInteger(const std::string& text);

/// Decimal fraction with or without exponent, '_' anywhere, .inf and .nan. Whatever the locale; too large: infinite.
double readDecimal(const std::string& text);

/// 1:30.5, as hours, minutes and seconds are written.
double readSexagesimal(const std::string& text);
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_CONFIG_NUMERALS_H

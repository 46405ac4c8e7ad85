// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_NUMBERS_H
#define INVERTER_BUS_SRC_DRIVE_NUMBERS_H

#include <cstdint>
#include <optional>
#include <string>

namespace inverter_bus
{
namespace drive
{
/// Decimal (12, -3) or hexadecimal (0x110A) integer. Strict: no leading zeros (010 is octal to some readers and ten to
/// others), no sign but '-', nothing around it, at most 32 bits.
std::optional<std::int64_t> parseInteger(const std::string& text);

/// Integer as above or a decimal fraction (0.01, 1e-3). Infinity and NaN are refused.
std::optional<double> parseNumber(const std::string& text);

/// \p counts of \p resolution, rounded so that 1000 counts of 0.01 are exactly 10.0.
double scaleCounts(double counts, double resolution);

/// The inverse: counts (not rounded) that \p value is worth.
double toCounts(double value, double resolution);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_NUMBERS_H

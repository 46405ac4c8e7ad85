// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_NUMBERS_H
#define INVERTER_BUS_SRC_DRIVE_NUMBERS_H

namespace inverter_bus
{
namespace drive
{
/// \p counts of \p resolution, rounded so that 1000 counts of 0.01 are exactly 10.0.
double scaleCounts(double counts, double resolution);

/// The inverse: counts (not rounded) that \p value is worth.
double toCounts(double value, double resolution);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_NUMBERS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_SHOWN_NUMBER_H
#define INVERTER_BUS_WIRE_SHOWN_NUMBER_H

#include <string>

#include "inverter_bus/wire/clock.h"

namespace inverter_bus
{
namespace wire
{
/// \p value as people write it, with at most \p digits significant ones (whole digits are never cut): "0.5", "1230",
/// "0.00003". No exponent from 1e-9 to 1e15; "nan", "inf" and "-inf" as they are. Whatever the locale.
std::string shownNumber(double value, int digits = 6);

/// \p duration in the unit that people would use, three significant digits: "4.01 ms", "158 ms", "3.81 s", "120 s".
std::string shownDuration(Duration duration);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_SHOWN_NUMBER_H

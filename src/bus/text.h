// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_BUS_TEXT_H
#define INVERTER_BUS_SRC_BUS_TEXT_H

#include <string>

#include "inverter_bus/wire/clock.h"

namespace inverter_bus
{
namespace bus
{
namespace text
{
/// \p duration as people write it: "85 ms", "1.5 s".
std::string duration(Duration duration);
/// \p value as people write it: 0.5, not 0.500000. Nine digits at most, so that a value that is a little beyond a limit does
/// not look like the limit.
std::string number(double value);
}  // namespace text
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_BUS_TEXT_H

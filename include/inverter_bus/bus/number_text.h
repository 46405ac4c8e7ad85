// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_NUMBER_TEXT_H
#define INVERTER_BUS_BUS_NUMBER_TEXT_H

#include <string>

namespace inverter_bus
{
namespace bus
{
/// \p value as a person writes it: 0.5, not 0.500000. Nine digits at most, so that a value that is a little beyond a limit
/// doesn't look like the limit.
std::string numberText(double value);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_NUMBER_TEXT_H

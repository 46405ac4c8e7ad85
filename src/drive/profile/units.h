// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_UNITS_H
#define INVERTER_BUS_SRC_DRIVE_UNITS_H

#include <string>

#include "inverter_bus/drive/profile.h"

namespace inverter_bus
{
namespace drive
{
/// The unit that the messages state for a quantity of the status or of the trip memory; empty: it is not a quantity.
std::string unitOfField(const std::string& field);

/// What is wrong with the unit of \p item in \p field, and what is allowed; empty: nothing. An item without a unit has the
/// field's own. Case and a degree sign don't matter, a prefix (mA, kHz) does: nothing is converted.
std::string unitMistake(const std::string& field, const Item& item);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_UNITS_H

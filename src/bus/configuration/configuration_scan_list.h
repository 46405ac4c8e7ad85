// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_BUS_CONFIGURATION_SCAN_LIST_H
#define INVERTER_BUS_SRC_BUS_CONFIGURATION_SCAN_LIST_H

#include <vector>

#include "bus/configuration/configuration_refusals.h"

namespace inverter_bus
{
namespace bus
{
/// Brings both forms of `scan_list` (list of maps, bit mask) to one: a map per inverter with the `defaults` in it, each value with
/// its place. Keys are known, values not judged yet.
std::vector<Value> readScanList(const Section& bus, const std::string& place);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_BUS_CONFIGURATION_SCAN_LIST_H

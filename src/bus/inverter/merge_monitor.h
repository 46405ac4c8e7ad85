// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_MERGE_MONITOR_H
#define INVERTER_BUS_BUS_MERGE_MONITOR_H

#include "inverter_bus/drive/drive.h"

namespace inverter_bus
{
namespace bus
{
/// Adds the values that \p from has to \p to.
void mergeMonitor(const drive::Monitor& from, drive::Monitor& to);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_MERGE_MONITOR_H

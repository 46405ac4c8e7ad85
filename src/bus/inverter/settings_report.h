// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_SETTINGS_REPORT_H
#define INVERTER_BUS_BUS_SETTINGS_REPORT_H

#include <string>
#include <utility>
#include <vector>

#include "bus/inverter/setting_list.h"

namespace inverter_bus
{
namespace bus
{
// What users see of the drive's settings. Pure.

/// WARN lines that say what to set: what commands the drive, what it does when the bus falls silent, whether it restarts by
/// itself (contract, 4.1 and 4.5).
std::vector<Finding> settingFindings(const drive::Drive& drive, const SettingList& settings);
/// Settings as read, for /diagnostics.
std::vector<std::pair<std::string, std::string>> settingValues(const drive::Drive& drive, const SettingList& settings);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_SETTINGS_REPORT_H

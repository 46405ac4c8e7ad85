// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_READ_PLAN_H
#define INVERTER_BUS_SRC_DRIVE_READ_PLAN_H

#include <map>
#include <string>
#include <vector>

#include "inverter_bus/drive/drive.h"

namespace inverter_bus
{
namespace drive
{
/// Packs \p items (by field name) into as few reads as the profile's limits and spans allow: coils first, then
/// registers, each in ascending order. Never splits an item, never reads across a number that might not be answered.
std::vector<ReadBlock> planReads(const std::map<std::string, Item>& items, const Profile& profile);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_READ_PLAN_H

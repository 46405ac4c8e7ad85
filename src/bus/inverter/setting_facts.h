// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_SETTING_FACTS_H
#define INVERTER_BUS_BUS_SETTING_FACTS_H

#include <optional>
#include <vector>

#include "bus/inverter/setting_list.h"

namespace inverter_bus
{
namespace bus
{
/// How the words of a block read and a block write are selected in the drive, by code.
struct BlockSlots
{
  std::vector<int> read;
  std::vector<int> write;
};

// What the drive's settings mean for the bus. Pure.

/// Ratings as read from the drive.
drive::Ratings ratingsOf(const drive::Drive& drive, const SettingList& settings);
/// Selections of the block read and write; empty before all are known, or where the drive refuses the read.
std::optional<BlockSlots> blockSlotsOf(const drive::Drive& drive, const SettingList& settings);
/// The drive's own communication time-out, as read or assumed; nothing: none, or not known yet.
std::optional<Duration> driveTimeoutOf(const drive::Drive& drive, const SettingList& settings);
/// The drive's own reply delay; the profile's alone before it is known.
Duration replyDelayOf(const drive::Drive& drive, const SettingList& settings);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_SETTING_FACTS_H

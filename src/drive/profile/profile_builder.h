// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_PROFILE_BUILDER_H
#define INVERTER_BUS_SRC_DRIVE_PROFILE_BUILDER_H

#include "config/cursor.h"
#include "drive/profile/item_reader.h"
#include "drive/profile/problems.h"
#include "inverter_bus/drive/profile.h"

namespace inverter_bus
{
namespace drive
{
/// Turns the tree of a profile (overrides merged, confirmed marks removed) into a Profile. With problems the result is
/// incomplete and must not be used.
Profile buildProfile(const Value& root, Problems& problems);

// One function per group of top-level keys; each asks the root map for its own keys.
Numbering readNumbering(Section& root);
/// Must come before everything that may name a constant.
void readConstants(Section& root, Numbering& numbering, Profile& profile);
void readIdentity(Section& root, Profile& profile);
void readLine(Section& root, Profile& profile);
void readLimits(Section& root, const Numbering& numbering, Profile& profile);
void readTiming(Section& root, Profile& profile);
void readCommands(Section& root, const Numbering& numbering, Profile& profile);
void readStatus(Section& root, const Numbering& numbering, Profile& profile);
void readFaults(Section& root, const Numbering& numbering, Profile& profile);
void readBlock(Section& root, const Numbering& numbering, Profile& profile);
/// After the parameters: its table names them.
void readMap(Section& root, const Numbering& numbering, Profile& profile);
void readRatings(Section& root, Profile& profile);
void readParameters(Section& root, const Numbering& numbering, Profile& profile);
void readSupervision(Section& root, Profile& profile);

/// Whether \p item is left out of \p field, since its unit is not the field's: a value that is a thousand times too large
/// is worse than none. Notes a mistake in the profile then.
bool leftOutForUnit(const std::string& field, const Item& item, const Cursor& cursor, Profile& profile);

/// Names that operation_codes may have.
const std::vector<std::string>& operationCodeNames();

/// Mistakes that only show when all sections are read: references, functions, limits, overlaps.
void checkReferences(const Value& root, const Profile& profile, config::Complaints& complaints);
void checkAbilities(const Value& root, const Profile& profile, config::Complaints& complaints);
void checkBlock(const Value& root, const Profile& profile, config::Complaints& complaints);
void checkMap(const Value& root, const Profile& profile, config::Complaints& complaints);
void checkOverlaps(const Value& root, const Profile& profile, config::Complaints& complaints);

/// The value at a way like "points.run" for a complaint; the nearest one above it where it doesn't exist.
Cursor locate(const Value& root, const std::string& path, config::Complaints& complaints);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_PROFILE_BUILDER_H

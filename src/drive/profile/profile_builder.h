// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_PROFILE_BUILDER_H
#define INVERTER_BUS_SRC_DRIVE_PROFILE_BUILDER_H

#include "drive/profile/item_reader.h"
#include "drive/profile/problems.h"
#include "drive/profile/yaml_reader.h"
#include "drive/profile/yaml_value.h"
#include "inverter_bus/drive/profile.h"

namespace inverter_bus
{
namespace drive
{
/// Turns the tree of a profile (overrides merged, confirmed marks removed) into a Profile. With problems the result is
/// incomplete and must not be used.
Profile buildProfile(const YamlValue& root, Problems& problems);

// One function per group of top-level keys; each asks the root map for its own keys.
Numbering readNumbering(YamlMap& root);
/// Must come before everything that may name a constant.
void readConstants(YamlMap& root, Numbering& numbering, Profile& profile);
void readIdentity(YamlMap& root, Profile& profile);
void readLine(YamlMap& root, Profile& profile);
void readLimits(YamlMap& root, const Numbering& numbering, Profile& profile);
void readTiming(YamlMap& root, Profile& profile);
void readCommands(YamlMap& root, const Numbering& numbering, Profile& profile);
void readStatus(YamlMap& root, const Numbering& numbering, Profile& profile);
void readFaults(YamlMap& root, const Numbering& numbering, Profile& profile);
void readBlock(YamlMap& root, const Numbering& numbering, Profile& profile);
/// After the parameters: its table names them.
void readMap(YamlMap& root, const Numbering& numbering, Profile& profile);
void readRatings(YamlMap& root, Profile& profile);
void readParameters(YamlMap& root, const Numbering& numbering, Profile& profile);
void readSupervision(YamlMap& root, Profile& profile);

/// Whether \p item is left out of \p field, since its unit is not the field's: a value that is a thousand times too large
/// is worse than none. Notes a harmless mistake then.
bool leftOutForUnit(const std::string& field, const Item& item, const YamlCursor& cursor);

/// Names that operation_codes may have.
const std::vector<std::string>& operationCodeNames();

/// What only shows when all sections are read: references, functions, limits, overlaps.
void checkReferences(const YamlValue& root, const Profile& profile, Problems& problems);
void checkAbilities(const YamlValue& root, const Profile& profile, Problems& problems);
void checkBlock(const YamlValue& root, const Profile& profile, Problems& problems);
void checkMap(const YamlValue& root, const Profile& profile, Problems& problems);
void checkOverlaps(const YamlValue& root, const Profile& profile, Problems& problems);

/// The value at a way like "points.run" for a complaint; the nearest one above it where it doesn't exist.
YamlCursor locate(const YamlValue& root, const std::string& path, Problems& problems);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_PROFILE_BUILDER_H

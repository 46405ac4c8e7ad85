// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_PROFILE_OVERRIDES_H
#define INVERTER_BUS_SRC_DRIVE_PROFILE_OVERRIDES_H

#include <map>
#include <set>
#include <string>
#include <vector>

#include "config/complaints.h"

namespace inverter_bus
{
namespace drive
{
using config::Entry;
using config::Value;

/// All names that a profile marks as unconfirmed.
std::set<std::string> unconfirmedNames(const Value& root);

/// Names of the constants and the marks that they carry: a user may confirm a constant by either.
std::map<std::string, std::string> constantMarks(const Value& root);

/// Moves keys of \p changes that are names of constants in \p root under `constants`, where they belong.
void nameConstants(const Value& root, Value& changes);

/// Puts \p changes over \p root: maps are merged key by key, anything else is replaced. A value that says what is
/// written, where it lies or what a count means confirms the item that it is in.
void mergeOverrides(Value& root, const Value& changes);

/// Removes the marks of \p names (or of all of them); a name that is not in \p known is a problem.
void confirm(Value& root, const std::vector<std::string>& names, const std::set<std::string>& known,
             const std::string& place, config::Complaints& complaints);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_PROFILE_OVERRIDES_H

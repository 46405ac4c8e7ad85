// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_PROFILE_SKIP_H
#define INVERTER_BUS_SRC_DRIVE_PROFILE_SKIP_H

#include <string>
#include <vector>

#include "inverter_bus/config/value.h"

namespace inverter_bus
{
namespace drive
{
using config::Entry;
using config::Value;

/// Takes what \p names leave out (see skippableFields()) from the tree of a profile, before reads or marks are made
/// from it. Fields that a drive does not have are left out already. Constants that only such items used go with them.
void skipFields(Value& root, const std::vector<std::string>& names);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_PROFILE_SKIP_H

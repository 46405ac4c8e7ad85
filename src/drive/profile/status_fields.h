// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_STATUS_FIELDS_H
#define INVERTER_BUS_SRC_DRIVE_STATUS_FIELDS_H

#include <map>
#include <optional>
#include <set>
#include <string>

#include "inverter_bus/drive/drive.h"

namespace inverter_bus
{
namespace drive
{
using FlagField = std::optional<bool> Monitor::*;
using QuantityField = std::optional<double> Monitor::*;
using RecordField = std::optional<double> FaultRecord::*;

/// Fields of the status that are true or false.
const std::map<std::string, FlagField>& flagFields();
/// Fields that are a quantity with a unit.
const std::map<std::string, QuantityField>& quantityFields();
/// Fields that are a bare number of the drive: raw_status, fault_code, warning_code.
const std::set<std::string>& codeFields();
/// Quantities of an entry of the trip memory (its code apart).
const std::map<std::string, RecordField>& recordFields();
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_STATUS_FIELDS_H

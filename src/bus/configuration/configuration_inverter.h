// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_BUS_CONFIGURATION_INVERTER_H
#define INVERTER_BUS_SRC_BUS_CONFIGURATION_INVERTER_H

#include <string>

#include "bus/configuration/configuration_refusals.h"
#include "inverter_bus/drive/drive.h"

namespace inverter_bus
{
namespace bus
{
/// A judged entry of the scan list with its drive.
struct ConfiguredInverter
{
  InverterConfig config;
  drive::Drive drive;
};

/// Judges one entry by itself and against its drive's profile; what it shares with others (unique names, serial settings)
/// is not looked at.
ConfiguredInverter readInverter(const Section& entry, const BusConfig& bus, const std::string& profile_directory);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_BUS_CONFIGURATION_INVERTER_H

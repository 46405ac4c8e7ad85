// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SRC_SIMULATION_BUS_CONFIG_DRIVES_H
#define INVERTER_BUS_SRC_SIMULATION_BUS_CONFIG_DRIVES_H

#include "config/cursor.h"
#include "inverter_bus/simulation/bus_config.h"

namespace inverter_bus
{
namespace simulation
{
/// The map `simulation`: what it says about drives of the scan list, and drives that no scan list knows. \p line is what a
/// further drive is set to unless it says otherwise. \throws ConfigError
void readSimulation(const config::Cursor& simulation, const LineSettings& line, BusConfig& config);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_SIMULATION_BUS_CONFIG_DRIVES_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_PANEL_PARAMETERS_H
#define INVERTER_BUS_SIMULATION_PANEL_PARAMETERS_H

#include <string>

#include "inverter_bus/simulation/simulated_drive.h"
#include "simulation/drives/parameter_memory.h"

namespace inverter_bus
{
namespace simulation
{
/// @name A drive's parameters as its panel shows and sets them: by code, in the panel's unit
/// @param model the drive's name for the texts
/// @{

/// @return what the RAM holds
double panelValue(const ParameterMemory& memory, ParameterMemory::Index index);

/// How the drive was set before the simulation began. @throws std::invalid_argument for a code or value that it doesn't
/// have
void commissionAtPanel(ParameterMemory& memory, const std::string& model, const std::string& code, double value);

/// Sets RAM and EEPROM.
Refusal setAtPanel(ParameterMemory& memory, const std::string& model, const std::string& code, double value);

/// @param[out] values what RAM and EEPROM hold
Refusal showAtPanel(const ParameterMemory& memory, const std::string& model, const std::string& code,
                    KeyValues& values);
/// @}
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_PANEL_PARAMETERS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_TOSHIBA_PARAMETERS_H
#define INVERTER_BUS_SIMULATION_TOSHIBA_PARAMETERS_H

#include <vector>

#include "simulation/drives/parameter_memory.h"

namespace inverter_bus
{
namespace simulation
{
/// Parameters of a VF-S15 as it leaves the factory, for 60 Hz, and its name plate (FE70, FE71).
std::vector<Parameter> vfs15Parameters();
/// The same without block slots, set to 9600 baud.
std::vector<Parameter> vfs11Parameters();
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_TOSHIBA_PARAMETERS_H

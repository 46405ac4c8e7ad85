// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_JE_PARAMETERS_H
#define INVERTER_BUS_SIMULATION_JE_PARAMETERS_H

#include <vector>

#include "simulation/drives/parameter_memory.h"

namespace inverter_bus
{
namespace simulation
{
constexpr std::uint32_t JE_LAST_C3 = 0x000B;
constexpr std::uint32_t JE_HIGHEST_REFERENCE = 1200;  // [0.1 Hz]

/// Parameters of the 3G3JE. C3/0000-000B with names, ranges and values from the factory: manual I548, section 4 (0.2 kW
/// drive); the P numbers are address + 1, and the range of P12 is not known. P15-P19 (the line): section 1, on the
/// panel only. The rest has no parameter number: the reference (C1/0000), and ramps that are invented.
std::vector<Parameter> jeParameters();
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_JE_PARAMETERS_H

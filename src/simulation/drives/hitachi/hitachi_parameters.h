// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_HITACHI_PARAMETERS_H
#define INVERTER_BUS_SIMULATION_HITACHI_PARAMETERS_H

#include <vector>

#include "simulation/drives/parameter_memory.h"

namespace inverter_bus
{
namespace simulation
{
/// Parameter tables, written down from the manuals' register lists (MX2-SYS and I570 appendix B; SJ700a appendix B;
/// what only the public driver PYMX2 names is taken from there). Ranges marked M in the source are from memory.
std::vector<Parameter> mx2Parameters();
std::vector<Parameter> rxParameters();
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_HITACHI_PARAMETERS_H

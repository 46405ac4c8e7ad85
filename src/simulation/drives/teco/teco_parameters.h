// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_TECO_PARAMETERS_H
#define INVERTER_BUS_SIMULATION_TECO_PARAMETERS_H

#include <vector>

#include "simulation/drives/parameter_memory.h"

namespace inverter_bus
{
namespace simulation
{
/// First register of the parameters. **Invented for the simulation:** no address of a 7200MA parameter is known.
constexpr std::uint16_t TECO_PARAMETERS = 0x0300;

/// The parameters that the bus has to do with. Codes, meanings, and the values of Sn-36 to Sn-39 and Cn-27: MODBUS
/// manual p. 3-5. Bn-01, Cn-02, the value 2 of Sn-04 and Sn-05 and the other ranges are from memory; all addresses are
/// invented.
std::vector<Parameter> tecoParameters();
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_TECO_PARAMETERS_H

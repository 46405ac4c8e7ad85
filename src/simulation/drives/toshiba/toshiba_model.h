// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_TOSHIBA_MODEL_H
#define INVERTER_BUS_SIMULATION_TOSHIBA_MODEL_H

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/drives/parameter_memory.h"
#include "simulation/modbus/modbus_slave.h"

namespace inverter_bus
{
namespace simulation
{
/// In what two drives of the Toshiba family differ. Sources: E6581913 = VF-S15 communication manual, LCNC = LinuxCNC's
/// vfs11_vfd (VF-S11).
struct ToshibaModel
{
  std::string name;
  ModbusLimits limits;
  bool blocks = false;            ///< reads of several words, 1870h and 1875h, 17h, 2Bh
  bool older_monitors = false;    ///< FE09, FE45, FE46
  std::uint16_t series_code = 0;  ///< FB07
  std::uint16_t alarm_bits = 0;   ///< FC91: those that the drive has
  std::vector<Parameter> parameters;
};

/// VF-S15.
const ToshibaModel& toshibaVfs15();
/// VF-S11: one word per request, no blocks. Its FB07 is unknown; here it is 211, so that it can't be taken for a VF-S15.
const ToshibaModel& toshibaVfs11();
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_TOSHIBA_MODEL_H

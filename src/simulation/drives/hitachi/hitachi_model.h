// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_HITACHI_MODEL_H
#define INVERTER_BUS_SIMULATION_HITACHI_MODEL_H

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "simulation/drives/parameter_memory.h"
#include "simulation/modbus/modbus_slave.h"

namespace inverter_bus
{
namespace simulation
{
/// In what two drives of the Hitachi family differ. Keys of the sources:
/// I585 = OMRON 3G3MX2-V1 manual, MX2-SYS = SYSDRIVE MX2 manual chapter 6, I578 = OMRON 3G3RX-V1 manual,
/// SJ700a = Hitachi SJ700-2 appendix B, PYMX2 = public Python driver made from I570, SEED = OMRON INV003.
struct HitachiModel
{
  std::string name;
  ModbusLimits limits;
  int last_station = 0;                ///< highest number that C072 takes
  int inputs = 0;                      ///< multi-function inputs: coils 0007h ...
  bool groups = false;                 ///< stations 250-254 address groups of stations
  bool coil_mirror = false;            ///< registers 1E01h-1E05h and 1F01h repeat the coils
  bool busy_exception = false;         ///< a write during an EEPROM write gives 26h, else 22h
  double current_step = 0.01;          ///< [A] of d002 and of the trip blocks
  double trip_voltage_step = 0.1;      ///< [V] of the trip blocks
  std::map<int, std::uint32_t> bauds;  ///< baud rate -> code of C071
  std::vector<Parameter> parameters;
};

/// OMRON 3G3MX2-V1 (Hitachi WJ200 family).
const HitachiModel& omronMx2();
/// OMRON 3G3RX-V1 (Hitachi SJ700 family).
const HitachiModel& omronRx();
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_HITACHI_MODEL_H

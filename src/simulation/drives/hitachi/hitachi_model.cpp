// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/hitachi/hitachi_model.h"

#include "simulation/drives/hitachi/hitachi_parameters.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
HitachiModel makeMx2()
{
  HitachiModel model;
  model.name = "omron_mx2";
  // Functions and limits: MX2-SYS chapter 6 (read up to 16 registers, 32 coils); broadcast: same chapter, only writes.
  model.limits.functions = { 0x01, 0x03, 0x05, 0x06, 0x08, 0x0F, 0x10, 0x17 };
  model.limits.broadcast_functions = { 0x05, 0x06, 0x0F, 0x10 };
  model.limits.coils = 32;
  model.limits.read_registers = 16;
  model.limits.write_registers = 16;
  model.last_station = 247;
  model.inputs = 7;
  model.groups = true;
  model.coil_mirror = true;
  model.current_step = 0.01;      // MX2-SYS, d002
  model.trip_voltage_step = 0.1;  // MX2-SYS; a real drive answered 0D02h = 333.0 V
  // C071, I585 and SEED: 3 = 2400 ... 10 = 115200.
  model.bauds = { { 2400, 3 },  { 4800, 4 },  { 9600, 5 },  { 19200, 6 },
                  { 38400, 7 }, { 57600, 8 }, { 76800, 9 }, { 115200, 10 } };
  model.parameters = mx2Parameters();
  return model;
}

HitachiModel makeRx()
{
  HitachiModel model;
  model.name = "omron_rx";
  // SJ700a appendix B: no 17h, 4 registers (8 bytes) a request; I578 p. 487: 32 coils.
  model.limits.functions = { 0x01, 0x03, 0x05, 0x06, 0x08, 0x0F, 0x10 };
  model.limits.broadcast_functions = { 0x05, 0x06, 0x0F, 0x10 };
  model.limits.coils = 32;
  model.limits.read_registers = 4;
  model.limits.write_registers = 4;
  model.last_station = 32;
  model.inputs = 8;
  model.busy_exception = true;                                            // 26h: SJ700D
  model.current_step = 0.1;                                               // SJ700a (trip block); d002 taken the same
  model.trip_voltage_step = 1.0;                                          // SJ700a
  model.bauds = { { 2400, 3 }, { 4800, 4 }, { 9600, 5 }, { 19200, 6 } };  // C071, I578
  model.parameters = rxParameters();
  return model;
}
}  // namespace

const HitachiModel& omronMx2()
{
  static const HitachiModel MODEL = makeMx2();
  return MODEL;
}

const HitachiModel& omronRx()
{
  static const HitachiModel MODEL = makeRx();
  return MODEL;
}
}  // namespace simulation
}  // namespace inverter_bus

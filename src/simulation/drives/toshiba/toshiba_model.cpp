// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/toshiba/toshiba_model.h"

#include "simulation/drives/toshiba/toshiba_parameters.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
ToshibaModel vfs15()
{
  ToshibaModel model;
  model.name = "toshiba_vfs15";
  model.limits.functions = { 0x03, 0x06, 0x10, 0x17 };
  model.limits.broadcast_functions = { 0x06, 0x10 };
  model.limits.read_registers = 8;
  model.limits.write_registers = 2;
  model.blocks = true;
  model.series_code = 224;
  model.alarm_bits = 0xFFFF;
  model.parameters = vfs15Parameters();
  return model;
}

ToshibaModel vfs11()
{
  ToshibaModel model;
  model.name = "toshiba_vfs11";
  model.limits.functions = { 0x03, 0x06 };
  model.limits.broadcast_functions = { 0x06 };
  model.limits.read_registers = 1;
  model.limits.write_registers = 1;
  model.older_monitors = true;
  model.series_code = 211;
  model.alarm_bits = 0xE7BF;  // 6, 11, 12 reserved: LCNC
  model.parameters = vfs11Parameters();
  return model;
}
}  // namespace

const ToshibaModel& toshibaVfs15()
{
  static const ToshibaModel MODEL = vfs15();
  return MODEL;
}

const ToshibaModel& toshibaVfs11()
{
  static const ToshibaModel MODEL = vfs11();
  return MODEL;
}
}  // namespace simulation
}  // namespace inverter_bus

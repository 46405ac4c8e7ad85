// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include <algorithm>

#include "inverter_bus/simulation/bus_config.h"
#include "inverter_bus/simulation/hitachi_drive.h"

namespace inverter_bus
{
namespace simulation
{
std::vector<std::string> driveModels()
{
  return { "omron_mx2", "omron_rx" };
}

std::unique_ptr<SimulatedDrive> makeDrive(const DriveConfig& config)
{
  try
  {
    if (config.model == "omron_mx2")
    {
      return std::make_unique<HitachiDrive>(omronMx2(), config.options);
    }
    if (config.model == "omron_rx")
    {
      return std::make_unique<HitachiDrive>(omronRx(), config.options);
    }
  }
  catch (const std::invalid_argument& error)
  {
    throw ConfigError(config.options.name + ": " + error.what());
  }
  throw ConfigError(config.options.name + ": no simulated drive " + config.model);
}
}  // namespace simulation
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include <algorithm>

#include "inverter_bus/simulation/bus_config.h"
#include "simulation/drives/hitachi/hitachi_drive.h"
#include "simulation/drives/je/je_drive.h"
#include "simulation/drives/teco/teco_drive.h"
#include "simulation/drives/toshiba/toshiba_vfs15.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
using Maker = std::unique_ptr<SimulatedDrive> (*)(const DriveOptions& options);

struct Model
{
  const char* name;
  Protocol protocol;
  Maker make;
};

template <typename Drive>
std::unique_ptr<SimulatedDrive> make(const DriveOptions& options)
{
  return std::make_unique<Drive>(options);
}

std::unique_ptr<SimulatedDrive> makeMx2(const DriveOptions& options)
{
  return std::make_unique<HitachiDrive>(omronMx2(), options);
}

std::unique_ptr<SimulatedDrive> makeRx(const DriveOptions& options)
{
  return std::make_unique<HitachiDrive>(omronRx(), options);
}

std::unique_ptr<SimulatedDrive> makeVfs15(const DriveOptions& options)
{
  return std::make_unique<ToshibaVfs15>(toshibaVfs15(), options);
}

std::unique_ptr<SimulatedDrive> makeVfs11(const DriveOptions& options)
{
  return std::make_unique<ToshibaVfs15>(toshibaVfs11(), options);
}

const std::vector<Model>& models()
{
  static const std::vector<Model> MODELS = {
    { "omron_mx2", Protocol::ModbusRtu, makeMx2 },           { "omron_rx", Protocol::ModbusRtu, makeRx },
    { "toshiba_vfs15", Protocol::ModbusRtu, makeVfs15 },     { "toshiba_vfs11", Protocol::ModbusRtu, makeVfs11 },
    { "teco_7200ma", Protocol::ModbusRtu, make<TecoDrive> }, { "omron_3g3je", Protocol::CompowayF, make<JeDrive> },
  };
  return MODELS;
}

const Model& modelOf(const DriveConfig& config)
{
  const auto found = std::find_if(models().begin(), models().end(),
                                  [&config](const Model& model) { return config.model == model.name; });
  if (found == models().end())
  {
    throw ConfigError(config.options.name + ": no simulated drive " + config.model);
  }
  return *found;
}
}  // namespace

std::vector<std::string> driveModels()
{
  std::vector<std::string> names;
  std::transform(models().begin(), models().end(), std::back_inserter(names),
                 [](const Model& model) { return model.name; });
  return names;
}

Protocol protocolOf(const DriveConfig& config)
{
  return modelOf(config).protocol;
}

std::unique_ptr<SimulatedDrive> makeDrive(const DriveConfig& config)
{
  try
  {
    return config.make ? config.make(config.options) : modelOf(config).make(config.options);
  }
  catch (const std::invalid_argument& error)
  {
    throw ConfigError(config.options.name + ": " + error.what());
  }
}
}  // namespace simulation
}  // namespace inverter_bus

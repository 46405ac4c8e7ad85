// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/plant.h"

#include <cmath>

#include "simulation/drives/motor.h"

namespace inverter_bus
{
namespace fuzz
{
Plant::Plant(const Scene& scene, simulation::SimulatedBus& bus) : scene_(scene), bus_(bus)
{
}

void Plant::advance(TimePoint now, std::size_t index)
{
  bus_.drives()[index]->advance(now);
}

Truth Plant::truth(std::size_t index) const
{
  const simulation::Motor& motor = bus_.drives()[index]->motor();
  const Brand brand = scene_.inverters[index].brand;
  Truth truth;
  truth.hertz = std::fabs(motor.frequency());
  truth.direction = motor.frequency() == 0.0 ? 0 : (motor.frequency() > 0.0 ? 1 : -1);
  if (brand == Brand::HITACHI || brand == Brand::TOSHIBA)
  {
    truth.torque = std::fabs(motor.torque());
  }
  return truth;
}

bool Plant::runLatched(std::size_t index) const
{
  return bus_.drives()[index]->runCommand();
}

std::string Plant::value(std::size_t index, const std::string& key) const
{
  for (const auto& value : bus_.drives()[index]->describe())
  {
    if (value.first == key)
    {
      return value.second;
    }
  }
  return "";
}

bool Plant::flag(std::size_t index, const std::string& key) const
{
  return value(index, key) == "1";
}

double Plant::ram(std::size_t index, const std::string& parameter) const
{
  simulation::KeyValues values;
  bus_.drives()[index]->parameter(parameter, values);
  for (const auto& value : values)
  {
    if (value.first == "ram")
    {
      return std::stod(value.second);
    }
  }
  return 0.0;
}
}  // namespace fuzz
}  // namespace inverter_bus

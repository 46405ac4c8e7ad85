// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/motor_usage.h"

#include <algorithm>

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr double HOUR = 3600.0;         // [s]
constexpr double OVERLOAD_TIME = 60.0;  // [s] at 150 % of the thermal level until the overload trip
}  // namespace

MotorUsage::MotorUsage(int station, double cooling_time)
  : cooling_time_(cooling_time), run_time_(HOUR * (300 + station)), power_time_(HOUR * (1200 + station))
{
}

void MotorUsage::count(const Motor& motor, bool powered, double share, double seconds)
{
  power_time_ += powered ? seconds : 0.0;
  run_time_ += motor.turning() ? seconds : 0.0;
  energy_ += motor.power() * seconds / HOUR;
  const double excess = share * share - 1.0;
  heat_ += excess > 0.0 ? seconds * excess / (1.25 * OVERLOAD_TIME) : seconds * excess / cooling_time_;
  heat_ = std::max(0.0, heat_);
}

void MotorUsage::coolDown()
{
  heat_ = 0.0;
}

void MotorUsage::clearEnergy()
{
  energy_ = 0.0;
}

double MotorUsage::heat() const
{
  return heat_;
}

double MotorUsage::runTime() const
{
  return run_time_;
}

double MotorUsage::powerTime() const
{
  return power_time_;
}

double MotorUsage::energy() const
{
  return energy_;
}
}  // namespace simulation
}  // namespace inverter_bus

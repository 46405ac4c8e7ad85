// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_MOTOR_USAGE_H
#define INVERTER_BUS_SIMULATION_MOTOR_USAGE_H

#include "simulation/drives/motor.h"

namespace inverter_bus
{
namespace simulation
{
/// What a drive adds up about its motor: hours, energy, and the heat that its electronic thermal protection reckons.
class MotorUsage
{
public:
  /// A drive that has been in use for some time: every \p station shows other hours. \p cooling_time [s] is how long the
  /// motor takes to cool down from the thermal level without current.
  MotorUsage(int station, double cooling_time);

  /// Another \p seconds have passed. \p share of the thermal level is the current that flowed, >= 0.
  void count(const Motor& motor, bool powered, double share, double seconds);
  void coolDown();
  void clearEnergy();

  double heat() const;       ///< 0: cold, 1: overload trip (150 % of the thermal level for 60 s)
  double runTime() const;    ///< [s] that the motor has turned
  double powerTime() const;  ///< [s] that the drive has been on
  double energy() const;     ///< [kWh] since it was cleared

private:
  double cooling_time_;
  double heat_ = 0.0;
  double run_time_;
  double power_time_;
  double energy_ = 0.0;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_MOTOR_USAGE_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_MOTOR_WATCH_H
#define INVERTER_BUS_SIMULATION_MOTOR_WATCH_H

#include <string>

#include "inverter_bus/simulation/simulated_drive.h"
#include "inverter_bus/simulation/time.h"
#include "simulation/drives/motor.h"

namespace inverter_bus
{
namespace simulation
{
/// From this on (x rated current) a drive trips at once.
constexpr double OVERCURRENT = 2.2;

/// When a drive should look at its motor again: at the end of the present piece of the ramp, at most 0.1 s later; not
/// before `limit` when the motor is at rest.
TimePoint nextLook(const Motor& motor, TimePoint now, TimePoint limit);

/// What the motor really does, in the words of `NAME show`. \p current [A] is what the drive measures.
void appendMotor(const Motor& motor, double current, KeyValues& values);

/// With two decimals: "50.00".
std::string twoDecimals(double value);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_MOTOR_WATCH_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/motor_watch.h"

#include <algorithm>
#include <cmath>

#include "util/text.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr double STEP = 0.1;  // [s] between two looks at current and temperature while the motor turns
}  // namespace

TimePoint nextLook(const Motor& motor, TimePoint now, TimePoint limit)
{
  if (!motor.turning())
  {
    return limit;
  }
  const double corner = motor.timeToNextCorner();
  // One tick more: the corner must not be missed by rounding down.
  return std::min(limit, now + (corner > 0.0 && corner < STEP ? seconds(corner) + Duration(1) : seconds(STEP)));
}

void appendMotor(const Motor& motor, double current, KeyValues& values)
{
  const double frequency = motor.frequency();
  values.emplace_back("frequency", twoDecimals(std::abs(frequency)));
  values.emplace_back("direction", frequency == 0.0 ? "0" : (frequency > 0.0 ? "1" : "-1"));
  values.emplace_back("target", twoDecimals(motor.target()));
  values.emplace_back("running", motor.turning() ? "1" : "0");
  values.emplace_back("ramp", motor.accelerating() ? "accelerating" : (motor.decelerating() ? "decelerating" : "none"));
  values.emplace_back("current", twoDecimals(current));
  values.emplace_back("load", twoDecimals(motor.load()));
  values.emplace_back("dc_voltage", twoDecimals(motor.dcVoltage()));
  values.emplace_back("temperature", twoDecimals(motor.temperature()));
}

std::string twoDecimals(double value)
{
  return util::fixedText(value, 2);
}
}  // namespace simulation
}  // namespace inverter_bus

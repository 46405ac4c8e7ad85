// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/motor.h"

#include <algorithm>
#include <cmath>

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr double EPSILON = 1e-9;
constexpr double MAGNETISING = 0.4;         // share of the rated current that flows without load
constexpr double RAMP_TORQUE = 0.25;        // share of the rated torque that speeds the inertia up
constexpr double AMBIENT = 25.0;            // [degC]
constexpr double RISE = 30.0;               // [K] of the heat sink at rated current
constexpr double THERMAL_TIME = 600.0;      // [s]
constexpr double POWER_FACTOR = 0.85;       // of output current and voltage, taken as constant
constexpr double DC_PER_AC = 1.4142135624;  // rectified mains

double sign(double value)
{
  return value < 0.0 ? -1.0 : 1.0;
}
}  // namespace

Motor::Motor(const MotorRating& rating) : rating_(rating)
{
}

void Motor::setRating(const MotorRating& rating)
{
  rating_ = rating;
}

void Motor::setRamps(const Ramps& ramps)
{
  ramps_ = ramps;
}

void Motor::setLoad(double load)
{
  load_ = load;
}

double Motor::load() const
{
  return load_;
}

void Motor::rampTo(double hertz)
{
  target_ = std::abs(hertz) + EPSILON < ramps_.start ? 0.0 : hertz;
}

void Motor::cut()
{
  frequency_ = 0.0;
  target_ = 0.0;
}

double Motor::timeToNextCorner() const
{
  const double size = std::abs(frequency_);
  if (accelerating())
  {
    return std::max(0.0, (std::abs(target_) - std::max(size, ramps_.start)) / ramps_.maximum * ramps_.acceleration);
  }
  if (decelerating())
  {
    const bool through_zero = target_ == 0.0 || sign(target_) != sign(frequency_);
    const double end = through_zero ? ramps_.start : std::abs(target_);
    return std::max(0.0, (size - end) / ramps_.maximum * ramps_.deceleration);
  }
  return 0.0;
}

void Motor::moveFrequency(double& seconds)
{
  const double step = std::min(seconds, timeToNextCorner());
  const double direction = sign(frequency_ == 0.0 ? target_ : frequency_);
  if (accelerating())
  {
    const double from = std::max(std::abs(frequency_), ramps_.start);
    const double size = from + step * ramps_.maximum / ramps_.acceleration;
    frequency_ = direction * (size + EPSILON >= std::abs(target_) ? std::abs(target_) : size);
  }
  else if (decelerating())
  {
    const bool through_zero = target_ == 0.0 || sign(target_) != sign(frequency_);
    const double end = through_zero ? ramps_.start : std::abs(target_);
    const double size = std::abs(frequency_) - step * ramps_.maximum / ramps_.deceleration;
    frequency_ = size > end + EPSILON ? direction * size : (through_zero ? 0.0 : target_);
  }
  seconds -= step;
}

void Motor::advance(double seconds)
{
  const double share = current() / rating_.current;
  const double warm = AMBIENT + RISE * share * share;
  temperature_ = warm + (temperature_ - warm) * std::exp(-seconds / THERMAL_TIME);
  // At most: brake to standstill, start the other way, reach the target.
  for (int piece = 0; piece < 4 && frequency_ != target_; ++piece)
  {
    moveFrequency(seconds);
    if (seconds <= 0.0)
    {
      break;
    }
  }
}

double Motor::frequency() const
{
  return frequency_;
}

double Motor::target() const
{
  return target_;
}

bool Motor::turning() const
{
  return frequency_ != 0.0;
}

bool Motor::accelerating() const
{
  return target_ != 0.0 && (frequency_ == 0.0 || sign(target_) == sign(frequency_)) &&
         std::abs(frequency_) < std::abs(target_);
}

bool Motor::decelerating() const
{
  return frequency_ != 0.0 && frequency_ != target_ && !accelerating();
}

double Motor::torque() const
{
  if (!turning())
  {
    return 0.0;
  }
  const double ramp = accelerating() ? RAMP_TORQUE : (decelerating() ? -RAMP_TORQUE : 0.0);
  return sign(frequency_) * 100.0 * (load_ + ramp);
}

double Motor::current() const
{
  if (!turning())
  {
    return 0.0;
  }
  const double share = torque() / 100.0;
  return rating_.current * std::sqrt(MAGNETISING * MAGNETISING + (1.0 - MAGNETISING * MAGNETISING) * share * share);
}

double Motor::voltage() const
{
  return rating_.voltage * std::min(1.0, std::abs(frequency_) / rating_.frequency);
}

double Motor::dcVoltage() const
{
  const double share = std::abs(torque()) / 100.0;
  const double bus = rating_.voltage * DC_PER_AC;
  return decelerating() ? bus * 1.06 : bus * (1.0 - 0.02 * share);
}

double Motor::power() const
{
  return decelerating() ? 0.0 : std::sqrt(3.0) * voltage() * current() * POWER_FACTOR / 1000.0;
}

double Motor::temperature() const
{
  return temperature_;
}
}  // namespace simulation
}  // namespace inverter_bus

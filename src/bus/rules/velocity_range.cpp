// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/rules/velocity_range.h"

#include <algorithm>
#include <cmath>

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, 8.5. A float has 24 bits: what was meant as 0.3 arrives as 0.30000001192, which is 4e-8 of it too much.
constexpr double ROUNDING = 1e-6;

RangedVelocity refused(const std::string& why)
{
  RangedVelocity ranged;
  ranged.why = why;
  return ranged;
}

RangedVelocity ofKind(RangedVelocity::Kind kind)
{
  RangedVelocity ranged;
  ranged.kind = kind;
  return ranged;
}
}  // namespace

VelocityRange::VelocityRange(const drive::Drive& drive, const InverterConfig& config) : drive_(drive), config_(config)
{
}

bool VelocityRange::nearZero(double velocity) const
{
  // The same rounding at the lower end: the minimum as a float is no stop.
  const bool below = std::fabs(velocity) < config_.min_velocity * (1.0 - ROUNDING);
  return below || drive_.frequencyCounts(std::fabs(velocity * config_.hz_per_unit)) == 0;
}

bool VelocityRange::beyond(double velocity) const
{
  return std::fabs(velocity) > config_.max_velocity * (1.0 + ROUNDING);
}

bool VelocityRange::stops(double velocity) const
{
  return std::isfinite(velocity) && (velocity == 0.0 || (!beyond(velocity) && nearZero(velocity)));
}

double VelocityRange::factorFor(double velocity) const
{
  const bool clamped = config_.limit == Limit::Saturate && std::isfinite(velocity) && beyond(velocity);
  return clamped ? config_.max_velocity / std::fabs(velocity) : 1.0;
}

RangedVelocity VelocityRange::judge(double velocity, double factor) const
{
  if (!std::isfinite(velocity))
  {
    return refused("velocity " + util::numberText(velocity, 9) + " is not a finite number");
  }
  if (stops(velocity))
  {
    return ofKind(velocity == 0.0 ? RangedVelocity::Kind::Zero : RangedVelocity::Kind::NearZero);
  }
  if (beyond(velocity) && config_.limit == Limit::Refuse)
  {
    const std::string least =
        config_.min_velocity > 0.0 ? util::numberText(config_.min_velocity, 9) + " to " : "up to ";
    return refused("velocity " + util::numberText(velocity, 9) + " is out of range: 0, or " + least +
                   util::numberText(config_.max_velocity, 9) + " in either direction");
  }
  RangedVelocity ranged = ofKind(RangedVelocity::Kind::Motion);
  // The one that is clamped most gets its maximum, not what is left of it after two roundings.
  const bool most = beyond(velocity) && factorFor(velocity) <= factor;
  const double reduced = most ? config_.max_velocity : std::fabs(velocity) * factor;
  ranged.velocity = std::copysign(std::min(reduced, config_.max_velocity), velocity);
  if (nearZero(ranged.velocity))
  {
    return refused("velocity " + util::numberText(velocity, 9) + " comes near zero when all are reduced to " +
                   util::numberText(factor * 100.0, 9) + " % for the one that is clamped most");
  }
  return ranged;
}
}  // namespace bus
}  // namespace inverter_bus

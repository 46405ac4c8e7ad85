// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/limits.h"

#include <algorithm>
#include <cmath>

namespace inverter_bus
{
namespace fuzz
{
namespace
{
constexpr double LIMIT_ROUNDING = 1e-6;  // contract, 8.5: of a publisher that computes in 32 bits
}  // namespace

bool isNearZero(const InverterFacts& facts, double velocity)
{
  const double step = facts.brand == Brand::JE ? 0.1 : 0.01;
  const double hertz = std::fabs(velocity * facts.hz_per_unit);
  return velocity != 0.0 && (hertz < 0.5 * step || std::fabs(velocity) < facts.min_velocity * (1.0 - LIMIT_ROUNDING));
}

bool isBeyond(const InverterFacts& facts, double velocity)
{
  if (facts.max_velocity > 0.0)
  {
    return std::fabs(velocity) > facts.max_velocity * (1.0 + LIMIT_ROUNDING);
  }
  // No profile goes so far, and no story sends anything between.
  return std::fabs(velocity) > 1000.0 && std::fabs(velocity) > std::fabs(60.0 / facts.hz_per_unit);
}

bool moves(const InverterFacts& facts, double velocity)
{
  return velocity != 0.0 && std::isfinite(velocity) && !isNearZero(facts, velocity);
}

double groupFactor(const Scene& scene, const bus::VelocityCommand& command)
{
  double factor = 1.0;
  for (const auto& target : command.targets)
  {
    const InverterFacts& facts = scene.inverters[target.first];
    if (facts.saturates && std::isfinite(target.second) && isBeyond(facts, target.second))
    {
      factor = std::min(factor, facts.max_velocity / std::fabs(target.second));
    }
  }
  return factor;
}
}  // namespace fuzz
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/stage.h"

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
Stage::Stage(World& world, std::uint64_t seed)
  : world(world), dice(seed * 2654435761U + 12345U), limits_dice(seed * 40503U + 99991U)
{
}

std::size_t Stage::anyone()
{
  return dice.below(inverters());
}

const InverterFacts& Stage::facts(std::size_t index) const
{
  return world.scene().inverters[index];
}

const std::string& Stage::nameOf(std::size_t index) const
{
  return facts(index).name;
}

std::size_t Stage::inverters() const
{
  return world.scene().inverters.size();
}

bool Stage::allOf(const std::function<bool(std::size_t)>& condition) const
{
  for (std::size_t index = 0; index < inverters(); ++index)
  {
    if (!condition(index))
    {
      return false;
    }
  }
  return true;
}

void Stage::require(Duration limit, const std::string& rule, const std::function<bool()>& condition)
{
  if (!world.runUntil(limit, condition))
  {
    fail(world.now(), "liveness", rule + " within " + std::to_string(toSeconds(limit)) + " s\n" + world.state());
  }
}
}  // namespace fuzz
}  // namespace inverter_bus

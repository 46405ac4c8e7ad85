// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_STAGE_H
#define INVERTER_BUS_FUZZ_STAGE_H

#include <cstdint>
#include <functional>
#include <string>

#include "fuzz/bus/dice.h"
#include "fuzz/bus/world.h"

namespace inverter_bus
{
namespace fuzz
{
/// What all who act on one bus share. They throw the same dice one after the other, so that a seed is a story.
struct Stage
{
  Stage(World& world, std::uint64_t seed);

  World& world;
  Dice dice;
  /// For what goes beyond limits and near zero: the rest of a story does not depend on it.
  Dice limits_dice;
  bool acting = false;     ///< chance goes on
  bool streaming = false;  ///< streams of velocities go on

  std::size_t anyone();
  const InverterFacts& facts(std::size_t index) const;
  const std::string& nameOf(std::size_t index) const;
  std::size_t inverters() const;
  bool allOf(const std::function<bool(std::size_t)>& condition) const;
  /// The bus runs until \p condition; \p rule is what is broken if it does not come true within \p limit.
  void require(Duration limit, const std::string& rule, const std::function<bool()>& condition);
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_STAGE_H

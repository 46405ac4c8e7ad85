// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_DICE_H
#define INVERTER_BUS_FUZZ_DICE_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "inverter_bus/simulation/random.h"

namespace inverter_bus
{
namespace fuzz
{
/// Chance that is the same for the same seed on every compiler and library.
class Dice
{
public:
  explicit Dice(std::uint64_t seed) : random_(seed)
  {
  }

  /// 0 ... 1, without 1.
  double chance()
  {
    return static_cast<double>(random_.next() >> 11U) / 9007199254740992.0;
  }

  double between(double least, double most)
  {
    return least + (most - least) * chance();
  }

  bool hits(double probability)
  {
    return chance() < probability;
  }

  /// 0 ... count - 1.
  std::size_t below(std::size_t count)
  {
    return static_cast<std::size_t>(random_.below(count));
  }

  template <typename T>
  const T& any(const std::vector<T>& values)
  {
    return values[below(values.size())];
  }

private:
  simulation::Random random_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_DICE_H

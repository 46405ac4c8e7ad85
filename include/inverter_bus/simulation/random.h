// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_RANDOM_H
#define INVERTER_BUS_SIMULATION_RANDOM_H

#include <cstdint>

namespace inverter_bus
{
namespace simulation
{
/// Random numbers that are the same for the same seed on every compiler and library (SplitMix64).
class Random
{
public:
  explicit Random(std::uint64_t seed) : state_(seed)
  {
  }

  std::uint64_t next()
  {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t value = state_;
    value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    value = (value ^ (value >> 27U)) * 0x94D049BB133111EBULL;
    return value ^ (value >> 31U);
  }

  /// 0 to \p limit - 1; \p limit must not be 0.
  std::uint64_t below(std::uint64_t limit)
  {
    return next() % limit;
  }

  std::uint8_t byte()
  {
    return static_cast<std::uint8_t>(next() & 0xFFU);
  }

  /// 1 to 127: what damages a byte for certain when XORed onto it, on a line with 7 data bits too.
  std::uint8_t damage()
  {
    return static_cast<std::uint8_t>(1U + below(127U));
  }

private:
  std::uint64_t state_;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_RANDOM_H

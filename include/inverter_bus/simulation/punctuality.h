// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_PUNCTUALITY_H
#define INVERTER_BUS_SIMULATION_PUNCTUALITY_H

#include <algorithm>
#include <cstdint>

#include "inverter_bus/simulation/time.h"

namespace inverter_bus
{
namespace simulation
{
/// How well a simulated wire keeps its time: the instants that it planned (the end of a byte, the beginning of a reply)
/// against those at which the host let it act. Not for several threads at once.
class Punctuality
{
public:
  /// An instant that was \p kept before it was \p planned counts as kept exactly.
  void add(TimePoint planned, TimePoint kept)
  {
    const Duration late = std::max(Duration::zero(), kept - planned);
    sum_ += late;
    latest_ = std::max(latest_, late);
    ++count_;
  }

  std::uint64_t count() const
  {
    return count_;
  }

  /// [s]; 0 when nothing was planned yet.
  double mean() const
  {
    return count_ == 0 ? 0.0 : toSeconds(sum_) / static_cast<double>(count_);
  }

  /// [s]
  double latest() const
  {
    return toSeconds(latest_);
  }

private:
  std::uint64_t count_ = 0;
  Duration sum_ = Duration::zero();
  Duration latest_ = Duration::zero();
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_PUNCTUALITY_H

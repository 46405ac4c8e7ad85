// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_LOAD_METER_H
#define INVERTER_BUS_BUS_LOAD_METER_H

#include <cstdint>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace bus
{
/// How much of the line's time is used, and how near a status cycle comes to the computed limit.
class LoadMeter
{
public:
  /// An exchange took the line from \p start to \p end; \p refresh_cost is what the wire alone needs for it if it was
  /// part of a status cycle, else 0.
  void exchange(TimePoint start, TimePoint end, Duration refresh_cost);
  /// A status cycle of \p duration is complete.
  void cycle(Duration duration);

  /// Share of the last full second in which the line was in use (0..1).
  double utilization(TimePoint now) const;
  /// Computed cost of the last cycle's exchanges / its real time (0..1).
  double efficiency() const;

private:
  TimePoint window_start_;
  Duration used_{ 0 };
  double last_share_ = 0.0;
  bool started_ = false;
  Duration cycle_cost_{ 0 };
  double efficiency_ = 0.0;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_LOAD_METER_H

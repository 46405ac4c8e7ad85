// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_UTIL_CLOCK_H
#define INVERTER_BUS_UTIL_CLOCK_H

#include <chrono>

namespace inverter_bus
{
/// Time everywhere in the core: steady, never the wall clock, so that a clock step can neither stretch nor cut a
/// time-out.
using TimePoint = std::chrono::steady_clock::time_point;
using Duration = std::chrono::nanoseconds;

/// Seconds (as users write them) to a Duration. \p seconds must be finite and within about +-292 years.
inline Duration seconds(double seconds)
{
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(seconds));
}

/// A Duration in seconds.
inline double toSeconds(Duration duration)
{
  return std::chrono::duration<double>(duration).count();
}

namespace util
{
/// Where the bus gets its time from: the steady clock in the node, a virtual one in tests and in the fuzzer.
class Clock
{
public:
  virtual ~Clock() = default;
  /// Any thread.
  virtual TimePoint now() const = 0;
  /// Blocks (or moves virtual time) until \p time; returns at once if it has passed. Bus thread only.
  virtual void sleepUntil(TimePoint time) = 0;
};

/// std::chrono::steady_clock.
class SteadyClock : public Clock
{
public:
  TimePoint now() const override;
  void sleepUntil(TimePoint time) override;
};
}  // namespace util
}  // namespace inverter_bus

#endif  // INVERTER_BUS_UTIL_CLOCK_H

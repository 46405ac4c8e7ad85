// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_COMM_WATCHDOG_H
#define INVERTER_BUS_SIMULATION_COMM_WATCHDOG_H

#include <optional>

#include "inverter_bus/simulation/time.h"

namespace inverter_bus
{
namespace simulation
{
/// A drive's own supervision of the communication. It starts with the first good request after power-on or reset
/// (SJ700b p. 187), so a master that never speaks causes nothing; every further good request restarts it.
class CommWatchdog
{
public:
  void reset()
  {
    heard_.reset();
    expired_ = false;
  }

  void feed(TimePoint now)
  {
    heard_ = now;
    expired_ = false;
  }

  /// When it expires; nothing where it is off (\p timeout 0), has not started or has expired.
  std::optional<TimePoint> deadline(Duration timeout) const
  {
    if (timeout == Duration::zero() || !heard_ || expired_)
    {
      return std::nullopt;
    }
    return *heard_ + timeout;
  }

  /// Expires when its \p timeout is over at \p now. True: just now, for the first time.
  bool expireAt(TimePoint now, Duration timeout)
  {
    const std::optional<TimePoint> due = deadline(timeout);
    expired_ = expired_ || (due && *due <= now);
    return due && *due <= now;
  }

  bool started() const
  {
    return heard_.has_value();
  }

  bool expired() const
  {
    return expired_;
  }

  /// In the words of `NAME show`.
  const char* text(Duration timeout) const
  {
    return timeout == Duration::zero() ? "off" : (expired_ ? "expired" : (heard_ ? "running" : "waiting"));
  }

private:
  std::optional<TimePoint> heard_;
  bool expired_ = false;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_COMM_WATCHDOG_H

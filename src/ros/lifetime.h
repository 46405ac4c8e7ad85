// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_LIFETIME_H
#define INVERTER_BUS_ROS_LIFETIME_H

#include <atomic>
#include <string>
#include <thread>

#include "ros/signals.h"
#include "util/steady_event.h"

namespace inverter_bus
{
namespace ros_node
{
/// Knows when the node must end (a signal, `rosnode kill`, or ROS going down by itself) and makes sure that it does, even
/// if roscpp hangs on a master that is gone. Make it first in main(), before any thread.
class Lifetime
{
public:
  Lifetime();

  Lifetime(const Lifetime&) = delete;
  Lifetime& operator=(const Lifetime&) = delete;

  /// Takes over `rosnode kill`, which roscpp would answer by closing all topics and services before the motors are stopped.
  /// Call after ROS was started.
  void takeOverKill();

  /// From now on there are motors to stop: the end is left to the caller of end().
  void busIsRunning();

  /// Set when the node shall end.
  const util::SteadyEvent& end() const;
  /// Waits at most \p timeout; true when the node shall end.
  bool waitForEnd(Duration timeout) const;

  /// The motors have been dealt with: the process ends with \p status, whatever happens until then.
  void finishSoon(int status);
  /// The rest of the way is over.
  ~Lifetime();

private:
  void onSignal(const std::string& name);

  util::SteadyEvent end_;
  util::SteadyEvent running_;
  util::SteadyEvent finished_;
  std::thread guard_;
  Signals signals_;
};
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_LIFETIME_H

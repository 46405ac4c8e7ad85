// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_STEADY_EVENT_H
#define INVERTER_BUS_ROS_STEADY_EVENT_H

#include <pthread.h>

#include "inverter_bus/wire/clock.h"

namespace inverter_bus
{
namespace ros_node
{
/// Something that happens once, and can be waited for on the steady clock. std::condition_variable of GCC 9 waits on the
/// wall clock, whatever clock it is given: a step of the wall clock would stretch every time-out.
class SteadyEvent
{
public:
  SteadyEvent();
  ~SteadyEvent();

  SteadyEvent(const SteadyEvent&) = delete;
  SteadyEvent& operator=(const SteadyEvent&) = delete;

  /// Any thread, any number of times.
  void set();
  bool isSet() const;
  /// Returns at once when it has happened; false if it has not after \p timeout.
  bool waitFor(Duration timeout) const;

private:
  mutable pthread_mutex_t mutex_;
  mutable pthread_cond_t condition_;
  bool set_ = false;
};
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_STEADY_EVENT_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_LOG_THROTTLE_H
#define INVERTER_BUS_ROS_LOG_THROTTLE_H

#include <cstddef>
#include <map>
#include <string>

#include "inverter_bus/wire/clock.h"

namespace inverter_bus
{
namespace ros_node
{
/// Keeps a fault that repeats itself from flooding the log: the same text at most once per 5 s, and at most 50 lines of any
/// text in 5 s. One thread only.
class LogThrottle
{
public:
  /// True if \p text may be logged at \p now. Times must not go back.
  bool admit(const std::string& text, TimePoint now);
  /// Lines that were kept back since the last call.
  std::size_t takeSuppressed();

private:
  void forgetBefore(TimePoint time);

  std::map<std::string, TimePoint> logged_;
  std::size_t suppressed_ = 0;
};
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_LOG_THROTTLE_H

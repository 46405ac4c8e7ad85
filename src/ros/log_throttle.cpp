// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/ros/log_throttle.h"

#include <chrono>
#include <iterator>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
constexpr Duration PERIOD = std::chrono::seconds(5);
constexpr std::size_t MOST_LINES = 50;
}  // namespace

bool LogThrottle::admit(const std::string& text, TimePoint now)
{
  forgetBefore(now - PERIOD);
  if (logged_.size() >= MOST_LINES || !logged_.emplace(text, now).second)
  {
    ++suppressed_;
    return false;
  }
  return true;
}

std::size_t LogThrottle::takeSuppressed()
{
  const std::size_t suppressed = suppressed_;
  suppressed_ = 0;
  return suppressed;
}

void LogThrottle::forgetBefore(TimePoint time)
{
  for (auto line = logged_.begin(); line != logged_.end();)
  {
    line = line->second <= time ? logged_.erase(line) : std::next(line);
  }
}
}  // namespace ros_node
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_LOG_THROTTLE_H
#define INVERTER_BUS_ROS_LOG_THROTTLE_H

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/bus/types.h"
#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace ros_node
{
/// Keeps a fault that repeats itself from flooding the log: at most 50 lines in 5 s, the same text at most once in 5 s. Of
/// one subject (bus::Finding) at most 4 lines in 5 s; its newest one is kept back for as long as that takes and then
/// logged if the log ends with another state, so that the last word is right. One thread only; times must not go back.
class LogThrottle
{
public:
  /// True if \p finding may be logged at \p now.
  bool admit(const bus::Finding& finding, TimePoint now);
  /// When takeDue() has something to give.
  std::optional<TimePoint> nextDue() const;
  /// Lines that were kept back and may be logged at \p now.
  std::vector<bus::Finding> takeDue(TimePoint now);
  /// All of them, for the end.
  std::vector<bus::Finding> takeHeld();
  /// Lines that were left out since the last call.
  std::size_t takeSuppressed();

private:
  struct Line
  {
    std::string text;
    std::string subject;
    TimePoint time;
  };

  void forgetBefore(TimePoint time);
  bool wasLogged(const std::string& text) const;
  bool isNews(const bus::Finding& finding) const;
  TimePoint roomFor(const std::string& subject) const;
  void note(const bus::Finding& finding, TimePoint now);
  void drop(const std::string& subject);

  /// Of the last 5 s.
  std::deque<Line> logged_;
  /// By subject: the text that the log ends with, however long ago.
  std::map<std::string, std::string> last_;
  /// By subject: the newest line, for which there was no room.
  std::map<std::string, bus::Finding> held_;
  std::size_t suppressed_ = 0;
};
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_LOG_THROTTLE_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_FLIGHT_RECORDER_H
#define INVERTER_BUS_BUS_FLIGHT_RECORDER_H

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// The last 1,000 frames of the line (contract, section 4.11). Any thread.
class FlightRecorder
{
public:
  explicit FlightRecorder(std::size_t capacity = 1000);

  void add(const wire::FrameEvent& event);
  /// What is recorded, oldest first.
  TraceDump dump(const std::string& reason, TimePoint now) const;
  /// The same for an automatic dump, at most once per 10 s.
  std::optional<TraceDump> automaticDump(const std::string& reason, TimePoint now);

private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::vector<wire::FrameEvent> ring_;
  std::size_t next_ = 0;
  std::optional<TimePoint> last_automatic_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_FLIGHT_RECORDER_H

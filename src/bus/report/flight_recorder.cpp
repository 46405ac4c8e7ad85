// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/report/flight_recorder.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// Here alone: whoever writes the files takes what comes.
constexpr double AUTOMATIC_DUMP_SPACING_S = 10.0;
}  // namespace

FlightRecorder::FlightRecorder(std::size_t capacity) : capacity_(capacity)
{
  ring_.reserve(capacity);
}

void FlightRecorder::add(const wire::FrameEvent& event)
{
  const std::lock_guard<std::mutex> guard(mutex_);
  if (ring_.size() < capacity_)
  {
    ring_.push_back(event);
    return;
  }
  // Moved in: a plain assignment would keep the memory of the longest frame that was ever in this place.
  ring_[next_] = wire::FrameEvent(event);
  next_ = (next_ + 1) % capacity_;
}

TraceDump FlightRecorder::dump(const std::string& reason, TimePoint now) const
{
  TraceDump dump;
  dump.reason = reason;
  dump.time = now;
  const std::lock_guard<std::mutex> guard(mutex_);
  dump.frames.reserve(ring_.size());
  for (std::size_t count = 0; count < ring_.size(); ++count)
  {
    dump.frames.push_back(ring_[(next_ + count) % ring_.size()]);
  }
  return dump;
}

std::optional<TraceDump> FlightRecorder::automaticDump(const std::string& reason, TimePoint now)
{
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    if (last_automatic_ && now - *last_automatic_ < seconds(AUTOMATIC_DUMP_SPACING_S))
    {
      return std::nullopt;
    }
    last_automatic_ = now;
  }
  return dump(reason, now);
}
}  // namespace bus
}  // namespace inverter_bus

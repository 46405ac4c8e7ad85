// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/report/flight_recorder.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
// Only here: the writer of the files takes what it is given.
constexpr double AUTOMATIC_DUMP_SPACING_S = 10.0;
}  // namespace

constexpr std::size_t FlightRecorder::FRAMES;
constexpr std::size_t FlightRecorder::EVENTS;
constexpr std::size_t FlightRecorder::BYTES_PER_FRAME;

FlightRecorder::FlightRecorder(std::size_t frames, std::size_t events)
  : most_frames_(frames), most_events_(events), frames_(frames), bytes_(frames * BYTES_PER_FRAME)
{
  events_.reserve(events);
}

void FlightRecorder::add(const wire::FrameEvent& frame)
{
  const std::lock_guard<std::mutex> guard(mutex_);
  const std::size_t size = std::min(frame.bytes.size(), bytes_.size());
  for (std::size_t i = 0; i < size; ++i)
  {
    bytes_[(bytes_ever_ + i) % bytes_.size()] = frame.bytes[i];
  }
  const std::uint64_t first = bytes_ever_;
  bytes_ever_ += size;
  const auto is_lost = [this](const TraceFrame& one) { return one.first + bytes_.size() < bytes_ever_; };
  while (frame_count_ > 0 && (frame_count_ == most_frames_ || is_lost(frames_[oldest_frame_])))
  {
    oldest_frame_ = (oldest_frame_ + 1) % most_frames_;
    --frame_count_;
  }
  frames_[(oldest_frame_ + frame_count_) % most_frames_] = { frame.kind, frame.time, first, size };
  ++frame_count_;
}

void FlightRecorder::add(const TraceEvent& event)
{
  const std::lock_guard<std::mutex> guard(mutex_);
  if (events_.size() < most_events_)
  {
    events_.push_back(event);
    return;
  }
  events_[next_event_] = event;
  next_event_ = (next_event_ + 1) % most_events_;
}

TraceDump FlightRecorder::dump(const std::string& reason, TimePoint now) const
{
  TraceDump dump;
  dump.reason = reason;
  dump.time = now;
  const std::lock_guard<std::mutex> guard(mutex_);
  const std::uint64_t start = frame_count_ == 0 ? bytes_ever_ : frames_[oldest_frame_].first;
  dump.frames.reserve(frame_count_);
  for (std::size_t count = 0; count < frame_count_; ++count)
  {
    dump.frames.push_back(frames_[(oldest_frame_ + count) % most_frames_]);
    dump.frames.back().first -= start;
  }
  dump.bytes.reserve(static_cast<std::size_t>(bytes_ever_ - start));
  for (std::uint64_t place = start; place < bytes_ever_; ++place)
  {
    dump.bytes.push_back(bytes_[place % bytes_.size()]);
  }
  dump.events.reserve(events_.size());
  for (std::size_t count = 0; count < events_.size(); ++count)
  {
    dump.events.push_back(events_[(next_event_ + count) % events_.size()]);
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

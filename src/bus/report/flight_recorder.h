// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_FLIGHT_RECORDER_H
#define INVERTER_BUS_BUS_FLIGHT_RECORDER_H

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// The last 8,192 frames of the line and the last 2,048 events (contract, section 4.11). All its memory (0.7 MB) is taken when
/// it is made; recording takes none. Any thread.
class FlightRecorder
{
public:
  static constexpr std::size_t FRAMES = 8192;
  static constexpr std::size_t EVENTS = 2048;
  /// Bytes of the line that are kept for each frame on average: a request and a reply of 16 registers have 45 together. When
  /// longer ones come in a row, fewer frames are kept.
  static constexpr std::size_t BYTES_PER_FRAME = 40;

  explicit FlightRecorder(std::size_t frames = FRAMES, std::size_t events = EVENTS);

  /// Keeps at most frames x BYTES_PER_FRAME bytes of one frame.
  void add(const wire::FrameEvent& frame);
  void add(const TraceEvent& event);
  /// What is recorded, frames and events oldest first.
  TraceDump dump(const std::string& reason, TimePoint now) const;
  /// The same for an automatic dump, at most once per 10 s.
  std::optional<TraceDump> automaticDump(const std::string& reason, TimePoint now);

private:
  const std::size_t most_frames_;
  const std::size_t most_events_;
  mutable std::mutex mutex_;
  /// Rings: the newest overwrites the oldest. A frame's place is counted from the first byte ever.
  std::vector<TraceFrame> frames_;
  std::size_t oldest_frame_ = 0;
  std::size_t frame_count_ = 0;
  std::vector<std::uint8_t> bytes_;
  std::uint64_t bytes_ever_ = 0;
  std::vector<TraceEvent> events_;
  std::size_t next_event_ = 0;
  std::optional<TimePoint> last_automatic_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_FLIGHT_RECORDER_H

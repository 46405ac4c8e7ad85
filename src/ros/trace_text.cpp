// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/trace_text.h"

#include <cstdio>
#include <ctime>
#include <optional>

#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace ros_node
{
namespace
{
using WallTime = std::chrono::system_clock::time_point;

std::string formatUtc(WallTime time, const char* format)
{
  using std::chrono::duration_cast;
  const auto since_epoch = duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count();
  const std::time_t whole = static_cast<std::time_t>(since_epoch / 1000000);
  std::tm utc{};
  gmtime_r(&whole, &utc);
  char seconds_text[32];
  std::strftime(seconds_text, sizeof seconds_text, format, &utc);
  char text[48];
  std::snprintf(text, sizeof text, "%s.%06d", seconds_text, static_cast<int>(since_epoch % 1000000));
  return text;
}

const char* kindText(wire::FrameEvent::Kind kind)
{
  switch (kind)
  {
    case wire::FrameEvent::Kind::Request:
      return "request  ";
    case wire::FrameEvent::Kind::Reply:
      return "reply    ";
    case wire::FrameEvent::Kind::Exception:
      return "exception";
    case wire::FrameEvent::Kind::Damaged:
      return "damaged  ";
    case wire::FrameEvent::Kind::Late:
      return "late     ";
    case wire::FrameEvent::Kind::Foreign:
      return "foreign  ";
  }
  return "?        ";
}

/// What every line begins with.
std::string stampText(Duration gap, WallTime wall)
{
  const auto since_last = std::chrono::duration_cast<std::chrono::microseconds>(gap).count();
  char gap_text[24];
  std::snprintf(gap_text, sizeof gap_text, "%+10lld", static_cast<long long>(since_last));
  return formatUtc(wall, "%H:%M:%S") + ' ' + gap_text + "  ";
}

void writeFrame(const bus::TraceDump& dump, const bus::TraceFrame& frame, std::ostream& out)
{
  out << kindText(frame.kind);
  for (std::size_t place = 0; place < frame.size; ++place)
  {
    out << ' ' << util::hexText(dump.bytes[static_cast<std::size_t>(frame.first) + place], 2);
  }
  out << '\n';
}

void writeEvent(const bus::TraceEvent& event, std::ostream& out)
{
  out << "event     " << util::printable(event.text.data(), event.text.size()) << '\n';
}
}  // namespace

std::string fileStamp(WallTime time)
{
  return formatUtc(time, "%Y%m%dT%H%M%S") + "Z";
}

void writeTrace(const bus::TraceDump& dump, TimePoint steady, WallTime wall, std::ostream& out)
{
  const auto to_wall = [steady, wall](TimePoint time) {
    return wall + std::chrono::duration_cast<WallTime::duration>(time - steady);
  };
  out << "# inverter_bus flight recorder: " << dump.reason << '\n';
  out << "# at " << formatUtc(to_wall(dump.time), "%Y-%m-%dT%H:%M:%S") << "Z, " << dump.frames.size() << " frames, "
      << dump.events.size() << " events\n";
  out << "# UTC            since last [us]  frame or event\n";
  std::optional<TimePoint> previous;
  auto frame = dump.frames.begin();
  auto event = dump.events.begin();
  while (frame != dump.frames.end() || event != dump.events.end())
  {
    // What happened at the same moment as a frame led to it.
    const bool event_next = event != dump.events.end() && (frame == dump.frames.end() || event->time <= frame->time);
    const TimePoint time = event_next ? event->time : frame->time;
    out << stampText(time - previous.value_or(time), to_wall(time));
    previous = time;
    event_next ? writeEvent(*event++, out) : writeFrame(dump, *frame++, out);
  }
}
}  // namespace ros_node
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/trace_text.h"

#include <cstdio>
#include <ctime>

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

void writeFrame(const wire::FrameEvent& frame, TimePoint previous, WallTime wall, std::ostream& out)
{
  const auto gap = std::chrono::duration_cast<std::chrono::microseconds>(frame.time - previous).count();
  char gap_text[24];
  std::snprintf(gap_text, sizeof gap_text, "%+10lld", static_cast<long long>(gap));
  out << formatUtc(wall, "%H:%M:%S") << ' ' << gap_text << "  " << kindText(frame.kind);
  for (const std::uint8_t byte : frame.bytes)
  {
    out << ' ' << util::hexText(byte, 2);
  }
  out << '\n';
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
  out << "# at " << formatUtc(to_wall(dump.time), "%Y-%m-%dT%H:%M:%S") << "Z, " << dump.frames.size() << " frames\n";
  out << "# UTC            since last [us]  frame\n";
  TimePoint previous = dump.frames.empty() ? steady : dump.frames.front().time;
  for (const wire::FrameEvent& frame : dump.frames)
  {
    writeFrame(frame, previous, to_wall(frame.time), out);
    previous = frame.time;
  }
}
}  // namespace ros_node
}  // namespace inverter_bus

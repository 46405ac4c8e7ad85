// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_TYPES_H
#define INVERTER_BUS_BUS_TYPES_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/drive/drive.h"
#include "inverter_bus/wire/line.h"

namespace inverter_bus
{
namespace bus
{
// Error ids of the node itself (contract, section 2); 0x0205-0x0207 are in wire/request.h.
constexpr std::uint16_t ERROR_NONE = 0x0000;
constexpr std::uint16_t ERROR_OUT_OF_RANGE = 0xA000;
constexpr std::uint16_t ERROR_OFFLINE = 0xB001;
constexpr std::uint16_t ERROR_CANCELLED = 0xB002;
constexpr std::uint16_t ERROR_SHUTTING_DOWN = 0xB003;
constexpr std::uint16_t ERROR_NOT_OFFERED = 0xB004;
constexpr std::uint16_t ERROR_LOCKED = 0xB005;
constexpr std::uint16_t ERROR_NOT_ARMED = 0xB006;

/// One sentence for an error id that needs no drive to explain it.
std::string errorText(std::uint16_t error_id, std::uint8_t gateway_code = 0);

/// What 0xB005 says: what opens the lock, also after a trip of the drive that has not been reset yet.
std::string lockedText(bool tripped);

/// An error id as the documents write it: "0x0205".
std::string errorIdText(std::uint16_t error_id);

/// The drive has no such request: Modbus exceptions 01 to 03 (function, address, count) concern the request itself, later
/// ones the moment (busy, locked, running). CompoWay/F has response codes for both.
bool isLastingRefusal(const wire::Reply& reply);

/// The drive has answered, even if with a refusal.
bool isAnswered(const wire::Reply& reply);

enum class StopMode : std::uint8_t
{
  Decelerate = 0,
  Coast = 1,
  Quick = 2
};

/// Answer of every service.
struct Answer
{
  bool success = false;
  std::uint16_t error_id = ERROR_NONE;
  std::string message;
  // read_parameter
  double value = 0.0;
  std::string unit;
  // read_faults
  drive::FaultRecord present;
  std::vector<drive::FaultRecord> faults;
};

/// The longest that a service waits for its answer [s]; README states them.
struct ServiceBounds
{
  double stop = 2.0;
  double reset = 8.0;
  double read_faults = 5.0;
  double read_parameter = 2.0;
  double write_parameter = 10.0;
};

/// Called once, in the bus thread or in the caller's; must not block.
using AnswerCallback = std::function<void(const Answer&)>;

/// The publisher of a velocity, and its connection.
struct Publisher
{
  /// ROS name of the publishing node: what counts for neutral and lock.
  std::string name;
  /// The topic it came over: a latched message is a repeat only where this publisher was heard before.
  std::string topic;
  /// The publisher latches: its first message on a connection may be old.
  bool latched = false;
  /// First message on this connection.
  bool first_on_connection = false;
  /// The publisher was there before this node subscribed.
  bool before_start = false;
};

/// Velocities in the user's unit for inverters by index (order of the scan list by node).
struct VelocityCommand
{
  std::vector<std::pair<std::size_t, double>> targets;
  Publisher publisher;
  /// Came over the grouped topic: a refusal shows in the bus status too.
  bool grouped = false;
};

/// What InverterStatus.msg carries. An empty field of \ref monitor is NaN or unknown there.
struct InverterStatus
{
  std::size_t index = 0;
  /// As the drive names itself; empty: it doesn't.
  std::string model;
  /// Arrival of the reply; not valid before the first reply.
  TimePoint stamp;
  bool has_stamp = false;
  /// Fields older than they may be are already taken out; empty while offline.
  drive::Monitor monitor;
  /// Age of the oldest slow value; empty: none was read since the drive was found.
  std::optional<Duration> slow_age;
  bool run_command = false;
  bool communication_error = false;
  /// Offline, but the communication works: the drive has answered lately, and refuses its status for the moment.
  bool refuses = false;
  bool move_velocity_active = false;
  bool reset_active = false;
  bool stop_active = false;
  bool locked = true;
  std::uint16_t error_id = 0;
  std::string error_text;
  double commanded_velocity = 0.0;  ///< user's unit; 0 when no command is in force
};

struct BusStatus
{
  bool connected = false;
  bool busy = false;
  std::uint8_t node = 0;
  bool error = false;
  std::uint16_t error_id = 0;
  wire::LineCounters counters;
  std::uint64_t reconnects = 0;
  double cycle_time = 0.0;        ///< [s] of the last complete cycle
  double utilization = 0.0;       ///< 0..1 of the line's time over the last second
  double efficiency = 0.0;        ///< computed cost of the cycle / its real time
  double stop_latency_max = 0.0;  ///< [s]
  std::vector<std::uint8_t> offline_nodes;
};

enum class Level
{
  Ok = 0,
  Warn = 1,
  Error = 2
};

/// One line of /diagnostics or of the log, saying what to do.
struct Finding
{
  Level level = Level::Ok;
  std::string text;
  /// Lines of the log that report the state of the same thing (the port, an inverter's link) have the same subject: a new
  /// one replaces the one before it. Empty: a line of its own.
  std::string subject = {};
};

/// What /diagnostics shows of an inverter.
struct InverterReport
{
  std::string name;
  std::uint8_t node = 0;
  InverterStatus status;
  std::vector<Finding> findings;
  /// Key and value pairs: settings as read, counters, ages.
  std::vector<std::pair<std::string, std::string>> values;
};

/// What /diagnostics shows of the bus and of everything on it.
struct Report
{
  BusStatus bus;
  std::vector<Finding> findings;
  std::vector<std::pair<std::string, std::string>> values;
  std::vector<InverterReport> inverters;
};

/// A frame of a TraceDump.
struct TraceFrame
{
  wire::FrameEvent::Kind kind = wire::FrameEvent::Kind::Request;
  TimePoint time;
  std::uint64_t first = 0;  ///< where its bytes begin among those of all frames
  std::size_t size = 0;     ///< [bytes]
};

/// What happened, beside the frames: a command came, a stop was accepted, a reply did not come.
struct TraceEvent
{
  TimePoint time;
  std::array<char, 120> text{};  ///< ends with 0; what is longer is cut off
};

/// The flight recorder's content, on its way to a file; oldest first.
struct TraceDump
{
  std::string reason;
  TimePoint time;
  std::vector<TraceFrame> frames;
  wire::Bytes bytes;
  std::vector<TraceEvent> events;
};

/// \p text as it fits into an event.
TraceEvent traceEvent(TimePoint time, const std::string& text);

/// Where the bus reports to. All calls come from the bus thread with no lock of the bus held, and must not block.
class Observer
{
public:
  virtual ~Observer() = default;
  /// After every refresh of an inverter, and at 1 Hz while it is offline.
  virtual void inverterStatus(const InverterStatus& status) = 0;
  /// After every cycle, at most 10 Hz, at least 1 Hz.
  virtual void busStatus(const BusStatus& status) = 0;
  virtual void log(const Finding& finding) = 0;
  /// On a trip, on an inverter going offline, on a stop that missed its bound: at most once per 10 s.
  virtual void trace(TraceDump dump) = 0;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_TYPES_H

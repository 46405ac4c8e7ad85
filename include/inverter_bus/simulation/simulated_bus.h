// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_SIMULATED_BUS_H
#define INVERTER_BUS_SIMULATION_SIMULATED_BUS_H

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/simulation/bus_config.h"
#include "inverter_bus/simulation/simulated_line.h"

namespace inverter_bus
{
namespace simulation
{
/// A whole bus: line, drives and what a user can do to them, in the time that is passed in. A virtual-time test writes
///
///     SimulatedBus bus(config, LineOptions(), start);
///     bus.send(request, now);
///     while (auto next = bus.nextEvent())
///     {
///       now = *next;
///       bus.advance(now);
///       for (const Delivery& delivery : bus.takeOutput(now)) ...
///     }
///     bus.command("belt_1 trip 12", now);
///
/// Not for several threads at once.
class SimulatedBus
{
public:
  /// The `settings` of \p options are taken from \p config. \throws ConfigError for what a drive refuses
  SimulatedBus(const BusConfig& config, LineOptions options, TimePoint start);

  // The master's end of the line.
  void send(const Bytes& bytes, TimePoint now);
  /// The master's port is set otherwise than the scan list says.
  void setMaster(const LineSettings& settings, TimePoint now);
  std::optional<TimePoint> nextEvent() const;
  void advance(TimePoint now);
  std::vector<Delivery> takeOutput(TimePoint now);
  /// False while the adapter is unplugged (`bus unplug`): the owner of a port closes it then.
  bool pluggedIn() const;

  /// Runs one command (grammar: bus_commands.h, and the command `help`). The answer is one line, "ok ..." or
  /// "error: ... (what is allowed)", and empty for an empty line.
  std::string command(const std::string& line, TimePoint now);

  SimulatedLine& line();
  /// Null where there is none of that name.
  SimulatedDrive* drive(const std::string& name);
  const std::vector<std::unique_ptr<SimulatedDrive>>& drives() const;
  TimePoint start() const;
  /// Every frame, once it is over.
  void setObserver(std::function<void(const FrameRecord&)> observer);
  /// The last frames, oldest first (at most 200).
  const std::deque<FrameRecord>& frames() const;

  /// Pulls the adapter out \p until it is plugged in again; nothing: until plugIn().
  void unplug(std::optional<TimePoint> until, TimePoint now);
  void plugIn(TimePoint now);
  /// \p until when the line is whole again; nothing: until cutLine(false, ...).
  void cutLine(bool cut, std::optional<TimePoint> until, TimePoint now);

private:
  void changeDue(TimePoint now);

  TimePoint start_;
  SimulatedLine line_;
  std::vector<std::unique_ptr<SimulatedDrive>> drives_;
  std::function<void(const FrameRecord&)> observer_;
  std::deque<FrameRecord> frames_;
  bool plugged_in_ = true;
  std::optional<TimePoint> plug_in_at_;
  std::optional<TimePoint> mend_at_;
};

/// One line of a trace: time since `start` in seconds, sender, station, bytes, remark.
std::string frameText(const FrameRecord& frame, TimePoint start);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_SIMULATED_BUS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_WORLD_H
#define INVERTER_BUS_FUZZ_WORLD_H

#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/bus_loop.h"
#include "bus/coordinator.h"
#include "bus_fuzz_checker.h"
#include "bus_fuzz_digest.h"
#include "support/virtual_world.h"

namespace inverter_bus
{
namespace fuzz
{
/// A port that tells the checker of every request before its first byte leaves.
class WatchedPort : public VirtualPort
{
public:
  WatchedPort(simulation::SimulatedBus& bus, AppointedClock& clock, Checker& checker)
    : VirtualPort(bus, clock), clock_(clock), checker_(checker)
  {
  }

  wire::OpenResult open(std::string& error) override;
  bool send(const wire::Bytes& frame) override;
  wire::ReceiveResult receive(wire::Bytes& buffer, TimePoint deadline) override;

private:
  AppointedClock& clock_;
  Checker& checker_;
};

/// One bus in virtual time: the driver's core on one side, simulated drives on the other, the checker between them.
class World
{
public:
  World(const Scene& scene, const bus::Configuration& configuration, std::uint64_t seed);

  TimePoint now() const;
  TimePoint start() const;
  void at(Duration from_now, std::function<void()> action);
  /// Runs until \p condition; false if it did not come true within \p limit.
  bool runUntil(Duration limit, const std::function<bool()>& condition);
  void run(Duration duration);
  /// Time passes without the driver.
  void pass(Duration duration);

  // --- users ----------------------------------------------------------------------------------------------------------
  std::uint16_t command(const bus::VelocityCommand& command);
  /// \p answered may be empty.
  void stop(std::optional<std::size_t> index, std::uint8_t mode, std::function<void(const bus::Answer&)> answered);
  void reset(std::size_t index, std::function<void(const bus::Answer&)> answered);
  void readFaults(std::size_t index);
  void readFixedParameter(std::size_t index);
  void readUnknownParameter(std::size_t index);
  void writeFreeParameter(std::size_t index, double value, bool persist);

  /// The program is ended: from now on motors are only stopped.
  void beginShutdown();
  bool shutdownDone();
  /// Judges what is left of it.
  void endShutdown(TimePoint begun);

  // --- the world ------------------------------------------------------------------------------------------------------
  /// A command of the simulated bus; where it can't happen now, nothing does.
  bool provoke(const std::string& command);
  void cutPower(std::size_t index, double duration);

  Checker& checker();
  const Scene& scene() const;
  /// The last frames, for a report.
  std::string lastFrames(std::size_t count) const;
  std::string state() const;
  /// What the story looked like up to now, /diagnostics of this moment included.
  std::string digest() const;

private:
  static simulation::LineOptions options(std::uint64_t seed);
  void deliver();
  void note(const std::string& text);
  double ram(std::size_t index, const std::string& parameter) const;

  const Scene& scene_;
  AppointedClock clock_;
  simulation::SimulatedBus simulated_;
  Checker checker_;
  Digest digest_;
  WatchedPort port_;
  std::unique_ptr<wire::Protocol> protocol_;
  wire::Line line_;
  std::mutex mutex_;
  bus::Coordinator coordinator_;
  bus::BusLoop loop_;
  bus::ServiceBounds bounds_;
  std::deque<simulation::FrameRecord> frames_;
  /// What users and the world did.
  std::deque<std::pair<TimePoint, std::string>> events_;
  /// Values that each free parameter was to be set to, and when.
  std::vector<std::vector<std::pair<TimePoint, double>>> writes_;
  std::vector<TimePoint> cuts_;  ///< of each drive's supply, the last one
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_WORLD_H

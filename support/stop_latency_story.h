// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_STOP_LATENCY_STORY_H
#define INVERTER_BUS_STOP_LATENCY_STORY_H

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus_loop.h"
#include "bus/coordinator.h"
#include "inverter_bus/simulation/random.h"
#include "support/virtual_world.h"

namespace inverter_bus
{
/// How long stops take to the wire at random instants on a busy bus with dead drives, in virtual time: velocities at 50 Hz on
/// each inverter, and a parameter read always waits. For a test and for the benchmark.
class StopLatencyStory
{
public:
  /// What those that are dead do. All of them were running.
  enum class Death
  {
    Silent,
    /// They answer when nobody waits any more.
    Late,
    /// Their replies end in the middle.
    Broken
  };
  struct Plan
  {
    unsigned inverters = 31;
    unsigned dead = 0;
    Death death = Death::Silent;
    unsigned stops = 1000;
    std::uint64_t seed = 1;
  };

  /// MX2 at 19200 8N1. \p profiles: directory of the drive profiles.
  StopLatencyStory(const Plan& plan, const std::string& profiles);
  ~StopLatencyStory();

  /// From the acceptance of each stop of a living inverter to the first byte of its frame, in the order of time. Fewer than
  /// planned: a stop did not come at all.
  std::vector<Duration> play();
  /// What the node says of it: acceptance to first byte, the worst.
  Duration worstTold();

private:
  class Port;
  struct Stream
  {
    double velocity = 0.0;
    /// A stop is under way, or has just ended: 0 is next.
    bool stopping = false;
    bool zero_due = false;
  };

  void run(Duration duration);
  bool runUntil(Duration limit, const std::function<bool()>& condition);
  void tickStreams();
  void askForParameter();
  void kill();
  bool stopOne();
  std::size_t anyOnline();
  unsigned living() const;
  double chance();

  const Plan plan_;
  bus::Configuration configuration_;
  AppointedClock clock_;
  std::unique_ptr<simulation::SimulatedBus> simulated_;
  std::unique_ptr<Port> port_;
  std::unique_ptr<wire::Protocol> protocol_;
  std::unique_ptr<wire::Line> line_;
  std::mutex mutex_;
  std::unique_ptr<bus::Coordinator> coordinator_;
  std::unique_ptr<bus::BusLoop> loop_;
  simulation::Random random_;
  std::vector<Stream> streams_;
  std::vector<Duration> latencies_;
};
}  // namespace inverter_bus

#endif  // INVERTER_BUS_STOP_LATENCY_STORY_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BENCHMARK_PLAIN_MASTER_H
#define INVERTER_BUS_BENCHMARK_PLAIN_MASTER_H

#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/scene.h"
#include "inverter_bus/simulation/simulated_bus.h"
#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace benchmark
{
/// What a loop around a Modbus library does, in virtual time and thus without any delay of a host: one request after the other in
/// the order in which they were asked for, a wait for the reply, a legal gap. Reads are put at the end of the queue again once
/// they were answered or given up, so that with nothing else to do it is the plain loop over all drives.
class PlainMaster
{
public:
  PlainMaster(const Scene& scene, double time_out);

  /// Done once, at the end of what waits; `sent` is told when its first byte leaves.
  void once(const simulation::Bytes& request, std::function<void(TimePoint)> sent = {});
  /// Done again and again.
  void always(const simulation::Bytes& request);
  /// A velocity of this station waits, at most one of each.
  void velocity(unsigned station);

  void at(TimePoint time, std::function<void()> action);
  void run(double duration);
  TimePoint now() const;
  void world(const std::string& command);

  std::vector<simulation::FrameRecord> frames;

private:
  struct Waiting
  {
    simulation::Bytes request;
    bool again = false;
    std::optional<unsigned> velocity_of;
    std::function<void(TimePoint)> sent;
  };

  void exchange(const Waiting& waiting);
  void pass(TimePoint time);

  simulation::SimulatedBus bus_;
  double gap_;
  double time_out_;
  TimePoint now_;
  std::deque<Waiting> queue_;
  std::deque<std::pair<TimePoint, std::function<void()>>> appointments_;  // in order of time
};

/// The two reads of an MX2, or the one of a VF-S15: what a refresh needs at least.
std::vector<simulation::Bytes> refreshOf(const Scene& scene, unsigned station);
/// RUN off, as the first frame of a stop.
simulation::Bytes stopOf(unsigned station);
}  // namespace benchmark
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BENCHMARK_PLAIN_MASTER_H

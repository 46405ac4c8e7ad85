// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_WORLD_H
#define INVERTER_BUS_FUZZ_WORLD_H

#include <cstdint>
#include <functional>
#include <string>

#include "fuzz/bus/calls.h"
#include "fuzz/bus/checker.h"
#include "fuzz/bus/digest.h"
#include "fuzz/bus/driver.h"
#include "fuzz/bus/story.h"
#include "support/virtual_world.h"

namespace inverter_bus
{
namespace fuzz
{
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

  // --- users ---------------------------------------------------------------------------------------------------------
  std::uint16_t command(const bus::VelocityCommand& command);
  Calls& calls();
  /// The program is ended: from now on motors are only stopped.
  void beginShutdown();
  bool shutdownDone();
  /// Judges what is left of it.
  void endShutdown(TimePoint begun);

  // --- the world -----------------------------------------------------------------------------------------------------
  /// A command of the simulated bus; where it can't happen now, nothing does.
  void provoke(const std::string& command);
  void cutPower(std::size_t index, double duration);
  /// The replies to its reads of slow values get lost from now on; nothing: no drive's do any more.
  void loseSlowReplies(std::optional<std::size_t> index);
  /// Noise, or frames of a second master.
  void disturb();

  const Scene& scene() const;
  const Checker& checker() const;
  /// What the node has published of an inverter.
  const Told& told(std::size_t index) const;
  /// The last frames, for a report.
  std::string lastFrames(std::size_t count) const;
  std::string state() const;
  /// What the story looked like up to now, /diagnostics of this moment included.
  std::string digest() const;

private:
  void deliver();

  const Scene& scene_;
  AppointedClock clock_;
  simulation::SimulatedBus simulated_;
  Checker checker_;
  Digest digest_;
  Story story_;
  Driver driver_;
  Calls calls_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_WORLD_H

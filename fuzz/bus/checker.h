// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKER_H
#define INVERTER_BUS_FUZZ_CHECKER_H

#include <cstdint>
#include <functional>

#include "fuzz/bus/checks.h"
#include "fuzz/bus/line_watch.h"
#include "fuzz/bus/status_watch.h"
#include "fuzz/bus/user_watch.h"

namespace inverter_bus
{
namespace fuzz
{
struct Statistics
{
  std::uint64_t exchanges = 0;
  std::uint64_t commands = 0;
  std::uint64_t accepted = 0;
  std::uint64_t runs = 0;   ///< RUN frames
  std::uint64_t stops = 0;  ///< stops whose latency was checked
  std::uint64_t services = 0;
  std::uint64_t statuses = 0;
  std::uint64_t values = 0;  ///< published values compared with the motor
  Duration worst_stop{ 0 };
};

/// Watches one bus from the outside and holds every rule against it: frames on the line, answers to calls, published
/// statuses, the simulated motors. It keeps its own model of what is allowed, and never asks the driver.
/// Every function may throw a Violation.
class Checker
{
public:
  /// \p budget_warns the node warns that it can't serve an inverter within its communication time-out.
  Checker(const Scene& scene, simulation::SimulatedBus& bus, const util::Clock& clock,
          std::function<bool(std::size_t)> budget_warns);

  /// Where it learns what happens.
  LineWatch& line();
  UserWatch& users();
  StatusWatch& statuses();
  checks::Services& services();
  /// Something is about to happen to a drive, or has happened.
  void glance(TimePoint now);
  /// Noise, or frames of a second master.
  void disturbed(TimePoint now);
  void lostPower(TimePoint now, std::size_t index);

  const Observed& observed() const;
  const Plant& plant() const;
  Statistics statistics() const;
  /// Calls without an answer.
  std::size_t openCalls() const;

private:
  Checks checks_;
  LineWatch line_;
  UserWatch users_;
  StatusWatch statuses_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKER_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_H
#define INVERTER_BUS_FUZZ_CHECKS_H

#include <functional>

#include "fuzz/bus/checks/bounded_velocities.h"
#include "fuzz/bus/checks/commands.h"
#include "fuzz/bus/checks/confirmed_stops.h"
#include "fuzz/bus/checks/cut_waits.h"
#include "fuzz/bus/checks/line.h"
#include "fuzz/bus/checks/liveness.h"
#include "fuzz/bus/checks/locks.h"
#include "fuzz/bus/checks/lowest_class.h"
#include "fuzz/bus/checks/probes.h"
#include "fuzz/bus/checks/refusals.h"
#include "fuzz/bus/checks/resets.h"
#include "fuzz/bus/checks/run_frames.h"
#include "fuzz/bus/checks/services.h"
#include "fuzz/bus/checks/set_points.h"
#include "fuzz/bus/checks/shutdown.h"
#include "fuzz/bus/checks/slow_reads.h"
#include "fuzz/bus/checks/stops.h"
#include "fuzz/bus/checks/supervision.h"
#include "fuzz/bus/checks/told_locks.h"
#include "fuzz/bus/checks/trips.h"
#include "fuzz/bus/checks/turns.h"
#include "fuzz/bus/checks/values.h"
#include "fuzz/bus/checks/watchdog.h"
#include "fuzz/bus/checks/zeros.h"
#include "fuzz/bus/plant.h"
#include "fuzz/bus/recorder.h"

namespace inverter_bus
{
namespace fuzz
{
/// What one bus is checked by: the real drives, the record of what was seen from outside, and a check for each
/// property. Checks read the record and know nothing of each other; the watches report to them what happens, in an order
/// that matters: a check that compares with what was before comes ahead of the record.
struct Checks
{
  /// \p budget_warns the node warns that it can't serve an inverter within its communication time-out.
  Checks(const Scene& scene, simulation::SimulatedBus& bus, const util::Clock& clock,
         std::function<bool(std::size_t)> budget_warns);

  /// All publishers must return to neutral before this inverter moves again; \p by_stop: and its stop must be confirmed.
  void lockUp(TimePoint now, std::size_t index, bool by_stop);
  /// Its order is void.
  void forbid(TimePoint now, std::size_t index);

  const util::Clock& clock;
  Plant plant;
  Recorder recorder;
  const Observed& observed;

  checks::Line line;
  checks::Stops stops;
  checks::CutWaits cut_waits;
  checks::ConfirmedStops confirmed_stops;
  checks::Watchdog watchdog;
  checks::Zeros zeros;
  checks::Commands commands;
  checks::Locks locks;
  checks::ToldLocks told_locks;
  checks::RunFrames run_frames;
  checks::SetPoints set_points;
  checks::Resets resets;
  checks::Turns turns;
  checks::BoundedVelocities bounded_velocities;
  checks::LowestClass lowest_class;
  checks::SlowReads slow_reads;
  checks::Liveness liveness;
  checks::Probes probes;
  checks::Supervision supervision;
  checks::Values values;
  checks::Trips trips;
  checks::Refusals refusals;
  checks::Services services;
  checks::Shutdown shutdown;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_H

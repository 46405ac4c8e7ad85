// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks.h"

#include <utility>

namespace inverter_bus
{
namespace fuzz
{
Checks::Checks(const Scene& scene, simulation::SimulatedBus& bus, const util::Clock& clock,
               std::function<bool(std::size_t)> budget_warns)
  : clock(clock)
  , plant(scene, bus)
  , recorder(scene, plant)
  , observed(recorder.observed())
  , line(observed)
  , stops(observed)
  , confirmed_stops(observed, plant)
  , watchdog(observed)
  , zeros(observed)
  , commands(observed)
  , locks(observed, bus.start())
  , told_locks(observed)
  , run_frames(observed, plant)
  , set_points(observed)
  , resets(observed, plant)
  , turns(observed)
  , bounded_velocities(observed)
  , lowest_class(observed)
  , slow_reads(observed)
  , liveness(observed)
  , probes(observed)
  , supervision(observed, std::move(budget_warns))
  , values(observed, plant)
  , trips(observed, plant)
  , refusals(observed)
  , services(observed, plant, clock)
  , shutdown(observed, plant)
{
}

void Checks::lockUp(TimePoint now, std::size_t index, bool by_stop)
{
  const bool stop_under_way = observed.inverters[index].stop.active && !stops.waits(index);
  forbid(now, index);
  locks.lock(now, index, by_stop, stop_under_way);
}

void Checks::forbid(TimePoint now, std::size_t index)
{
  recorder.forbidden(now, index);
  bounded_velocities.forbidden(index);
}
}  // namespace fuzz
}  // namespace inverter_bus

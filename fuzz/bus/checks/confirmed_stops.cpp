// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/confirmed_stops.h"

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
ConfirmedStops::ConfirmedStops(const Observed& observed, const Plant& plant)
  : observed_(observed), plant_(plant), run_read_(observed.inverters.size())
{
}

void ConfirmedStops::answered(TimePoint now, std::size_t index, const ReplyFacts& reply)
{
  if (observed_.exchange.facts.reads_run && reply.settlesRun())
  {
    run_read_[index] = now;
  }
}

void ConfirmedStops::check(TimePoint now, std::size_t index, TimePoint asked_at) const
{
  const InverterRecord& inverter = observed_.inverters[index];
  const std::string name = observed_.scene.title(index);
  // What was commanded since does not concern this stop.
  if (plant_.runLatched(index) && inverter.order.accepted_at < asked_at)
  {
    fail(now, "a confirmed stop", name + " still has RUN on");
  }
  const Brand brand = observed_.scene.inverters[index].brand;
  const bool tells = brand == Brand::HITACHI || brand == Brand::TOSHIBA;
  // A 3G3JE reports neither its RUN nor which request it answers: there another drive's late reply under its station
  // passes.
  const bool imitated = observed_.scene.compoway && inverter.link.imitated_at >= asked_at;
  if (inverter.stop.acknowledged < asked_at && run_read_[index] < asked_at && !imitated)
  {
    fail(now, "a confirmed stop", name + " has acknowledged no stop since it was asked for");
  }
  if (tells && run_read_[index] < asked_at)
  {
    fail(now, "a confirmed stop", name + " was not asked whether RUN is off");
  }
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

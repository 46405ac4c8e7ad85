// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/stops.h"

#include <algorithm>

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
namespace
{
// A user who keeps stopping what is at rest must let other exchanges through.
constexpr unsigned FLOOD = 4;
constexpr double FLOOD_PAUSE_S = 1.0;
}  // namespace

Stops::Stops(const Observed& observed) : observed_(observed), lanes_(observed.inverters.size())
{
}

void Stops::requested(TimePoint now, std::size_t index)
{
  Lane& lane = lanes_[index];
  const StopRecord& stop = observed_.inverters[index].stop;
  const bool flood = lane.in_a_row >= FLOOD && now - stop.sent < seconds(FLOOD_PAUSE_S);
  // At shutdown each one is stopped anyway, in an order of its own.
  if (!stop.active && !lane.due && !flood && !observed_.shutting_down)
  {
    lane.due = now;
    lane.measured = true;
  }
}

void Stops::watchdogExpired(TimePoint since, std::size_t index)
{
  lanes_[index].due = since;
  lanes_[index].measured = false;
}

void Stops::drop(std::size_t index)
{
  lanes_[index].due.reset();
}

void Stops::dropAll()
{
  for (Lane& lane : lanes_)
  {
    lane.due.reset();
  }
}

bool Stops::waits(std::size_t index) const
{
  return lanes_[index].due.has_value();
}

void Stops::checkNextFrame(TimePoint now) const
{
  std::size_t waiting = lanes_.size();
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    const Lane& lane = lanes_[index];
    const bool due = lane.due && !observed_.decidedBefore(now, *lane.due) && now >= lane.run_until;
    waiting = due && observed_.online(index) ? index : waiting;
  }
  if (waiting == lanes_.size())
  {
    return;
  }
  const TimePoint due = *lanes_[waiting].due;
  const RequestFacts& facts = observed_.exchange.facts;
  // Several stops take turns, each once before one is repeated.
  // What a command of 0 had decided before the stop came was no frame of that stop.
  const bool first = facts.inverter && observed_.inverters[*facts.inverter].stop.sent < due + observed_.quiet();
  if (!facts.stop || !(facts.broadcast || first))
  {
    fail(now, "a stop is the next frame on the wire",
         "a stop of " + observed_.scene.title(waiting) + " waits since " + decimal(toSeconds(now - due) * 1e3) +
             " ms, and another frame goes: " + simulation::toHex(observed_.exchange.request));
  }
}

void Stops::sent(TimePoint now)
{
  const RequestFacts& facts = observed_.exchange.facts;
  if (facts.broadcast)
  {
    return;
  }
  Lane& lane = lanes_[*facts.inverter];
  lane.in_a_row = facts.run ? 0 : lane.in_a_row;
  if (!facts.stop)
  {
    return;
  }
  const TimePoint sent_before = last_sent_;
  last_sent_ = now;
  if (lane.due && lane.measured)
  {
    measure(now, *lane.due, sent_before);
  }
  lane.due.reset();
  const bool soon = now - observed_.inverters[*facts.inverter].stop.sent < seconds(FLOOD_PAUSE_S);
  lane.in_a_row = soon ? lane.in_a_row + 1 : 1;
}

void Stops::ended()
{
  const Exchange& exchange = observed_.exchange;
  if (exchange.facts.inverter && exchange.facts.run)
  {
    const InverterFacts& inverter = observed_.scene.inverters[*exchange.facts.inverter];
    lanes_[*exchange.facts.inverter].run_until =
        exchange.answered ? TimePoint() : exchange.request_end + inverter.fullWait();
  }
}

void Stops::measure(TimePoint now, TimePoint due, TimePoint sent_before)
{
  ++checked_;
  // Stops that were asked for together go one after the other: the first one tells the latency.
  worst_ = sent_before < due ? std::max(worst_, now - due) : worst_;
}

void Stops::checkOverdue(TimePoint now, std::size_t index) const
{
  const Lane& lane = lanes_[index];
  if (lane.due && observed_.online(index) && now - std::max(*lane.due, last_sent_) > observed_.longestWait(now))
  {
    fail(now, "a stop's first byte within the exchange in flight plus the gap",
         observed_.scene.title(index) + " waits since " + decimal(toSeconds(now - *lane.due)) + " s");
  }
}

std::uint64_t Stops::checked() const
{
  return checked_;
}

Duration Stops::worst() const
{
  return worst_;
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

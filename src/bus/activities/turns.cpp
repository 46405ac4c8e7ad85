// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/turns.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
/// What the next refresh does with the drive's register map.
MapOrders mapOrders(TimePoint now, Inverter& inverter)
{
  const drive::Monitor& seen = inverter.refresh.fresh().monitor;
  const bool run = inverter.movement.runPossible() || seen.run_seen.value_or(false);
  const bool at_rest = inverter.link.known() && !seen.run_seen.value_or(true) && !seen.running.value_or(true) &&
                       seen.output_frequency.value_or(1.0) == 0.0;
  return inverter.map_use.orders(now, inverter.settings.map().fits(), run, at_rest);
}

/// The wire's time for all that takes from the share of the slow values, once: with \p gap before each exchange, \p
/// unread for one that was not made yet.
Duration slowNeeds(const Inverter& inverter, Duration gap, Duration unread)
{
  const auto& sources = inverter.drive.profile().command_source;
  const auto repeated = std::count_if(sources.begin(), sources.end(),
                                      [](const drive::Expectation& source) { return source.when_commanded; });
  const Duration settings = inverter.movement.runConfirmed() ? unread * repeated : Duration{ 0 };
  return inverter.refresh.reads().slowNeeds(gap, unread) + settings;
}
}  // namespace

Turns::Turns(BusState& bus) : bus_(bus)
{
}

/// Including the waits that the drives themselves have reported.
Duration Turns::longestExchange() const
{
  return bus_.budget.longest_exchange + longestReplyDelay();
}

/// The longest wait of a drive's own (C078) as read from it, beyond what its profile says.
Duration Turns::longestReplyDelay() const
{
  Duration longest{ 0 };
  for (const auto& inverter : bus_.inverters)
  {
    const Duration known = seconds(inverter->drive.profile().reply_delay);
    longest = std::max(longest, inverter->settings.replyDelay() - known);
  }
  return longest;
}

/// Since when an exchange has taken time from others: not while this node itself did not run.
TimePoint Turns::countedFrom(const wire::Reply& reply) const
{
  return std::max(reply.sent_at, reply.finished_at - longestExchange());
}

const drive::ReadBlock& Turns::nextRead(TimePoint now, Inverter& inverter) const
{
  inverter.refresh.useMap([&inverter, now] { return mapOrders(now, inverter); });
  return inverter.refresh.next(now, slowLeave(now, inverter));
}

/// What the share of the slow values leaves to \p inverter (contract, 8.3). One whose warning word is likely to have
/// changed goes before all others.
SlowLeave Turns::slowLeave(TimePoint now, const Inverter& inverter) const
{
  Duration needs{ 0 };
  bool others_ask = false;
  for (const auto& other : bus_.inverters)
  {
    if (!other->link.offline())
    {
      needs += slowNeeds(*other, bus_.budget.slow.gap, bus_.budget.slow.longest);
      others_ask = others_ask || (other->index != inverter.index && other->refresh.asksForWarning(now));
    }
  }
  SlowLeave leave;
  leave.period = bus_.slow_share.reads() ? bus_.slow_share.period(needs) : Duration{ 0 };
  leave.open = bus_.slow_share.open(now) && (inverter.refresh.asksForWarning(now) || !others_ask);
  return leave;
}

void Turns::finish(const InFlight& current, const wire::Reply& reply, bool more)
{
  Duration cost{ 0 };
  if (current.pick.what == Pick::What::Refresh && isAnswered(reply))
  {
    cost = current.cost;
  }
  bus_.meter.exchange(reply.sent_at, reply.finished_at, cost);
  if (current.slow && !current.resync)
  {
    bus_.slow_share.spent(reply.finished_at, price(current, reply) + bus_.budget.slow.gap);
  }
  if (bus_.shutting_down)
  {
    return;
  }
  bus_.scheduler.done(current.pick, countedFrom(reply), reply.finished_at, more, isAnswered(reply));
  if (current.pick.probe && reply.outcome != wire::Outcome::Ok)
  {
    // What a gateway was kept for is no wait of this probe's own.
    const Duration most = reply.gateway_code != 0 ? Duration::max() : current.pick.in_turn;
    bus_.scheduler.probeAccount().charge(reply.finished_at, std::min(price(current, reply), most));
  }
}

/// The time that a probe takes from all others, with its silences; a refusal takes it too.
Duration Turns::price(const InFlight& current, const wire::Reply& reply) const
{
  const Duration own = reply.finished_at - countedFrom(reply);
  const bool by_gateway = bus_.gateway.active() && reply.gateway_code != 0;
  return std::max(by_gateway ? std::max(own, bus_.gateway.block()) : own, current.cost);
}
}  // namespace bus
}  // namespace inverter_bus

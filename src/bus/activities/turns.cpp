// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/turns.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
Turns::Turns(BusState& bus) : bus_(bus)
{
}

/// With what the drives themselves have told of their wait.
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
    bus_.scheduler.chargeProbe(reply.finished_at, price(current, reply));
  }
}

/// The time that a probe takes from everybody else, with its silences; a refusal takes it too.
Duration Turns::price(const InFlight& current, const wire::Reply& reply) const
{
  const Duration own = reply.finished_at - countedFrom(reply);
  const bool by_gateway = bus_.gateway.active() && reply.gateway_code != 0;
  return std::max(by_gateway ? std::max(own, bus_.gateway.block()) : own, current.cost);
}
}  // namespace bus
}  // namespace inverter_bus

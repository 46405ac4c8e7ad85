// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/link_checks.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, 8.10: the link is not renewed within a stop's first tries.
constexpr unsigned STOP_TRIES_BEFORE_RENEWAL = 3;
}  // namespace

LinkChecks::LinkChecks(BusState& bus, const GatewayTraffic& traffic) : bus_(bus), traffic_(traffic)
{
}

/// After a reopening: pending stops, then one read of each inverter that was online, before anything else. A stop that
/// keeps trying in vain lets these reads through, and one that has lost nothing but writes is read first: it may be away.
std::optional<Pick> LinkChecks::pick(TimePoint now, Gate& gate)
{
  while (const auto index = bus_.connection.toRead())
  {
    if (bus_.inverters[*index]->link.offline())
    {
      bus_.connection.unanswered(*index);
      continue;
    }
    gate.stops_only = true;
    gate.others_wait = true;
    const Pick stop = bus_.scheduler.next(now, traffic_.views(now), gate);
    if (stop.what != Pick::What::Nothing || !bus_.gateway.free(now))
    {
      return stop;
    }
    Pick pick;
    const auto in_doubt = std::find_if(bus_.inverters.begin(), bus_.inverters.end(), [](const auto& inverter) {
      return !inverter->link.offline() && inverter->liveness.needsRead();
    });
    pick.inverter = in_doubt != bus_.inverters.end() ? (*in_doubt)->index : *index;
    pick.what = bus_.inverters[pick.inverter]->connectDue(now) ? Pick::What::Connect : Pick::What::Refresh;
    return pick;
  }
  return std::nullopt;
}

void LinkChecks::note(const wire::Reply& reply)
{
  if (!isAnswered(reply) && reply.gateway_code == 0)
  {
    bus_.link.lost(reply.sent_at);
    return;
  }
  if (bus_.link.wasSilent(reply.finished_at))
  {
    // The cost of probes meanwhile has delayed no other exchange.
    bus_.scheduler.probeAccount().restart(reply.finished_at);
  }
  bus_.link.answered();
}

bool LinkChecks::renewalDue(TimePoint now) const
{
  const bool serial = !bus_.configuration.bus.gateway;
  const bool stop_under_way =
      serial && std::any_of(bus_.inverters.begin(), bus_.inverters.end(), [](const auto& inverter) {
        return inverter->stop.pending() && inverter->stop.attempts() < STOP_TRIES_BEFORE_RENEWAL;
      });
  return bus_.connected && !bus_.shutting_down && !stop_under_way && bus_.link.mute(now);
}
}  // namespace bus
}  // namespace inverter_bus

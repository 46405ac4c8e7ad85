// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/gateway_traffic.h"

#include <algorithm>

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
GatewayTraffic::GatewayTraffic(BusState& bus, const Turns& turns) : bus_(bus), turns_(turns)
{
}

GatewayRisk GatewayTraffic::riskOf(const InFlight& current)
{
  switch (current.pick.what)
  {
    case Pick::What::Stop:
    case Pick::What::Broadcast:
      return GatewayRisk::Stop;
    case Pick::What::Velocity:
      if (current.resync)
      {
        return GatewayRisk::None;
      }
      // A 0 is a stop, and its frame the one that may be in the gateway (contract, 8 and 8.8).
      return current.moves ? GatewayRisk::Motion : GatewayRisk::Stop;
    case Pick::What::Refresh:
    case Pick::What::Connect:
    case Pick::What::KeepAlive:
      return current.pick.deadline ? GatewayRisk::Refresh : GatewayRisk::None;
    default:
      return GatewayRisk::None;
  }
}

/// After each exchange: what it leaves in the gateway.
void GatewayTraffic::note(const InFlight& current, const wire::Reply& reply)
{
  bus_.behind_another = false;
  if (!bus_.gateway.active() || current.request.broadcast || reply.ticket == 0)
  {
    return;
  }
  bus_.gateway.sent(reply.sent_at, reply.ticket, current.inverter, riskOf(current), current.pick.probe);
  const bool answered = isAnswered(reply) || reply.gateway_code != 0;
  bus_.behind_another = !answered && bus_.gateway.behindAnother(reply.ticket);
  if (answered)
  {
    bus_.gateway.answered(reply.finished_at, reply.ticket, reply.gateway_code != 0);
  }
  else
  {
    bus_.gateway.lost(reply.finished_at, reply.ticket);
  }
  const bool read = current.pick.what == Pick::What::Refresh || current.pick.what == Pick::What::Connect ||
                    current.pick.what == Pick::What::Setting;
  if (!isAnswered(reply) && read)
  {
    othersFirst(bus_.gateway.freeAt(reply.finished_at), *bus_.inverters[current.inverter]);
  }
}

/// An inverter that has blocked the gateway waits until every other one was refreshed once, counted from when it is free
/// again: otherwise only one exchange would go between two blocks.
void GatewayTraffic::othersFirst(TimePoint free_at, Inverter& inverter)
{
  // Not where its own time-out would pass meanwhile.
  const auto serve_by = inverter.serveBy(bus_.budget.deadline_margin);
  if (!serve_by || *serve_by > free_at + bus_.budget.cycle)
  {
    inverter.pauses.holdStatus(free_at + bus_.budget.cycle);
  }
}

/// Once: its behaviour differs from what users expect.
void GatewayTraffic::tell()
{
  if (bus_.gateway.silentByNature() && !told_of_gateway_)
  {
    told_of_gateway_ = true;
    bus_.outbox.log(Level::Warn, "port " + bus_.configuration.bus.port +
                                     ": requests to a silent station are left unanswered: from now on " +
                                     util::durationText(bus_.gateway.wait()) +
                                     " is the wait, instead of gateway_timeout");
  }
}

/// Contract, 8.8: what follows a lost request would wait behind it, in the gateway.
Gate GatewayTraffic::gate(TimePoint now)
{
  Gate gate;
  if (!bus_.gateway.active())
  {
    return gate;
  }
  if (const auto kept = bus_.gateway.tick(now))
  {
    bus_.scheduler.probeAccount().charge(now, *kept);
  }
  tell();
  gate.stops_only = !bus_.gateway.free(now);
  gate.until = bus_.gateway.freeAt(now);
  bus_.broadcast_waits = bus_.broadcast_waits && gate.stops_only;
  gate.bare_probes = endangered() == nullptr;
  return gate;
}

/// The running inverter with the shortest time-out of its own, if a silent station blocks the gateway for longer than that.
const Inverter* GatewayTraffic::endangered() const
{
  const Inverter* first = nullptr;
  Duration shortest = bus_.gateway.block();
  for (const auto& inverter : bus_.inverters)
  {
    const auto own = inverter->settings.driveTimeout();
    if (own && *own < shortest && !inverter->link.offline() && inverter->mayRun())
    {
      first = inverter.get();
      shortest = *own;
    }
  }
  return first;
}

/// Contract, 8.8: a stop of an inverter that may run goes in spite of its effect on its neighbours, with one WARN.
void GatewayTraffic::tellOfCostlyStop(Inverter& inverter)
{
  const Inverter* const neighbour = inverter.link.silent() && !bus_.shutting_down ? endangered() : nullptr;
  if (neighbour != nullptr && inverter.stop.takeCostly())
  {
    const std::string& name = neighbour->config.name;
    bus_.outbox.log(Level::Warn,
                    inverter.config.name + ": offline, but it may run: each try of its stop blocks the gateway for " +
                        util::durationText(bus_.gateway.block()) + ", longer than the time-out of " + name +
                        ", which is running (" + util::durationText(*neighbour->settings.driveTimeout()) +
                        "): " + name + " may trip or stop because of it; shorten the gateway's time-out");
  }
}

/// A stop whose frame went while an older request could still set RUN goes again when that one is over: only the second one
/// counts.
TimePoint GatewayTraffic::stopNotBefore(TimePoint now, const Inverter& inverter) const
{
  if (untested(inverter))
  {
    return TimePoint::max();
  }
  const TimePoint next_frame = std::max(bus_.gateway.stopMayGoAt(now, inverter.index), inverter.pauses.stopNotBefore());
  const auto danger = inverter.stop.pending() && inverter.stop.provisional()
                          ? bus_.gateway.motionUntil(now, inverter.index)
                          : std::nullopt;
  return danger ? std::max(next_frame, *danger) : next_frame;
}

bool GatewayTraffic::zeroNeedsStop(TimePoint now, const Inverter& inverter) const
{
  return bus_.gateway.active() && (!bus_.gateway.free(now) || bus_.gateway.motionUntil(now, inverter.index));
}

std::vector<InverterView> GatewayTraffic::views(TimePoint now) const
{
  std::vector<InverterView> views;
  views.reserve(bus_.inverters.size());
  for (const auto& inverter : bus_.inverters)
  {
    views.push_back(inverter->view(now, bus_.budget.deadline_margin));
    // A setting that is repeated waits for the share of the slow values (contract, 8.3).
    views.back().background = views.back().background && (!inverter->settings.repeats() || bus_.slow_share.open(now));
    views.back().stop_pending = views.back().stop_pending && !untested(*inverter);
    views.back().stop_not_before = stopNotBefore(now, *inverter);
    views.back().refresh_unanswered = bus_.gateway.refreshUnanswered(now, inverter->index);
  }
  return views;
}

Duration GatewayTraffic::worstStop() const
{
  const Duration wire = bus_.budget.worst_stop_uncut + turns_.longestReplyDelay();
  if (!bus_.gateway.active())
  {
    return wire;
  }
  const auto silent = std::count_if(bus_.inverters.begin(), bus_.inverters.end(), [](const auto& inverter) {
    return inverter->link.offline() || !inverter->link.known();
  });
  return wire + static_cast<int>(silent) * block();
}

/// For how long a silent station blocks the gateway: as measured, or as configured until then.
Duration GatewayTraffic::block() const
{
  return bus_.gateway.block() > Duration::zero() ? bus_.gateway.block() : bus_.gateway.wait();
}

/// When an offline inverter that answers again is noticed at the latest.
std::string GatewayTraffic::returnText() const
{
  if (const Inverter* const neighbour = endangered())
  {
    return "not while " + neighbour->config.name + " runs: its own time-out is shorter than the gateway's block";
  }
  const auto offline = std::count_if(bus_.inverters.begin(), bus_.inverters.end(),
                                     [](const auto& inverter) { return inverter->link.offline(); });
  return util::durationText(Budget::longestReturn(block(), static_cast<std::size_t>(offline)));
}

std::optional<Finding> GatewayTraffic::finding() const
{
  const bool anybody_away = std::any_of(bus_.inverters.begin(), bus_.inverters.end(),
                                        [](const auto& inverter) { return inverter->link.offline(); });
  const Duration allowed = seconds(bus_.configuration.bus.response_timeout);
  if (!bus_.gateway.active() || !anybody_away || bus_.gateway.block() <= allowed)
  {
    return std::nullopt;
  }
  if (bus_.gateway.silentByNature())
  {
    return Finding{ Level::Warn,
                    "the gateway leaves requests to a silent station unanswered: set a time-out in it, so "
                    "that it reports them within response_timeout" };
  }
  return Finding{ Level::Warn,
                  "a station that does not answer blocks the gateway for " + util::durationText(bus_.gateway.block()) +
                      ", and everything waits meanwhile, even a stop: shorten the gateway's own time-out x "
                      "(1 + repeats) below response_timeout (" +
                      util::durationText(allowed) + ")" };
}

/// What it does to numbers and units, if replies can be told apart by their shapes alone.
std::optional<Finding> GatewayTraffic::quirkFinding() const
{
  const std::string& quirk = bus_.line_watch.facts().gateway_quirk;
  return quirk.empty() ? std::nullopt
                       : std::optional<Finding>(Finding{ Level::Warn, "the gateway is used as it is: " + quirk });
}
}  // namespace bus
}  // namespace inverter_bus

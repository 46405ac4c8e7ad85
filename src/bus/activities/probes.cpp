// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/probes.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, rule 3.7: an inverter is found again within 3 s; with a little margin.
constexpr double PROBE_ROUND_S = 2.7;
constexpr double SHORTEST_PROBE_TIMEOUT_S = 0.015;
// Every so many probes waits the whole response_timeout, for a drive that has become slow.
constexpr std::size_t FULL_PROBE_EVERY = 4;
constexpr std::size_t FULL_PROBE_EVERY_OF_MANY = 16;
}  // namespace

Probes::Probes(BusState& bus, Turns& turns, GatewayTraffic& traffic, Stops& stops)
  : bus_(bus), turns_(turns), traffic_(traffic), stops_(stops)
{
}

InFlight Probes::compose(const Pick& pick, const LineView& line)
{
  Inverter& inverter = *bus_.inverters[pick.inverter];
  InFlight current = exchangeFor(pick);
  current.loopback = byLoopback(inverter) && inverter.drive.loopback(inverter.config.node, 0).has_value();
  current.request = request(inverter, ++bus_.loopback_number, timeout(inverter, line));
  inverter.link.probeSent();
  return current;
}

bool Probes::byLoopback(const Inverter& inverter) const
{
  // Two ways to ask in turn, until it is known that the drive has the loop-back.
  const bool worth_it = inverter.config.modbus_tcp ? inverter.loopbackUsable() : inverter.loopback.worthATry();
  return inverter.loopback.proven() || (worth_it && inverter.link.probes() % 2 == 0);
}

wire::Request Probes::request(const Inverter& inverter, std::uint16_t number, Duration response_timeout) const
{
  const drive::Drive& drive = inverter.drive;
  const std::uint8_t node = inverter.config.node;
  const auto echo = byLoopback(inverter) ? drive.loopback(node, number) : std::nullopt;
  const auto& run = drive.runBlock();
  wire::Request request = inverter.prepared(echo ? *echo : drive.read(node, run ? *run : drive.fastBlocks().front()));
  request.response_timeout = std::min(request.response_timeout, response_timeout);
  return request;
}

void Probes::ended(const InFlight& current, const wire::Reply& reply)
{
  bus_.inverters[current.inverter]->link.probed(reply);
  turns_.finish(current, reply, false);
}

/// Probes share 5 % of the bus time, and each dead inverter shall be asked every 3 s: the more are dead, the shorter each
/// one may be waited for, but never shorter than the inverter has ever needed. Its reply still counts when it comes late.
Duration Probes::timeout(const Inverter& inverter, const LineView& line) const
{
  const Duration full = seconds(inverter.config.response_timeout);
  const auto dead = std::count_if(bus_.inverters.begin(), bus_.inverters.end(),
                                  [](const std::unique_ptr<Inverter>& other) { return other->link.silent(); });
  // Staggered by index, so that no round has more than a few full ones.
  const std::size_t every = dead > 1 ? FULL_PROBE_EVERY_OF_MANY : FULL_PROBE_EVERY;
  if ((inverter.link.probes() + inverter.index) % every == every - 1)
  {
    return full;
  }
  const wire::Request bare = request(inverter, 0, Duration::zero());
  const Duration share = seconds(PROBE_ROUND_S * PROBE_SHARE / static_cast<double>(std::max<long>(dead, 1)));
  const Duration needed = inverter.link.slowestReply() + inverter.link.slowestReply() / 2;
  const Duration least = std::max(needed, seconds(SHORTEST_PROBE_TIMEOUT_S));
  return std::min(full, std::max(least, share - line.costUnanswered(bare)));
}

void Probes::lateReply(TimePoint now, const wire::LateReply& late)
{
  bus_.link.answered();
  const auto request = bus_.gateway.answeredLate(now, late.ticket);
  if (request && request->risk == GatewayRisk::None)
  {
    traffic_.othersFirst(now, *bus_.inverters[request->inverter]);
  }
  const bool alone = !bus_.gateway.active() || (request && request->alone);
  if (request && request->alone && request->probe)
  {
    bus_.scheduler.chargeProbe(now, bus_.gateway.block());
  }
  if (request && request->risk == GatewayRisk::Stop)
  {
    const auto latency = bus_.inverters[request->inverter]->stop.answered(now);
    stops_.noteLatency(latency.value_or(Duration::zero()));
  }
  for (const auto& inverter : bus_.inverters)
  {
    if (inverter->config.node != late.station || late.gateway_code != 0)
    {
      continue;
    }
    if (late.delay && alone)
    {
      inverter->link.cameLate(*late.delay);
      inverter->record.noteLate();
    }
    // A probe that was given up early: worth asking for the status, at the probes' cost.
    inverter->link.beginTrial(
        std::min(late.delay.value_or(Duration::zero()), seconds(inverter->config.response_timeout)));
  }
}
}  // namespace bus
}  // namespace inverter_bus

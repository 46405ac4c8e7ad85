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
// Contract, rule 3.7: an inverter is back within 3 s; what is left is for its first status.
constexpr double PROBE_ROUND_S = 2.6;
}  // namespace

Probes::Probes(BusState& bus, Turns& turns, GatewayTraffic& traffic, Stops& stops)
  : bus_(bus), turns_(turns), traffic_(traffic), stops_(stops)
{
}

std::vector<std::size_t> Probes::silentInverters() const
{
  std::vector<std::size_t> silent;
  for (const auto& inverter : bus_.inverters)
  {
    if (inverter->link.silent())
    {
      silent.push_back(inverter->index);
    }
  }
  return silent;
}

InFlight Probes::compose(TimePoint now, const Pick& pick, const LineView& line)
{
  Inverter& inverter = *bus_.inverters[pick.inverter];
  InFlight current = exchangeFor(pick);
  const Wait wait = this->wait(now, inverter, line);
  current.pick.in_turn = wait.in_turn;
  current.loopback = byLoopback(inverter) && inverter.drive.loopback(inverter.config.node, 0).has_value();
  current.request = request(inverter, ++bus_.loopback_number, wait.timeout);
  inverter.link.probeSent();
  return current;
}

InFlight Probes::limit(TimePoint now, InFlight stop, const LineView& line) const
{
  if (stop.pick.probe)
  {
    const Wait wait = this->wait(now, *bus_.inverters[stop.inverter], line);
    stop.request.response_timeout = std::min(stop.request.response_timeout, wait.timeout);
    stop.pick.in_turn = wait.in_turn;
  }
  return stop;
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
/// one may be waited for, but never shorter than the inverter has ever needed. Its reply still counts when it comes late;
/// for one whose late replies are lost among those of others there is a long wait now and then.
Probes::Wait Probes::wait(TimePoint now, const Inverter& inverter, const LineView& line) const
{
  const Duration full = seconds(inverter.config.response_timeout);
  const Duration brief = shortTimeout(inverter, line);
  const bool may_wait = bus_.scheduler.probeAccount().mayWaitLong(now, inverter.index, silentInverters());
  Wait wait;
  wait.timeout = may_wait ? full : brief;
  if (brief < wait.timeout)
  {
    wait.in_turn = line.costUnanswered(request(inverter, 0, brief));
  }
  return wait;
}

Duration Probes::shortTimeout(const Inverter& inverter, const LineView& line) const
{
  const Duration full = seconds(inverter.config.response_timeout);
  const std::size_t dead = silentInverters().size();
  const wire::Request bare = request(inverter, 0, Duration::zero());
  const Duration share =
      seconds(PROBE_ROUND_S * PROBE_TURNS_SHARE / static_cast<double>(std::max<std::size_t>(dead, 1)));
  const Duration least = leastProbeTimeout(inverter.link.slowestReply(), bare.reply_delay);
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
    bus_.scheduler.probeAccount().charge(now, bus_.gateway.block());
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
    inverter->pauses.holdStop(now);
    // No longer time-out would have caught one for which a stop has ended the wait.
    const Duration waited = seconds(inverter->config.response_timeout) + inverter->settings.replyDelay();
    if (late.delay && alone && *late.delay > waited)
    {
      inverter->link.cameLate(*late.delay);
      inverter->record.noteLate();
    }
    // A probe that was given up early: worth asking for the status, at the probes' cost.
    const bool silent = inverter->link.silent();
    inverter->link.beginTrial(
        std::min(late.delay.value_or(Duration::zero()), seconds(inverter->config.response_timeout)));
    if (silent && inverter->link.onTrial())
    {
      bus_.scheduler.turnSoon(inverter->index);
    }
  }
}
}  // namespace bus
}  // namespace inverter_bus

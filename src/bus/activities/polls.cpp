// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/polls.h"

#include <algorithm>

#include "bus/report/inverter_report.h"

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

/// The wire's time for all that takes from the share of the slow values, once: with \p gap before each exchange, \p unread for
/// one that was not made yet.
Duration slowNeeds(const Inverter& inverter, Duration gap, Duration unread)
{
  const auto& sources = inverter.drive.profile().command_source;
  const auto repeated = std::count_if(sources.begin(), sources.end(),
                                      [](const drive::Expectation& source) { return source.when_commanded; });
  const Duration settings = inverter.movement.runConfirmed() ? unread * repeated : Duration{ 0 };
  return inverter.refresh.reads().slowNeeds(gap, unread) + settings;
}
}  // namespace

Polls::Polls(BusState& bus, Turns& turns, const ReplyGuard& guard, Stops& stops, Absences& absences)
  : bus_(bus)
  , turns_(turns)
  , guard_(guard)
  , stops_(stops)
  , absences_(absences)
  , repeats_(bus.inverters.size(), Repeats(bus.configuration.bus.retries))
{
}

/// What the share of the slow values leaves to \p inverter (contract, 8.3). One whose warning word has a reason to be another
/// one goes before all others.
SlowLeave Polls::slowLeave(TimePoint now, const Inverter& inverter) const
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

InFlight Polls::compose(TimePoint now, const Pick& pick, const LineView& line)
{
  Inverter& inverter = *bus_.inverters[pick.inverter];
  InFlight current = exchangeFor(pick);
  inverter.refresh.useMap([&inverter, now] { return mapOrders(now, inverter); });
  const bool resync = inverter.loopbackUsable() && inverter.drive.loopback(inverter.config.node, 0);
  drive::ReadBlock block = inverter.refresh.next(now, slowLeave(now, inverter));
  current.request = inverter.drive.read(inverter.config.node, block);
  while (!resync && !line.mayAsk(current.request, now) && inverter.refresh.skipSlow())
  {
    // What decides over safety does not wait a second for a temperature.
    block = inverter.refresh.next(now);
    current.request = inverter.drive.read(inverter.config.node, block);
  }
  current.slow = inverter.refresh.asked().isSlowed();
  // Rule 4.1: the confirmed words are repeated only while the last exchange showed our RUN in force; never through a gateway,
  // which could carry them out when everything has changed, or has just been connected anew (contract, 8.8, 8.9 and 8.11).
  if (!bus_.configuration.bus.gateway && !block.chosen.empty() && inverter.mayRepeatWords(now))
  {
    const std::vector<drive::Word> words = inverter.movement.wordsInForce();
    const wire::Request both =
        words.empty() ? current.request : inverter.drive.writeAndRead(inverter.config.node, words, block);
    // After a lost 17H that shape is barred for a while, the plain read is not.
    current.request = line.mayAsk(both, now) ? both : current.request;
  }
  std::optional<drive::ReadBlock> variant = block;
  while (!resync && variant && !line.mayAsk(current.request, now))
  {
    // Without a loop-back a lost read would leave the drive unwatched for a second: another length is no risk.
    variant = inverter.drive.variantOf(*variant);
    current.request = variant ? inverter.drive.read(inverter.config.node, *variant) : current.request;
  }
  const auto serve_by = inverter.serveBy(bus_.budget.deadline_margin);
  if (!resync && !line.mayAsk(current.request, now) && serve_by && *serve_by <= now)
  {
    const auto spare = guard_.spareRead(now, inverter, line);
    current.pick.what = spare ? Pick::What::KeepAlive : current.pick.what;
    current.request = spare.value_or(current.request);
  }
  current.request = inverter.prepared(current.request);
  return current;
}

void Polls::ended(const InFlight& current, const wire::Reply& reply)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  // What waited in a gateway behind an older request says nothing of this inverter.
  const bool says_nothing = bus_.behind_another && !isAnswered(reply);
  if (!current.resync && !says_nothing)
  {
    inverter.liveness.noteRead(current.cost, reply);
  }
  if (isAnswered(reply))
  {
    repeats_[inverter.index].restart();
    if (reply.outcome == wire::Outcome::Ok)
    {
      inverter.liveness.dataRead();
    }
    const bool more =
        reply.outcome == wire::Outcome::Ok ? inverter.refresh.received(reply) : inverter.refresh.refused(reply);
    if (reply.outcome == wire::Outcome::Ok && inverter.lost_writes.readAnswered())
    {
      bus_.outbox.log(Level::Error, inverter.config.name + ": stopped and locked: " + inverter.lost_writes.text());
    }
    turns_.finish(current, reply, more);
    inverter.noteStatus(reply, more);
    if (more)
    {
      actOn(reply.finished_at, inverter, inverter.wordsRead(reply.finished_at));
    }
    if (inverter.refresh.takeComplete())
    {
      judge(reply.finished_at, inverter);
    }
    else if (!more)
    {
      refusedStatus(reply, inverter);
    }
    return;
  }
  // One that has lost as many writes as make a drive offline is not asked twice.
  const bool decided = inverter.link.offline() || inverter.liveness.needsRead();
  if (!decided && repeats_[inverter.index].again(reply))
  {
    turns_.finish(current, reply, true);
    return;
  }
  inverter.refresh.failed();
  turns_.finish(current, reply, false);
  const bool was_offline = inverter.link.offline();
  absences_.noteLost(reply.finished_at, inverter, reply.error_id);
  if (!was_offline && !inverter.link.offline() && inverter.link.known())
  {
    // Shows the error beside the last good values, which keep their stamp.
    bus_.outbox.publish(reply.finished_at, inverter);
  }
}

void Polls::keptAlive(const InFlight& current, const wire::Reply& reply)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  // One that is lost gives the turn away.
  turns_.finish(current, reply, isAnswered(reply));
  if (reply.outcome == wire::Outcome::Ok)
  {
    inverter.liveness.dataRead();
  }
  if (!isAnswered(reply))
  {
    absences_.noteLost(reply.finished_at, inverter, reply.error_id);
  }
}

/// It answers, but refuses to tell: the last good values keep their stamp.
void Polls::refusedStatus(const wire::Reply& reply, Inverter& inverter)
{
  if (inverter.refresh.takeRefusal() || inverter.link.offline())
  {
    absences_.noteRefusal(reply.finished_at, inverter, reply.error_id);
  }
  if (!inverter.link.offline() && inverter.link.known())
  {
    inverter.link.failed(reply.error_id);
    bus_.outbox.publish(reply.finished_at, inverter);
  }
}

void Polls::judge(TimePoint now, Inverter& inverter)
{
  if (!inverter.link.known())
  {
    bus_.outbox.log(Level::Ok, inverter.config.name + ": " + onlineText(inverter), inverter.config.name);
  }
  const Judgement judgement = inverter.statusComplete(now);
  if (judgement.tripped)
  {
    bus_.outbox.log(Level::Error, inverter.config.name + ": tripped: " + judgement.trip_text);
    bus_.outbox.trace(inverter.config.name + " tripped");
  }
  actOn(now, inverter, judgement);
  bus_.outbox.publish(now, inverter);
}

void Polls::actOn(TimePoint now, Inverter& inverter, const Judgement& judgement)
{
  if (!judgement.stop_reason.empty())
  {
    stops_.request(now, inverter, StopMode::Decelerate, true, judgement.stop_reason);
  }
  else if (judgement.zero_failed)
  {
    stops_.request(now, inverter, StopMode::Decelerate, false, "");
  }
}
}  // namespace bus
}  // namespace inverter_bus

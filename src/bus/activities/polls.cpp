// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/polls.h"

#include <algorithm>

#include "bus/report/inverter_report.h"

namespace inverter_bus
{
namespace bus
{
Polls::Polls(BusState& bus, Turns& turns, const ReplyGuard& guard, Stops& stops, Absences& absences)
  : bus_(bus)
  , turns_(turns)
  , guard_(guard)
  , stops_(stops)
  , absences_(absences)
  , repeats_(bus.inverters.size(), Repeats(bus.configuration.bus.retries))
{
}

InFlight Polls::compose(TimePoint now, const Pick& pick, const LineView& line)
{
  Inverter& inverter = *bus_.inverters[pick.inverter];
  InFlight current = exchangeFor(pick);
  const bool resync = inverter.loopbackUsable() && inverter.drive.loopback(inverter.config.node, 0);
  drive::ReadBlock block = turns_.nextRead(now, inverter);
  current.request = inverter.drive.read(inverter.config.node, block);
  while (!resync && !line.mayAsk(current.request, now) && inverter.refresh.skipSlow())
  {
    // What decides safety does not wait a second for a temperature.
    block = inverter.refresh.next(now);
    current.request = inverter.drive.read(inverter.config.node, block);
  }
  current.slow = inverter.refresh.asked().isSlowed();
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
  keepAlive(now, inverter, current, line);
  current.request = inverter.prepared(current.request);
  return current;
}

/// Where only writes, or the command word, feed the drive's own time-out (contract, 8.17): what is in force once more. Rule
/// 4.1: RUN only while the last exchange showed it in force, never through a gateway, which could carry it out when
/// everything has changed, or has just been reconnected (contract, 8.8, 8.9 and 8.11); at rest the stop word.
void Polls::keepAlive(TimePoint now, Inverter& inverter, InFlight& current, const LineView& line) const
{
  const drive::Sequence* stop = inverter.drive.sequence("stop");
  const bool offline = inverter.link.offline() || !inverter.link.known();
  const auto serve_by = inverter.serveBy(bus_.budget.deadline_margin);
  const bool due = inverter.feeding.needsWrites() && serve_by && *serve_by <= now;
  if (!due || bus_.configuration.bus.gateway || offline || inverter.settings.identity() != Identity::Right)
  {
    return;
  }
  const std::uint8_t station = inverter.config.node;
  wire::Request request;
  bool with_status = false;
  bool repeats = false;
  if (inverter.mayRepeatWords(now) && !inverter.movement.wordsInForce().empty())
  {
    const std::vector<drive::Word> words = inverter.movement.wordsInForce();
    const drive::ReadBlock& block = inverter.refresh.asked().block;
    repeats = true;
    with_status = !block.chosen.empty() && inverter.drive.fitsBlockWrite(words);
    request = with_status ? inverter.drive.writeAndRead(station, words, block)
                          : inverter.drive.write(station, words.back().first, words.back().second);
  }
  else if (stop != nullptr && !inverter.mayRun() && !inverter.movement.target() && !inverter.stop.pending())
  {
    request = inverter.drive.write(station, stop->steps.front().point, stop->steps.front().value.value_or(0));
  }
  if (!request.pdu.empty() && line.mayAsk(request, now))
  {
    current.request = request;
    current.keeps_alive = !with_status;
    current.may_start = repeats;
    current.slow = false;
    current.pick.what = with_status ? current.pick.what : Pick::What::KeepAlive;
  }
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
    took(reply, inverter, more);
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

/// What follows from the answer to a read of the refresh, which goes on with \p more.
void Polls::took(const wire::Reply& reply, Inverter& inverter, bool more)
{
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
}

void Polls::cameWithWrite(const InFlight& current, const wire::Reply& reply)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  if (!current.with_status || current.resync || reply.outcome != wire::Outcome::Ok || inverter.link.offline())
  {
    return;
  }
  repeats_[inverter.index].restart();
  inverter.liveness.dataRead();
  const bool more = inverter.refresh.received(reply);
  if (!bus_.shutting_down)
  {
    // It was a turn of the refresh, too: the cycle goes on with the next inverter.
    Pick turn;
    turn.what = Pick::What::Refresh;
    turn.inverter = inverter.index;
    bus_.scheduler.done(turn, reply.sent_at, reply.finished_at, more, true);
  }
  took(reply, inverter, more);
}

void Polls::keptAlive(const InFlight& current, const wire::Reply& reply)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  // One that is lost gives the turn away.
  turns_.finish(current, reply, isAnswered(reply));
  if (reply.outcome == wire::Outcome::Ok && !current.keeps_alive)
  {
    inverter.liveness.dataRead();
  }
  if (!isAnswered(reply) && current.keeps_alive)
  {
    absences_.noteLostWrite(reply.finished_at, inverter, reply.error_id);
  }
  else if (!isAnswered(reply))
  {
    absences_.noteLost(reply.finished_at, inverter, reply.error_id);
  }
}

/// It answers, but refuses the read: the last good values keep their stamp.
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

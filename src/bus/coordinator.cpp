// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/coordinator.h"

#include <algorithm>

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// A pick that turned out to have nothing to send is dropped; more in a row than this would be a mistake in this program.
constexpr int MOST_EMPTY_PICKS = 100;
constexpr double EMPTY_PICKS_PAUSE_S = 0.1;
// A port that has stayed open for this long works, even if no drive answers: even a lone dead inverter was probed
// meanwhile.
constexpr double PORT_WORKS_AFTER_S = 3.0;
}  // namespace

Coordinator::Coordinator(const Configuration& configuration, const wire::Line& line)
  : bus_(configuration, line), activities_(bus_)
{
}

Coordinator::~Coordinator() = default;

// --- time ------------------------------------------------------------------------------------------------------------

bool Coordinator::tick(TimePoint now)
{
  bus_.outbox.at(now);
  noteRunning(now);
  activities_.stops.checkWatchdogs(now);
  const bool lost_one = activities_.absences.watchStatuses(now);
  for (const std::string& line : bus_.refusals.takeLines(now))
  {
    bus_.outbox.log(Level::Warn, line);
  }
  activities_.services.expire(now);
  activities_.stops.finishCalls(now);
  activities_.reports.publishSlowly(now);
  return lost_one;
}

/// Looks for a jump of time. Only the watches for drives' answers forgive it; command watchdogs and locks go by the real
/// time.
void Coordinator::noteRunning(TimePoint now)
{
  const Duration frozen = freeze_.back(now);
  if (frozen == Duration::zero() || !bus_.connected)
  {
    return;
  }
  bus_.outbox.log(Level::Warn,
                  "this node did not run for " + util::durationText(frozen) +
                      ": it was stopped, or its machine is overloaded; nothing was sent meanwhile, no stop either");
  for (const auto& inverter : bus_.inverters)
  {
    inverter->liveness.notWatching(now, frozen);
  }
  bus_.link.notWatching(frozen);
}

// --- the next exchange -----------------------------------------------------------------------------------------------

std::optional<Coordinator::Exchange> Coordinator::next(TimePoint now, const LineView& line, TimePoint& wake)
{
  if (tick(now))
  {
    // Users hear of an inverter that is offline before it is probed.
    wake = now;
    return std::nullopt;
  }
  in_flight_ = chosen(now, line, wake);
  if (!in_flight_)
  {
    freeze_.backBy(wake);
    return std::nullopt;
  }
  freeze_.backBy(now + activities_.turns.longestExchange());
  in_flight_->chosen_at = now;
  Exchange exchange;
  exchange.request = in_flight_->request;
  exchange.cut_after = activities_.waits.cutAfter(*in_flight_);
  if (exchange.request.broadcast)
  {
    exchange.turnaround = seconds(bus_.inverters.front()->drive.profile().broadcast_turnaround);
  }
  return exchange;
}

/// What goes now; nothing: not before \p wake.
std::optional<InFlight> Coordinator::chosen(TimePoint now, const LineView& line, TimePoint& wake)
{
  for (int attempt = 0; attempt < MOST_EMPTY_PICKS; ++attempt)
  {
    std::optional<InFlight> current = activities_.stops.composeBroadcast(now);
    if (!current)
    {
      const Pick chosen = pick(now);
      if (chosen.what == Pick::What::Nothing)
      {
        wake = std::max(activities_.stops.earliestWatchdog(chosen.wake), now);
        return std::nullopt;
      }
      current = compose(now, chosen, line);
    }
    if (current && !activities_.telnet.mustWait(now, *current) && activities_.guard.makeSafe(now, *current, line))
    {
      current->cost = line.cost(current->request);
      current->full_wait = line.costUnanswered(current->request);
      activities_.waits.shorten(*current, line);
      return current;
    }
  }
  wake = now + seconds(EMPTY_PICKS_PAUSE_S);
  return std::nullopt;
}

Pick Coordinator::pick(TimePoint now)
{
  Gate allowed = activities_.traffic.gate(now);
  activities_.stops.replaceZeros(now);
  if (bus_.shutting_down)
  {
    return activities_.shutdown.pick(now);
  }
  if (bus_.line_watch.facts().telnet_found)
  {
    return activities_.telnet.pick(now);
  }
  const auto check = activities_.checks.pick(now, allowed);
  return check ? *check : bus_.scheduler.next(now, activities_.traffic.views(now), allowed);
}

std::optional<InFlight> Coordinator::compose(TimePoint now, const Pick& pick, const LineView& line)
{
  switch (pick.what)
  {
    case Pick::What::Stop:
      return activities_.probes.limit(now, activities_.stops.compose(pick), line);
    case Pick::What::Velocity:
      return activities_.velocities.compose(now, pick, line);
    case Pick::What::Service:
      return activities_.services.compose(now, pick);
    case Pick::What::Refresh:
      return activities_.polls.compose(now, pick, line);
    case Pick::What::Connect:
    case Pick::What::Setting:
      return activities_.settings.compose(pick);
    case Pick::What::Probe:
      return activities_.probes.compose(now, pick, line);
    case Pick::What::Release:
      return activities_.shutdown.composeRelease(pick);
    default:
      return std::nullopt;
  }
}

void Coordinator::sent(TimePoint now)
{
  if (!in_flight_)
  {
    return;
  }
  const InFlight& current = *in_flight_;
  bus_.outbox.at(now);
  activities_.trace.sent(current);
  bus_.last_node = current.request.station;
  const bool wears = activities_.services.wears(current) || activities_.velocities.wears(current);
  if (!current.resync && current.pick.what != Pick::What::Broadcast && wears)
  {
    // What reaches the drive's EEPROM wears it, answered or not, and each repeat again.
    bus_.inverters[current.inverter]->services.eepromWritten();
  }
  activities_.services.sent(current);
  activities_.velocities.sent(current);
  activities_.stops.sent(now, current);
}

// --- its end ---------------------------------------------------------------------------------------------------------

void Coordinator::done(const wire::Reply& reply)
{
  bus_.outbox.at(reply.finished_at);
  noteRunning(reply.finished_at);
  if (!in_flight_)
  {
    return;
  }
  const InFlight current = *in_flight_;
  in_flight_.reset();
  activities_.trace.ended(current, reply);
  // Before the end of the connection is booked: what was under way then may still be carried out.
  activities_.traffic.note(current, reply);
  if (reply.outcome != wire::Outcome::PortLost)
  {
    ended(current, reply);
    return;
  }
  if (!activities_.port.resumes(reply.finished_at, current.inverter))
  {
    activities_.port.lost(reply.finished_at);
    return;
  }
  // Lost for its station alone (contract, 8.9).
  wire::Reply lost = reply;
  lost.outcome = wire::Outcome::Timeout;
  lost.error_id = wire::ERROR_TIMEOUT;
  lost.connection_closed = true;
  ended(current, lost);
}

/// The end of an exchange over a port that is there, or soon is again.
void Coordinator::ended(const InFlight& current, const wire::Reply& reply)
{
  if (reply.outcome != wire::Outcome::Timeout || reply.finished_at - bus_.opened_at > seconds(PORT_WORKS_AFTER_S))
  {
    activities_.port.works();
  }
  if (reply.cut)
  {
    cut(current, reply);
    return;
  }
  bus_.last_error = reply.outcome == wire::Outcome::Ok ? std::uint16_t{ 0 } : reply.error_id;
  if (current.pick.what == Pick::What::Broadcast)
  {
    bus_.meter.exchange(reply.sent_at, reply.finished_at, Duration{ 0 });
    return;
  }
  noteReply(current, reply);
  // A loop-back that is refused has synchronized nothing: for a stop that is a failed attempt.
  const bool refused_stop = current.pick.what == Pick::What::Stop && reply.outcome == wire::Outcome::Exception;
  if (current.resync && isAnswered(reply) && !refused_stop)
  {
    // The line is synchronized again: the real request keeps its turn.
    activities_.turns.finish(current, reply, true);
    return;
  }
  endedBy(current, reply);
}

/// What an exchange shows about its inverter and the way to it, whatever its purpose.
void Coordinator::noteReply(const InFlight& current, const wire::Reply& reply)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  inverter.noteExchange(reply);
  activities_.waits.note(current, reply);
  if (current.request.expects_reply)
  {
    inverter.record.note(reply);
    activities_.checks.note(reply);
    activities_.port.noteConnection(reply.finished_at, current, reply);
  }
  inverter.link.noteCost(current.pick.probe, reply.outcome, activities_.turns.price(current, reply));
  const bool read_of_refresh = current.pick.what == Pick::What::Refresh && !current.resync;
  if (current.request.expects_reply && !isAnswered(reply) && !bus_.behind_another && !read_of_refresh)
  {
    inverter.liveness.missed(reply.error_id);
  }
  if (current.request.expects_reply && isAnswered(reply))
  {
    const bool silent = inverter.link.silent();
    inverter.link.answered(reply);
    if (silent)
    {
      bus_.scheduler.turnSoon(inverter.index);
    }
    inverter.feeding.answered(current.request, reply.finished_at);
  }
  // An unanswered probe says nothing about the loop-back: the drive is away.
  if (current.loopback && (current.resync || isAnswered(reply)))
  {
    inverter.loopback.note(reply.outcome);
  }
  else if (!current.loopback && isAnswered(reply))
  {
    inverter.loopback.otherAnswered();
  }
}

/// A stop has ended the wait (contract, 8.4): its outcome is unknown, and no drive is to blame. It goes again in its
/// turn.
void Coordinator::cut(const InFlight& current, const wire::Reply& reply)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  inverter.noteExchange(reply);
  inverter.link.noteCost(current.pick.probe, reply.outcome, activities_.turns.price(current, reply));
  if (!current.resync && current.may_start)
  {
    // Another inverter's stop was in a hurry; its own goes when this frame has had its time.
    inverter.pauses.holdStop(reply.sent_at + current.full_wait);
  }
  const bool goes_on = current.pick.what == Pick::What::Service || current.pick.what == Pick::What::Refresh;
  switch (current.pick.what)
  {
    case Pick::What::Stop:
      endedBy(current, reply);
      break;
    case Pick::What::Velocity:
      activities_.velocities.cut(current, reply);
      break;
    case Pick::What::Connect:
    case Pick::What::Setting:
      activities_.settings.cut(current, reply);
      break;
    default:
      activities_.turns.finish(current, reply, goes_on);
      break;
  }
}

/// What follows from it for the activity to which it belongs.
void Coordinator::endedBy(const InFlight& current, const wire::Reply& reply)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  switch (current.pick.what)
  {
    case Pick::What::Stop:
      activities_.absences.take(activities_.stops.ended(current, reply), reply, inverter);
      break;
    case Pick::What::Velocity:
      activities_.velocities.ended(current, reply);
      activities_.polls.cameWithWrite(current, reply);
      break;
    case Pick::What::Service:
      activities_.absences.take(activities_.services.ended(current, reply), reply, inverter);
      break;
    case Pick::What::Refresh:
      activities_.polls.ended(current, reply);
      break;
    case Pick::What::KeepAlive:
      activities_.polls.keptAlive(current, reply);
      break;
    case Pick::What::Connect:
    case Pick::What::Setting:
      activities_.settings.ended(current, reply);
      break;
    default:
      activities_.probes.ended(current, reply);
      break;
  }
}
}  // namespace bus
}  // namespace inverter_bus

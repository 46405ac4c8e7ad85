// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>
#include <tuple>

#include "bus/coordinator.h"
#include "wire/shown_number.h"

// The way to the drives: what a gateway still works on, connections that are closed by their other end, links that have gone
// mute, telnet servers.

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, 8.9: one line a minute.
constexpr double RESUMED_LOG_PERIOD_S = 60.0;
// Failed attempts at a stop over a telnet connection before it is closed.
constexpr unsigned TELNET_STOP_ATTEMPTS = 1;
// How soon a write is looked at again that waits for the first valid reply of a connection.
constexpr double UNPROVEN_PERIOD_S = 0.02;
// Contract, 8.10: the link is not renewed within a stop's first tries.
constexpr unsigned STOP_TRIES_BEFORE_RENEWAL = 3;
}  // namespace

// --- gateway ---------------------------------------------------------------------------------------------------------

GatewayRisk Coordinator::riskOf(const Current& current) const
{
  switch (current.purpose)
  {
    case Purpose::StopFrame:
    case Purpose::Broadcast:
      return GatewayRisk::Stop;
    case Purpose::Velocity:
      if (current.resync)
      {
        return GatewayRisk::None;
      }
      // A 0 is a stop, and its frame the one that may be in the gateway (contract, 8 and 8.8).
      return current.moves ? GatewayRisk::Motion : GatewayRisk::Stop;
    case Purpose::Refresh:
    case Purpose::KeepAlive:
    case Purpose::Setting:
      // A setting may have taken the refresh's turn.
      return current.pick.deadline ? GatewayRisk::Refresh : GatewayRisk::None;
    default:
      return GatewayRisk::None;
  }
}

/// After each exchange: what it leaves in the gateway.
void Coordinator::noteGateway(const Current& current, const wire::Reply& reply)
{
  behind_another_ = false;
  if (!gateway_.active() || current.request.broadcast || reply.ticket == 0)
  {
    return;
  }
  gateway_.sent(reply.sent_at, reply.ticket, current.inverter, riskOf(current), current.pick.probe);
  const bool answered = isAnswered(reply) || reply.gateway_code != 0;
  behind_another_ = !answered && gateway_.behindAnother(reply.ticket);
  if (answered)
  {
    gateway_.answered(reply.finished_at, reply.ticket, reply.gateway_code != 0);
  }
  else
  {
    gateway_.lost(reply.finished_at, reply.ticket);
  }
  const bool read = current.purpose == Purpose::Refresh || current.purpose == Purpose::Setting;
  if (!isAnswered(reply) && read)
  {
    othersFirst(gateway_.freeAt(reply.finished_at), *inverters_[current.inverter]);
  }
}

/// Whoever has kept the gateway waits until everybody else was refreshed once, counted from when it is free again: else only
/// one exchange would go between two blocks.
void Coordinator::othersFirst(TimePoint free_at, Inverter& inverter)
{
  // Not where its own time-out would pass meanwhile.
  const auto serve_by = inverter.serveBy(budget_.deadline_margin);
  if (!serve_by || *serve_by > free_at + budget_.cycle)
  {
    inverter.refresh_not_before = free_at + budget_.cycle;
  }
}

/// Once: what it does differs from what its users expect.
void Coordinator::tellOfTheGateway()
{
  if (gateway_.silentByNature() && !told_of_gateway_)
  {
    told_of_gateway_ = true;
    log(Level::Warn, "port " + configuration_.bus.port +
                         ": requests to a silent station are left unanswered: from now on " +
                         wire::shownDuration(gateway_.wait()) + " is waited for instead of gateway_timeout");
  }
}

/// Contract, 8.8: what follows a lost request would wait behind it, in the gateway.
Gate Coordinator::gate(TimePoint now)
{
  Gate gate;
  if (!gateway_.active())
  {
    return gate;
  }
  if (const auto kept = gateway_.tick(now))
  {
    scheduler_->chargeProbe(now, *kept);
  }
  tellOfTheGateway();
  gate.stops_only = !gateway_.free(now);
  gate.until = gateway_.freeAt(now);
  broadcast_waits_ = broadcast_waits_ && gate.stops_only;
  gate.bare_probes = endangered() == nullptr;
  return gate;
}

/// The running inverter with the shortest time-out of its own, if a silent station keeps the gateway for longer than that.
const Inverter* Coordinator::endangered() const
{
  const Inverter* first = nullptr;
  Duration shortest = gateway_.block();
  for (const auto& inverter : inverters_)
  {
    const auto own = inverter->settings.driveTimeout();
    if (own && *own < shortest && !inverter->offline() && inverter->mayRun())
    {
      first = inverter.get();
      shortest = *own;
    }
  }
  return first;
}

/// Contract, 8.8: a stop of an inverter that may run goes in spite of what that does to its neighbours, with one WARN.
void Coordinator::tellOfCostlyStop(Inverter& inverter)
{
  const Inverter* const neighbour = inverter.silent() && !shutting_down_ ? endangered() : nullptr;
  if (neighbour != nullptr && inverter.stop.takeCostly())
  {
    const std::string& name = neighbour->config.name;
    log(Level::Warn, inverter.config.name + ": offline, but it may run: each try of its stop keeps the gateway for " +
                         wire::shownDuration(gateway_.block()) + ", longer than the time-out of " + name +
                         " itself, which runs (" + wire::shownDuration(*neighbour->settings.driveTimeout()) +
                         "): " + name + " may trip or stop by that; shorten the gateway's time-out");
  }
}

/// The time that a probe takes from everybody else, with its silences; a refusal takes it too.
Duration Coordinator::probePrice(const Current& current, const wire::Reply& reply) const
{
  const Duration own = reply.finished_at - countedFrom(reply);
  const bool by_gateway = gateway_.active() && reply.gateway_code != 0;
  return std::max(by_gateway ? std::max(own, gateway_.block()) : own, line_.cost(current.request, Duration{ 0 }));
}

/// A stop whose frame went while an older request could still set RUN goes again when that one is over: only the second one
/// counts.
TimePoint Coordinator::stopNotBefore(TimePoint now, const Inverter& inverter) const
{
  if (untested(inverter))
  {
    return TimePoint::max();
  }
  const TimePoint next_frame = gateway_.stopMayGoAt(now, inverter.index);
  const auto danger =
      inverter.stop.pending() && inverter.stop.provisional() ? gateway_.motionUntil(now, inverter.index) : std::nullopt;
  return danger ? std::max(next_frame, *danger) : next_frame;
}

/// A velocity of 0 that can't be confirmed now takes the way of a stop, which knows how to insist.
void Coordinator::stopInsteadOfZeros(TimePoint now)
{
  if (!gateway_.active())
  {
    return;
  }
  for (const auto& inverter : inverters_)
  {
    const auto& target = inverter->movement.target();
    if (target && target->zero && scheduler_->velocityWaits(inverter->index) && zeroNeedsStop(now, *inverter))
    {
      requestStop(now, *inverter, StopMode::Decelerate, gateway_.motionUntil(now, inverter->index).has_value(), "");
    }
  }
}

bool Coordinator::zeroNeedsStop(TimePoint now, const Inverter& inverter) const
{
  return gateway_.active() && (!gateway_.free(now) || gateway_.motionUntil(now, inverter.index));
}

Duration Coordinator::worstStop() const
{
  const Duration wire = budget_.worst_stop + longestReplyDelay();
  if (!gateway_.active())
  {
    return wire;
  }
  const auto silent = std::count_if(inverters_.begin(), inverters_.end(),
                                    [](const auto& inverter) { return inverter->offline() || !inverter->known(); });
  return wire + static_cast<int>(silent) * gatewayBlock();
}

/// For how long a silent station keeps the gateway: as measured, or as configured until it is.
Duration Coordinator::gatewayBlock() const
{
  return gateway_.block() > Duration::zero() ? gateway_.block() : gateway_.wait();
}

/// When an offline inverter that answers again is noticed at the latest.
std::string Coordinator::returnText() const
{
  if (const Inverter* const neighbour = endangered())
  {
    return "not while " + neighbour->config.name + " runs, whose own time-out is shorter than the gateway is kept";
  }
  const auto offline =
      std::count_if(inverters_.begin(), inverters_.end(), [](const auto& inverter) { return inverter->offline(); });
  return wire::shownDuration(Budget::longestReturn(gatewayBlock(), static_cast<std::size_t>(offline)));
}

std::optional<Finding> Coordinator::gatewayFinding() const
{
  const bool anybody_away =
      std::any_of(inverters_.begin(), inverters_.end(), [](const auto& inverter) { return inverter->offline(); });
  const Duration allowed = seconds(configuration_.bus.response_timeout);
  if (!gateway_.active() || !anybody_away || gateway_.block() <= allowed)
  {
    return std::nullopt;
  }
  if (gateway_.silentByNature())
  {
    return Finding{ Level::Warn,
                    "the gateway leaves requests to a silent station unanswered: set a time-out in it, so "
                    "that it says so within response_timeout" };
  }
  return Finding{ Level::Warn, "a station that does not answer keeps the gateway for " +
                                   wire::shownDuration(gateway_.block()) +
                                   ", and everything waits meanwhile, a stop too: shorten the gateway's own time-out x "
                                   "(1 + repeats) below response_timeout (" +
                                   wire::shownDuration(allowed) + ")" };
}

/// What it does to numbers and units, so that replies are told apart by their shapes alone.
std::optional<Finding> Coordinator::quirkFinding() const
{
  const std::string quirk = line_.gatewayQuirk();
  return quirk.empty() ? std::nullopt
                       : std::optional<Finding>(Finding{ Level::Warn, "the gateway is used as it is: " + quirk });
}

// --- connection ------------------------------------------------------------------------------------------------------

std::vector<std::size_t> Coordinator::onlineInverters() const
{
  std::vector<std::size_t> online;
  for (const auto& inverter : inverters_)
  {
    if (!inverter->offline() && inverter->known())
    {
      online.push_back(inverter->index);
    }
  }
  return online;
}

/// The other end has closed the connection, in place of the answer of \p index or between two exchanges. True: it is opened
/// again at once, and nothing else happens.
bool Coordinator::resumes(TimePoint now, std::optional<std::size_t> index)
{
  if (!connected_ || line_.lastLoss() != wire::Loss::ClosedByPeer)
  {
    connection_.lost();
    return false;
  }
  // Our own time-out may have passed before the gateway's.
  const ConnectionWatch::Verdict verdict = connection_.closed(now, index ? index : last_unanswered_);
  if (verdict == ConnectionWatch::Verdict::TakenByAnother)
  {
    log(Level::Warn, "port " + configuration_.bus.port +
                         ": the other end closes the connection again and again: does another client use it?");
  }
  if (verdict != ConnectionWatch::Verdict::Resume)
  {
    return false;
  }
  gateway_.connectionEnded(now);
  ++resumed_;
  if (!resumed_logged_at_ || now - *resumed_logged_at_ >= seconds(RESUMED_LOG_PERIOD_S))
  {
    log(Level::Ok, "port " + configuration_.bus.port + ": the other end has closed the connection; it is opened again" +
                       (resumed_ > 1 ? " (" + std::to_string(resumed_) + " times since the last line)" : ""));
    resumed_logged_at_ = now;
    resumed_ = 0;
  }
  return true;
}

void Coordinator::portClosed(TimePoint now)
{
  if (!resumes(now, std::nullopt))
  {
    portLost(now);
  }
}

void Coordinator::portPending(TimePoint now)
{
  if (connection_.resuming() && connection_.notOpen(now) == ConnectionWatch::Verdict::Lost)
  {
    portLost(now);
  }
}

TimePoint Coordinator::openNotBefore() const
{
  return connection_.openNotBefore();
}

bool Coordinator::resuming() const
{
  return connection_.resuming();
}

/// After each exchange: who is there over this connection.
void Coordinator::noteConnection(TimePoint now, const Current& current, const wire::Reply& reply)
{
  last_unanswered_.reset();
  if (isAnswered(reply))
  {
    connection_.answered(now, current.inverter);
  }
  else
  {
    last_unanswered_ = current.inverter;
    connection_.unanswered(current.inverter);
  }
  if (connection_.nobodyAnswered())
  {
    log(Level::Error, "port " + configuration_.bus.port + ": is open again, but nobody answers", PORT);
    connection_.lost();
    loseEverybody(now, wire::ERROR_TIMEOUT);
  }
}

/// A drive with a port of its own that has not told its status yet: to a gateway the same number means something else, so that
/// nothing but reads goes there (contract, 8.8).
bool Coordinator::untested(const Inverter& inverter) const
{
  return inverter.config.ownPort() && !inverter.everKnown();
}

/// Nothing but reads and stops goes to somebody who may be a telnet server (contract, 8.11).
bool Coordinator::mustWait(TimePoint now, const Current& current)
{
  const bool unproven = configuration_.bus.gateway && !configuration_.bus.modbus_tcp && !line_.provenSinceOpen();
  const bool writes = current.purpose == Purpose::Velocity || current.purpose == Purpose::Job;
  if (unproven && writes)
  {
    scheduler_->postpone(current.pick.command, now + seconds(UNPROVEN_PERIOD_S));
  }
  return unproven && (writes || current.purpose == Purpose::Release);
}

void Coordinator::loseEverybody(TimePoint now, std::uint16_t error_id)
{
  for (const auto& inverter : inverters_)
  {
    if (!inverter->offline())
    {
      inverter->goOffline(error_id);
      wentOffline(now, *inverter);
    }
    inverter->noteExchangeError(error_id);
  }
}

/// After a reopening: pending stops, then one read of each inverter that was online, before anything else. A stop that
/// insists in vain lets these reads through, and one that has lost nothing but writes is read first: it may be away.
std::optional<Pick> Coordinator::pickCheck(TimePoint now, Gate& gate)
{
  while (const auto index = connection_.toRead())
  {
    if (inverters_[*index]->offline())
    {
      connection_.unanswered(*index);
      continue;
    }
    gate.stops_only = true;
    gate.others_wait = true;
    const Pick stop = scheduler_->next(now, views(now), gate);
    if (stop.what != Pick::What::Nothing || !gateway_.free(now))
    {
      return stop;
    }
    Pick pick;
    pick.what = Pick::What::Refresh;
    const auto in_doubt = std::find_if(inverters_.begin(), inverters_.end(), [](const auto& inverter) {
      return !inverter->offline() && inverter->liveness.needsRead();
    });
    pick.inverter = in_doubt != inverters_.end() ? (*in_doubt)->index : *index;
    return pick;
  }
  return std::nullopt;
}

// --- mute links, telnet ----------------------------------------------------------------------------------------------

void Coordinator::noteLink(const wire::Reply& reply)
{
  if (!isAnswered(reply) && reply.gateway_code == 0)
  {
    link_.lost(reply.sent_at);
    return;
  }
  if (link_.wasSilent(reply.finished_at))
  {
    // What probes have cost meanwhile has delayed nobody.
    scheduler_->restartProbes(reply.finished_at);
  }
  link_.answered();
}

bool Coordinator::renewalDue(TimePoint now)
{
  noteRunning(now);
  const bool serial = !configuration_.bus.gateway;
  const bool stop_under_way =
      serial && std::any_of(inverters_.begin(), inverters_.end(), [](const auto& inverter) {
        return inverter->stop.pending() && inverter->stop.attempts() < STOP_TRIES_BEFORE_RENEWAL;
      });
  return connected_ && !shutting_down_ && !stop_under_way && link_.mute(now);
}

void Coordinator::renewing(TimePoint now)
{
  if (link_.renewing(now))
  {
    log(Level::Warn,
        "port " + configuration_.bus.port +
            ": is open, but nobody answers any more: it is opened anew, again and again while that lasts",
        PORT);
  }
  // So long without an answer is no gap any more: whatever runs is to be stopped first when somebody answers again.
  loseEverybody(now, wire::ERROR_TIMEOUT);
  connection_.lost();
  gateway_.connectionEnded(now);
  renewing_ = true;
}

void Coordinator::reopening(TimePoint now)
{
  connection_.reopening(now);
  gateway_.connectionEnded(now);
}

/// Its stop has had its attempts on this connection, in vain.
bool Coordinator::triedOverTelnet(const Inverter& inverter) const
{
  return inverter.stop.attempts() >= attempts_at_open_[inverter.index] + TELNET_STOP_ATTEMPTS;
}

/// Only stops go over a telnet connection, those of offline inverters as well, and then it is closed.
bool Coordinator::telnetOver(TimePoint now)
{
  if (!line_.telnetFound())
  {
    return false;
  }
  if (!telnet_)
  {
    telnet_ = true;
    loseEverybody(now, wire::ERROR_PORT_LOST);
  }
  return std::none_of(inverters_.begin(), inverters_.end(),
                      [this](const auto& inverter) { return inverter->stop.pending() && !triedOverTelnet(*inverter); });
}

Pick Coordinator::pickOverTelnet(TimePoint now) const
{
  const auto key = [](const Inverter& inverter) {
    return std::make_tuple(inverter.silent(), inverter.stop.attempts(), inverter.stop.lastSentAt());
  };
  Pick pick;
  pick.wake = now;
  for (const auto& inverter : inverters_)
  {
    const bool due = inverter->stop.pending() && !triedOverTelnet(*inverter);
    if (due && (pick.what == Pick::What::Nothing || key(*inverter) < key(*inverters_[pick.inverter])))
    {
      pick.what = Pick::What::Stop;
      pick.inverter = inverter->index;
      pick.probe = inverter->silent();
    }
  }
  return pick;
}

void Coordinator::closedForTelnet(TimePoint now)
{
  connection_.slowDown();
  portFails(now, "port " + configuration_.bus.port + " is a telnet server (telnet mode): set the port to raw");
}
}  // namespace bus
}  // namespace inverter_bus

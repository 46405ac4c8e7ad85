// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/stops.h"

#include <algorithm>
#include <utility>

namespace inverter_bus
{
namespace bus
{
Stops::Stops(BusState& bus, Turns& turns, GatewayTraffic& traffic) : bus_(bus), turns_(turns), traffic_(traffic)
{
}

void Stops::request(TimePoint now, Inverter& inverter, StopMode mode, bool lock, const std::string& reason)
{
  if (!reason.empty() && !inverter.interlock.stopPending())
  {
    bus_.outbox.log(Level::Warn, inverter.config.name + ": stopping: " + reason);
  }
  const bool news = !inverter.stop.pending();
  inverter.movement.drop();
  inverter.movement.forgetWords();
  bus_.scheduler.eraseVelocity(inverter.index);
  inverter.stop.request(now, mode);
  if (!inverter.stop.pending())
  {
    return;
  }
  // A request in a gateway may set RUN after the first frame of the stop: locked until the second one is confirmed
  // (contract, 8.8).
  const bool locks = lock || bus_.gateway.motionUntil(now, inverter.index);
  if (news)
  {
    bus_.outbox.event(inverter.config.name + ": a stop is accepted" + (locks ? ", which locks" : ""));
  }
  if (locks)
  {
    inverter.stop.hold();
    inverter.interlock.stopRequested();
  }
}

void Stops::stop(TimePoint now, std::optional<std::size_t> index, std::uint8_t mode, AnswerCallback callback)
{
  if (bus_.ended)
  {
    // Nothing would ever confirm it: the caller would wait in vain.
    bus_.outbox.refuse(callback, ERROR_SHUTTING_DOWN, errorText(ERROR_SHUTTING_DOWN));
    return;
  }
  Call call;
  call.callback = std::move(callback);
  call.expires = now + seconds(serviceBounds(bus_).stop);
  const std::optional<StopMode> known = stopModeOf(mode);
  const StopMode wanted = known.value_or(StopMode::Decelerate);
  bool fell_back = !known;
  for (const auto& inverter : bus_.inverters)
  {
    if (index && *index != inverter->index)
    {
      continue;
    }
    request(now, *inverter, wanted, true, "");
    fell_back = fell_back || (wanted != StopMode::Decelerate && inverter->stop.sequenceFor(wanted) == "stop");
    if (inverter->stop.pending())
    {
      call.waiting.push_back(inverter->index);
    }
    else
    {
      call.error_id = ERROR_NOT_ARMED;
      call.problems.push_back(inverter->config.name + ": its stop command is not confirmed in the profile");
    }
  }
  if (fell_back)
  {
    call.note = "mode " + std::to_string(mode) + " is not offered here, carried out as DECELERATE";
  }
  if (!index && broadcastIsSafe())
  {
    broadcast_requested_ = broadcast_due_ ? broadcast_requested_ : now;
    broadcast_due_ = true;
  }
  if (call.callback)
  {
    // No caller waits for the others: a flood of them must not be kept.
    calls_.push_back(std::move(call));
  }
  finishCalls(now);
}

void Stops::finishCalls(TimePoint now)
{
  for (auto call = calls_.begin(); call != calls_.end();)
  {
    auto& waiting = call->waiting;
    waiting.erase(std::remove_if(waiting.begin(), waiting.end(),
                                 [&](std::size_t index) { return !bus_.inverters[index]->stop.pending(); }),
                  waiting.end());
    if (!waiting.empty() && now < call->expires)
    {
      ++call;
      continue;
    }
    for (const std::size_t index : waiting)
    {
      call->problems.push_back(problem(*bus_.inverters[index]));
      const std::uint16_t error_id = bus_.inverters[index]->stop.lastError();
      call->error_id = error_id != 0 ? error_id : wire::ERROR_TIMEOUT;
      call->error_id = bus_.connected ? call->error_id : wire::ERROR_PORT_LOST;
    }
    Answer reply;
    reply.success = call->problems.empty();
    reply.error_id = reply.success ? ERROR_NONE : call->error_id;
    reply.message = reply.success ? "stopped: RUN is confirmed off" : "not confirmed; the node keeps trying";
    for (const std::string& problem : call->problems)
    {
      reply.message += "; " + problem;
    }
    reply.message += call->note.empty() ? "" : "; " + call->note;
    bus_.outbox.answer(call->callback, reply);
    call = calls_.erase(call);
  }
}

std::string Stops::problem(const Inverter& inverter) const
{
  const std::uint16_t error_id = inverter.stop.lastError();
  const std::string& name = inverter.config.name;
  if (!bus_.connected)
  {
    return name + ": the port is gone";
  }
  if (error_id == 0)
  {
    return name + ": acknowledged, but RUN is still on";
  }
  return name + ": " + refusalText(inverter, error_id);
}

void Stops::confirmed(TimePoint now, Inverter& inverter)
{
  inverter.cameToRest(now);
  inverter.settings.underCommand(false);
  inverter.interlock.stopConfirmed(now);
  bus_.outbox.event(inverter.config.name + ": the stop is confirmed");
  finishCalls(now);
}

void Stops::checkWatchdogs(TimePoint now)
{
  for (const auto& inverter : bus_.inverters)
  {
    // A stop that locks nothing (a 0, a RUN that got lost) may be pending: silence locks all the same.
    if (inverter->interlock.watchdogDue(now) && !inverter->interlock.stopPending())
    {
      request(now, *inverter, StopMode::Decelerate, true,
              bus_.refusals.watchdogReason(inverter->index, inverter->config.command_timeout));
    }
  }
}

TimePoint Stops::earliestWatchdog(TimePoint wake) const
{
  for (const auto& inverter : bus_.inverters)
  {
    if (const auto at = inverter->interlock.watchdogAt())
    {
      wake = std::min(wake, *at);
    }
  }
  return wake;
}

/// A velocity of 0 that can't be confirmed now goes the way of a stop, which keeps trying.
void Stops::replaceZeros(TimePoint now)
{
  if (!bus_.gateway.active())
  {
    return;
  }
  for (const auto& inverter : bus_.inverters)
  {
    const auto& target = inverter->movement.target();
    if (target && target->zero && bus_.scheduler.velocityWaits(inverter->index) &&
        traffic_.zeroNeedsStop(now, *inverter))
    {
      request(now, *inverter, StopMode::Decelerate, false, "");
    }
  }
}

void Stops::refuseCalls()
{
  for (const Call& call : calls_)
  {
    bus_.outbox.refuse(call.callback, ERROR_SHUTTING_DOWN, errorText(ERROR_SHUTTING_DOWN));
  }
  calls_.clear();
}

void Stops::dropBroadcast()
{
  broadcast_due_ = false;
}

Duration Stops::latencyMax() const
{
  return latency_max_;
}
}  // namespace bus
}  // namespace inverter_bus

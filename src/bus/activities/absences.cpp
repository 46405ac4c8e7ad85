// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/absences.h"

#include <algorithm>

#include "bus/report/inverter_report.h"

namespace inverter_bus
{
namespace bus
{
Absences::Absences(BusState& bus, Stops& stops, Services& services) : bus_(bus), stops_(stops), services_(services)
{
}

void Absences::take(Ending ending, const wire::Reply& reply, Inverter& inverter)
{
  switch (ending)
  {
    case Ending::Lost:
      noteLost(reply.finished_at, inverter, reply.error_id);
      break;
    case Ending::LostWrite:
      noteLostWrite(reply.finished_at, inverter, reply.error_id);
      break;
    case Ending::LostStopWrite:
    {
      noteLostWrite(reply.finished_at, inverter, reply.error_id);
      const bool too_many = !bus_.behind_another && inverter.lost_writes.lost();
      if (too_many && !inverter.link.offline())
      {
        writesLost(reply.finished_at, inverter);
      }
      break;
    }
    case Ending::Refused:
      failTrial(reply.finished_at, inverter, reply.error_id);
      break;
    case Ending::Nothing:
      break;
  }
}

void Absences::noteLost(TimePoint now, Inverter& inverter, std::uint16_t error_id)
{
  // Behind an older request that the gateway still works on it says nothing of this inverter (contract, 8.16).
  if (!bus_.behind_another && inverter.failed(now, error_id))
  {
    wentOffline(now, inverter);
    return;
  }
  failTrial(now, inverter, error_id);
}

/// It answers, but not with what counts.
void Absences::noteRefusal(TimePoint now, Inverter& inverter, std::uint16_t error_id)
{
  if (inverter.refusedStatus(error_id))
  {
    wentOffline(now, inverter);
    return;
  }
  failTrial(now, inverter, error_id);
}

/// An offline inverter that has answered has shown no status after all: the probes pay for what that has cost.
void Absences::failTrial(TimePoint now, Inverter& inverter, std::uint16_t error_id)
{
  if (inverter.link.onTrial() && !bus_.shutting_down)
  {
    bus_.scheduler.probeAccount().charge(now, inverter.endTrial(error_id));
  }
}

/// A lost write says little: a read must soon show whether the drive is away, or only loses writes.
void Absences::noteLostWrite(TimePoint now, Inverter& inverter, std::uint16_t error_id)
{
  if (!bus_.behind_another && inverter.failed(now, error_id, true))
  {
    wentOffline(now, inverter);
    return;
  }
  failTrial(now, inverter, error_id);
  if (!inverter.link.offline() && inverter.liveness.needsRead())
  {
    bus_.scheduler.readSoon(inverter.index);
  }
}

/// Contract, 8.1: what can't be written to can't be commanded, however well it answers reads.
void Absences::writesLost(TimePoint now, Inverter& inverter)
{
  const std::string text = inverter.lost_writes.text();
  const bool news = !inverter.lost_writes.raised();
  if (news)
  {
    bus_.outbox.log(Level::Error, inverter.config.name + ": stopping and locking: " + text);
  }
  inverter.lost_writes.raise();
  inverter.command_error.failed(wire::ERROR_TIMEOUT, text);
  stops_.request(now, inverter, StopMode::Decelerate, true, "");
  if (news && inverter.link.known())
  {
    bus_.outbox.publish(now, inverter);
  }
}

void Absences::wentOffline(TimePoint now, Inverter& inverter)
{
  bus_.scheduler.eraseVelocity(inverter.index);
  services_.fail(inverter.index, ERROR_OFFLINE, errorText(ERROR_OFFLINE) + ": " + offlineReason(inverter));
  if (bus_.connected)
  {
    bus_.outbox.log(Level::Error, inverter.config.name + ": offline: " + offlineReason(inverter), inverter.config.name);
    bus_.outbox.trace(inverter.config.name + " went offline");
  }
  if (inverter.movement.runPossible())
  {
    stops_.request(now, inverter, StopMode::Decelerate, true, "it may still run while it can't be reached");
  }
  bus_.outbox.publish(now, inverter);
}

void Absences::loseEverybody(TimePoint now, std::uint16_t error_id)
{
  for (const auto& inverter : bus_.inverters)
  {
    if (!inverter->link.offline())
    {
      inverter->goOffline(error_id);
      wentOffline(now, *inverter);
    }
    inverter->link.failed(error_id);
  }
}

/// Contract, 8.15: without a complete status for too long an inverter is offline, whatever else it answers.
bool Absences::watchStatuses(TimePoint now)
{
  if (!bus_.connected || bus_.shutting_down)
  {
    return false;
  }
  bool lost_one = false;
  for (const auto& inverter : bus_.inverters)
  {
    if (!inverter->link.offline() && inverter->liveness.overdue(now, refreshPeriod(*inverter)))
    {
      const std::uint16_t error_id = inverter->liveness.lastError();
      inverter->goOffline(error_id);
      wentOffline(now, *inverter);
      lost_one = true;
    }
  }
  return lost_one;
}

/// The longest time between two of its refreshes as the configuration has it, and as a gateway may stretch it.
Duration Absences::refreshPeriod(const Inverter& inverter) const
{
  const Duration period = bus_.budget.cycle + seconds(bus_.configuration.bus.interval);
  const int cycles =
      inverter.view(bus_.opened_at, bus_.budget.deadline_margin).at_rest ? bus_.configuration.bus.idle_divisor : 1;
  return cycles * period + bus_.gateway.longestPause();
}
}  // namespace bus
}  // namespace inverter_bus

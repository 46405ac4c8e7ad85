// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/services.h"

#include <algorithm>
#include <utility>

#include "bus/activities/parameter_gate.h"
#include "bus/report/inverter_report.h"

namespace inverter_bus
{
namespace bus
{
Services::Services(BusState& bus, Turns& turns, Stops& stops)
  : bus_(bus), turns_(turns), stops_(stops), ram_changes_(bus.inverters.size())
{
}

void Services::reset(TimePoint now, std::size_t index, AnswerCallback callback)
{
  Inverter& inverter = *bus_.inverters[index];
  if (!bus_.shutting_down && inverter.drive.sequence("reset") == nullptr)
  {
    const std::string missing = inverter.drive.missingFor("reset");
    bus_.outbox.refuse(callback, missing.empty() ? ERROR_NOT_OFFERED : ERROR_NOT_ARMED,
                       missing.empty() ? "this drive has no fault reset"
                                       : "fault reset is not armed: " + inverter.drive.armingAdvice("reset"));
    return;
  }
  if (!bus_.shutting_down && !inverter.drive.tellsRun() && inverter.drive.sequence("stop") == nullptr)
  {
    bus_.outbox.refuse(
        callback, ERROR_NOT_ARMED,
        "a reset needs a confirmed stop before it, and a stop is not armed: " + inverter.drive.armingAdvice("stop"));
    return;
  }
  if (refuse(index, callback) || joinReset(index, callback))
  {
    return;
  }
  const drive::Monitor& told = inverter.refresh.fresh().monitor;
  // Not reported, or reported in an unknown word: a trip that can't be ruled out is reset.
  if (!inverter.interlock.isFaulted() && !told.tripped().value_or(true))
  {
    Answer nothing;
    nothing.success = true;
    nothing.message = "no trip: nothing was sent";
    bus_.outbox.answer(callback, nothing);
    return;
  }
  inverter.services.resetBegun();
  if (!inverter.drive.tellsRun())
  {
    stops_.request(now, inverter, StopMode::Decelerate, true, "");
  }
  start(now, index, std::make_unique<ResetJob>(inverter.drive, inverter.config.node, told.unknown_trip),
        serviceBounds(bus_).reset, std::move(callback));
}

void Services::readFaults(TimePoint now, std::size_t index, AnswerCallback callback)
{
  Inverter& inverter = *bus_.inverters[index];
  if (!bus_.shutting_down && inverter.drive.faultEntries() == 0)
  {
    bus_.outbox.refuse(callback, ERROR_NOT_OFFERED, "this drive has no trip memory that can be read");
    return;
  }
  if (refuse(index, callback))
  {
    return;
  }
  start(now, index,
        std::make_unique<ReadFaultsJob>(inverter.drive, inverter.config.node, inverter.interlock.isFaulted()),
        serviceBounds(bus_).read_faults, std::move(callback));
}

void Services::readParameter(TimePoint now, std::size_t index, const std::string& name, AnswerCallback callback)
{
  Inverter& inverter = *bus_.inverters[index];
  const auto parameter = inverter.drive.findParameter(name, false);
  if (!bus_.shutting_down && !parameter)
  {
    const WriteVerdict verdict = whyNotReadable(inverter.drive, name);
    bus_.outbox.refuse(callback, verdict.error_id, verdict.text);
    return;
  }
  if (refuse(index, callback))
  {
    return;
  }
  start(now, index, std::make_unique<ReadParameterJob>(inverter.drive, inverter.config.node, *parameter),
        serviceBounds(bus_).read_parameter, std::move(callback));
}

void Services::writeParameter(TimePoint now, std::size_t index, const std::string& name, double value, bool persist,
                              AnswerCallback callback)
{
  Inverter& inverter = *bus_.inverters[index];
  const WriteVerdict verdict =
      checkWrite(inverter.drive, name, value, persist, bus_.configuration.bus.parameters_read_only, inverter.mayRun());
  if (!bus_.shutting_down && verdict.error_id != 0)
  {
    bus_.outbox.refuse(callback, verdict.error_id, verdict.text);
    return;
  }
  if (refuse(index, callback))
  {
    return;
  }
  start(now, index,
        std::make_unique<WriteParameterJob>(inverter.drive, inverter.config.node,
                                            *inverter.drive.findParameter(name, true), verdict.raw, persist,
                                            ram_changes_[index]),
        serviceBounds(bus_).write_parameter, std::move(callback));
}

void Services::configureMap(TimePoint now, std::size_t index,
                            const std::vector<std::pair<std::string, std::uint32_t>>& wanted)
{
  const Inverter& inverter = *bus_.inverters[index];
  start(now, index,
        std::make_unique<ConfigureMapJob>(inverter.drive, inverter.config.node, wanted, ram_changes_[index]),
        serviceBounds(bus_).write_parameter, AnswerCallback());
}

/// A brand or model that the profile is not for: what it would do with these requests is unknown.
bool Services::refuseWrongDrive(const Inverter& inverter, const AnswerCallback& callback)
{
  const bool wrong = inverter.settings.identity() == Identity::Wrong;
  const std::string why = inverter.link.offline() && !wrong ? "" : inverter.settings.identityText();
  if (!why.empty() && !bus_.shutting_down)
  {
    bus_.outbox.refuse(callback, wrong ? ERROR_NOT_ARMED : ERROR_OFFLINE, why);
  }
  return !why.empty() && !bus_.shutting_down;
}

bool Services::refuse(std::size_t index, const AnswerCallback& callback)
{
  const Inverter& inverter = *bus_.inverters[index];
  if (bus_.shutting_down)
  {
    bus_.outbox.refuse(callback, ERROR_SHUTTING_DOWN, errorText(ERROR_SHUTTING_DOWN));
    return true;
  }
  if (refuseWrongDrive(inverter, callback))
  {
    return true;
  }
  if (inverter.link.offline() || !inverter.link.known())
  {
    bus_.outbox.refuse(callback, ERROR_OFFLINE,
                       inverter.link.offline() ? errorText(ERROR_OFFLINE) + ": " + offlineReason(inverter)
                                               : "the inverter has not answered yet");
    return true;
  }
  return false;
}

void Services::start(TimePoint now, std::size_t index, std::unique_ptr<Job> job, double bound, AnswerCallback callback)
{
  const CommandId id = bus_.next_command++;
  Running running{ std::move(job), index, now + seconds(bound), {}, Repeats(bus_.configuration.bus.retries) };
  running.callbacks.push_back(std::move(callback));
  jobs_.emplace(id, std::move(running));
  queue(id, now);
}

/// A second reset behind the first would reset a motor that was started between the two.
bool Services::joinReset(std::size_t index, const AnswerCallback& callback)
{
  const auto under_way = std::find_if(jobs_.begin(), jobs_.end(), [index](const auto& entry) {
    return entry.second.inverter == index && entry.second.job->kind() == CommandKind::Reset;
  });
  if (under_way == jobs_.end())
  {
    return false;
  }
  under_way->second.callbacks.push_back(callback);
  return true;
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/services.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double BLIND_RESET_PERIOD_S = 0.02;
}  // namespace

void Services::queue(CommandId id, TimePoint not_before)
{
  const Running& running = jobs_.at(id);
  WaitingCommand waiting;
  waiting.id = id;
  waiting.kind = running.job->kind();
  waiting.inverters = { running.inverter };
  waiting.not_before = not_before;
  bus_.scheduler.push(waiting);
}

std::optional<InFlight> Services::compose(TimePoint now, const Pick& pick)
{
  Running& running = jobs_.at(pick.command);
  Inverter& inverter = *bus_.inverters[running.inverter];
  const bool blind_reset = running.job->kind() == CommandKind::Reset && !inverter.drive.tellsRun();
  if (blind_reset && inverter.movement.runPossible() && !inverter.stop.pending())
  {
    stops_.request(now, inverter, StopMode::Decelerate, true, "RUN must be off before the trip is reset");
  }
  if (blind_reset && inverter.stop.pending())
  {
    // This drive can't be asked whether RUN is off: the stop must be confirmed first.
    bus_.scheduler.postpone(pick.command, now + seconds(BLIND_RESET_PERIOD_S));
    return std::nullopt;
  }
  if (running.job->needsRest() && (inverter.mayRun() || inverter.movement.target()))
  {
    Answer moving;
    moving.error_id = ERROR_NOT_OFFERED;
    moving.message = "not while the motor runs: it was started meanwhile";
    bus_.scheduler.erase(pick.command);
    end(pick.command, moving);
    return std::nullopt;
  }
  InFlight current = exchangeFor(pick);
  current.request = inverter.prepared(running.job->next());
  current.lasting = running.job->lasting();
  return current;
}

void Services::sent(const InFlight& current)
{
  const auto job = jobs_.find(current.pick.command);
  if (current.pick.what == Pick::What::Service && job != jobs_.end() && job->second.job->inSetup())
  {
    bus_.inverters[current.inverter]->services.setupOpened();
  }
}

bool Services::wears(const InFlight& current) const
{
  const auto job = jobs_.find(current.pick.command);
  return current.pick.what == Pick::What::Service && job != jobs_.end() &&
         job->second.job->kind() == CommandKind::WriteParameter &&
         bus_.inverters[current.inverter]->drive.profile().writes == drive::Writes::Eeprom;
}

Ending Services::ended(const InFlight& current, const wire::Reply& reply)
{
  const auto found = jobs_.find(current.pick.command);
  if (found == jobs_.end())
  {
    // Its bound passed, or the inverter went offline, while the frame was on the wire.
    turns_.finish(current, reply, false);
    return Ending::Nothing;
  }
  Running& running = found->second;
  Inverter& inverter = *bus_.inverters[current.inverter];
  const bool reads =
      running.job->kind() == CommandKind::ReadParameter || running.job->kind() == CommandKind::ReadFaults;
  // What was under way when the connection was closed may have been carried out (contract, 8.9).
  const bool once = reply.connection_closed && !reads;
  if (!once && running.repeats.again(reply))
  {
    turns_.finish(current, reply, true);
    return Ending::Nothing;
  }
  if (reads && reply.outcome == wire::Outcome::Ok)
  {
    inverter.liveness.dataRead();
  }
  const Job::Progress progress = isAnswered(reply) ? running.job->done(reply) : running.job->lost(reply);
  if (isAnswered(reply))
  {
    inverter.liveness.heard();
  }
  doneStep(reply.finished_at, current);
  turns_.finish(current, reply, false);
  advance(reply.finished_at, current.pick.command, progress);
  return isAnswered(reply) ? Ending::Nothing : Ending::Lost;
}

/// What follows from the frame of a job, whatever its answer: a drive that restarts.
void Services::doneStep(TimePoint now, const InFlight& current)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  const Running& running = jobs_.at(current.pick.command);
  if (!current.request.expects_reply)
  {
    // It executes without a reply and is deaf for a while: neither a time-out nor an offline drive.
    inverter.pauses.holdStatus(now + running.job->pause());
  }
}

/// However a job ends: what it may have changed in the drive is read again.
void Services::noteEnd(Inverter& inverter, const Job& job, const Answer& result)
{
  const Aftermath aftermath = job.aftermath();
  if (!aftermath.parameter.empty())
  {
    inverter.parameterWritten(aftermath.parameter);
    inverter.services.setupLeft();
  }
  if (aftermath.leave_setup)
  {
    inverter.settings.leaveSetup();
  }
  if (aftermath.connect_again)
  {
    inverter.settings.connectAgain();
  }
  if (!aftermath.logged_as.empty())
  {
    bus_.outbox.log(result.success ? Level::Ok : Level::Warn,
                    inverter.config.name + ": " + aftermath.logged_as + ": " + result.message);
    inverter.settings.restart(false);
  }
}

void Services::advance(TimePoint now, CommandId id, Job::Progress progress)
{
  Running& running = jobs_.at(id);
  Inverter& inverter = *bus_.inverters[running.inverter];
  if (running.job->clearsWords())
  {
    if (running.job->takeDeafening())
    {
      inverter.liveness.deafUntil(now + seconds(inverter.drive.profile().deaf_after_reset));
    }
    inverter.movement.forgetWords();
  }
  if (progress == Job::Progress::Done)
  {
    end(id, Answer(running.job->answer()));
    return;
  }
  if (progress == Job::Progress::NeedsStop)
  {
    stops_.request(now, inverter, StopMode::Decelerate, true, "RUN must be off before the trip is reset");
  }
  queue(id, now + running.job->pause());
}

void Services::end(CommandId id, const Answer& result)
{
  const auto found = jobs_.find(id);
  if (found == jobs_.end())
  {
    return;
  }
  noteEnd(*bus_.inverters[found->second.inverter], *found->second.job, result);
  if (found->second.job->kind() == CommandKind::Reset)
  {
    bus_.inverters[found->second.inverter]->services.resetEnded();
  }
  for (const AnswerCallback& callback : found->second.callbacks)
  {
    bus_.outbox.answer(callback, result);
  }
  jobs_.erase(found);
}

void Services::fail(std::size_t index, std::uint16_t error_id, const std::string& message)
{
  std::vector<CommandId> ids;
  for (const auto& entry : jobs_)
  {
    if (entry.second.inverter == index)
    {
      ids.push_back(entry.first);
    }
  }
  for (const CommandId id : ids)
  {
    Answer failed;
    failed.error_id = error_id;
    failed.message = message;
    bus_.scheduler.erase(id);
    end(id, failed);
  }
}

void Services::expire(TimePoint now)
{
  std::vector<CommandId> expired;
  for (const auto& entry : jobs_)
  {
    if (now >= entry.second.expires)
    {
      expired.push_back(entry.first);
    }
  }
  for (const CommandId id : expired)
  {
    Running& running = jobs_.at(id);
    Answer late = running.job->answer();
    late.success = false;
    late.error_id = late.error_id != 0 ? late.error_id : wire::ERROR_TIMEOUT;
    late.message = late.message.empty() ? "not finished within the time that this service may take" : late.message;
    late.message += bus_.inverters[running.inverter]->stop.pending() ? "; a stop is not confirmed yet" : "";
    bus_.scheduler.erase(id);
    end(id, late);
  }
}
}  // namespace bus
}  // namespace inverter_bus

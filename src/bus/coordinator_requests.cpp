// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>
#include <array>

#include "bus/coordinator.h"
#include "wire/shown.h"

// What users ask of the bus: velocities, stops and services.

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double GROUP_ERROR_SHOWN_S = 1.0;
// Inverters that the line about a refused group names; a group may have sixty that are all locked.
constexpr std::size_t MOST_NAMED = 4;

/// Contract, section 2: which id counts if several apply.
int rank(std::uint16_t error_id)
{
  constexpr std::array<std::uint16_t, 7> ORDER{ ERROR_SHUTTING_DOWN, ERROR_OUT_OF_RANGE, ERROR_NOT_OFFERED,
                                                ERROR_NOT_ARMED,     ERROR_OFFLINE,      ERROR_CANCELLED,
                                                ERROR_LOCKED };
  return static_cast<int>(std::find(ORDER.begin(), ORDER.end(), error_id) - ORDER.begin());
}

/// What a lock's error says more than its id, if anything.
std::string whyLocked(TimePoint now, const Inverter& inverter, const Publisher& publisher)
{
  if (inverter.interlock.isFaulted())
  {
    return lockedText(true);
  }
  return inverter.known() && !inverter.interlock.locked(now)
             ? "locked for " + wire::shown(publisher.name) +
                   ", which has neither sent 0 nor been silent since the last stop"
             : "";
}

/// Why the inverter takes no velocity of \p publisher now; 0: it does. \p why only where it says more than the id.
std::uint16_t obstacle(TimePoint now, const Inverter& inverter, const Publisher& publisher, std::string& why)
{
  // That it is the wrong drive says more than that it tells no status (the order of ids: contract, section 2).
  const bool wrong = inverter.settings.identity() == Identity::Wrong;
  if (inverter.offline() && !wrong)
  {
    return ERROR_OFFLINE;
  }
  if (!inverter.wrongDrive().empty())
  {
    why = inverter.wrongDrive();
    return wrong ? ERROR_NOT_ARMED : ERROR_LOCKED;
  }
  if (!inverter.known())
  {
    // Silence counts from the first status, not from a stop that was confirmed before it.
    why = whyLocked(now, inverter, publisher);
    return ERROR_LOCKED;
  }
  if (inverter.reset_active)
  {
    why = "a reset of the drive is under way";
    return ERROR_LOCKED;
  }
  if (inverter.inSetup())
  {
    why = "a parameter is being written in the drive's setup area";
    return ERROR_LOCKED;
  }
  if (inverter.stop.held())
  {
    return ERROR_CANCELLED;
  }
  switch (inverter.interlock.judge(now, publisher))
  {
    case Permission::Offline:
      return ERROR_OFFLINE;
    case Permission::StopPending:
      return ERROR_CANCELLED;
    case Permission::Locked:
      why = whyLocked(now, inverter, publisher);
      return ERROR_LOCKED;
    default:
      return 0;
  }
}

/// Why the parameter is not written like this, whatever the value; empty: nothing speaks against it.
std::string notOffered(const BusConfig& bus, const Inverter& inverter, const drive::Parameter& parameter, bool persist)
{
  const drive::Writes writes = inverter.drive.profile().writes;
  if (bus.parameters_read_only)
  {
    return "parameter_access is read_only";
  }
  if (parameter.read_only)
  {
    return parameter.name + " can't be written";
  }
  if (parameter.communication && !persist)
  {
    return parameter.name + " is a setting of the bus itself: it is written with persist only";
  }
  if (writes == drive::Writes::Eeprom && !persist)
  {
    return "on this drive every write reaches the EEPROM: call with persist = true";
  }
  if (persist && writes == drive::Writes::Ram && inverter.drive.sequence("store") == nullptr)
  {
    return "this drive can't store by a command";
  }
  if (!(parameter.while_running.value_or(true) && !parameter.setup) && inverter.mayRun())
  {
    return parameter.name + " can't be written while the motor runs";
  }
  return "";
}
}  // namespace

// --- velocity --------------------------------------------------------------------------------------------------------

std::uint16_t Coordinator::judgeOne(TimePoint now, std::size_t index, const Publisher& publisher,
                                    JudgedVelocity& judged) const
{
  const Inverter& inverter = *inverters_[index];
  if (judged.target.zero && judged.error_id == 0)
  {
    return 0;
  }
  if (shutting_down_)
  {
    judged.error_id = ERROR_SHUTTING_DOWN;
  }
  if (judged.error_id != 0)
  {
    judged.text = judged.text.empty() ? errorText(judged.error_id) : judged.text;
    return judged.error_id;
  }
  std::string why;
  judged.error_id = obstacle(now, inverter, publisher, why);
  judged.text = why.empty() && judged.error_id != 0 ? errorText(judged.error_id) : why;
  return judged.error_id;
}

bool Coordinator::stops(std::size_t index, double velocity) const
{
  return inverters_[index]->movement.range().stops(velocity);
}

/// One factor for all, the smallest that any of them needs: a vehicle that is too fast goes on in its direction.
double Coordinator::factorOf(const VelocityCommand& command) const
{
  double factor = 1.0;
  for (const auto& target : command.targets)
  {
    factor = std::min(factor, inverters_[target.first]->movement.range().factorFor(target.second));
  }
  return factor;
}

std::uint16_t Coordinator::judgeGroup(TimePoint now, const VelocityCommand& command,
                                      std::vector<JudgedVelocity>& judged, bool& repeat)
{
  std::uint16_t worst = 0;
  const double factor = factorOf(command);
  for (const auto& target : command.targets)
  {
    const Inverter& inverter = *inverters_[target.first];
    JudgedVelocity one = inverter.movement.judge(target.second, factor);
    const bool zero = one.error_id == 0 && one.target.zero;
    repeat = repeat || (!zero && inverter.interlock.judge(now, command.publisher) == Permission::Repeat);
    const std::uint16_t error_id = judgeOne(now, target.first, command.publisher, one);
    if (error_id != 0 && (worst == 0 || rank(error_id) < rank(worst)))
    {
      worst = error_id;
    }
    judged.push_back(one);
  }
  return worst;
}

std::uint16_t Coordinator::command(TimePoint now, const VelocityCommand& command)
{
  std::vector<JudgedVelocity> judged;
  bool repeat = false;
  const std::uint16_t error_id = judgeGroup(now, command, judged, repeat);
  if (repeat)
  {
    // An old message of a latched publisher is no command at all; only its zeros still stop what can be stopped.
    for (std::size_t position = 0; position < judged.size(); ++position)
    {
      if (judged[position].error_id == 0 && judged[position].target.zero)
      {
        applyVelocities(now, VelocityCommand{ { command.targets[position] }, command.publisher, false },
                        { judged[position] }, false);
      }
    }
    return 0;
  }
  applyVelocities(now, command, judged, error_id != 0);
  if (error_id == 0)
  {
    clearGroupError(now, command.grouped);
    return 0;
  }
  if (command.grouped)
  {
    noteGroupError(now, error_id);
  }
  tellRefusal(now, command, judged, error_id);
  return error_id;
}

/// In the status of every inverter of the command, and in the log.
void Coordinator::tellRefusal(TimePoint now, const VelocityCommand& command, const std::vector<JudgedVelocity>& judged,
                              std::uint16_t error_id)
{
  std::optional<std::size_t> culprit;
  std::string reasons;
  std::size_t named = 0;
  std::size_t refused = 0;
  for (std::size_t position = 0; position < judged.size(); ++position)
  {
    const auto& target = command.targets[position];
    const JudgedVelocity& one = judged[position];
    refused += one.error_id != 0 ? 1 : 0;
    if (one.error_id == error_id && named++ < MOST_NAMED)
    {
      culprit = culprit ? culprit : target.first;
      reasons += (reasons.empty() ? "" : "; ") + inverters_[target.first]->config.name + ": " +
                 refusedVelocity(target.second, one.error_id, one.text);
    }
  }
  for (std::size_t position = 0; position < judged.size(); ++position)
  {
    const auto& target = command.targets[position];
    const JudgedVelocity& one = judged[position];
    Inverter& inverter = *inverters_[target.first];
    one.error_id == error_id ? inverter.refuseCommand(error_id, one.text)
                             : inverter.refuseForOther(error_id, reasons, one.error_id, one.text);
    refusals_.notCommanded(target.first, one.error_id != 0 ? refusedVelocity(target.second, one.error_id, one.text)
                                                           : "the group was refused: " + reasons);
  }
  const std::size_t others = refused - std::min(named, MOST_NAMED);
  refusals_.refused(now, culprit, error_id,
                    (command.grouped ? "group refused: " : "refused: ") + reasons +
                        (others == 0 ? "" : "; and " + std::to_string(others) + " more of the group") + " (" +
                        errorIdText(error_id) + ")");
}

void Coordinator::noteGroupError(TimePoint now, std::uint16_t error_id)
{
  group_error_ = error_id;
  group_error_at_ = now;
}

/// Stays until the next accepted group; other accepted commands end it too, but not before it was seen.
void Coordinator::clearGroupError(TimePoint now, bool by_group)
{
  if (by_group || now - group_error_at_ > seconds(GROUP_ERROR_SHOWN_S))
  {
    group_error_ = 0;
  }
}

void Coordinator::applyVelocities(TimePoint now, const VelocityCommand& command,
                                  const std::vector<JudgedVelocity>& judged, bool refused)
{
  WaitingCommand waiting;
  waiting.kind = CommandKind::Velocity;
  for (std::size_t position = 0; position < judged.size(); ++position)
  {
    Inverter& inverter = *inverters_[command.targets[position].first];
    const JudgedVelocity& one = judged[position];
    bool moves = false;
    if (one.error_id == 0 && one.target.zero)
    {
      moves = applyZero(now, inverter, command.publisher, one.target);
      waiting.urgent = waiting.urgent || moves;
    }
    else if (refused)
    {
      inverter.interlock.commanded(now, command.publisher, false);
    }
    else
    {
      moves = applyMove(now, inverter, command.publisher, one.target);
    }
    if (moves)
    {
      // A unit that is under way goes on counting, whatever comes newly into it.
      inverter.velocity_frames = scheduler_->velocityWaits(inverter.index) ? inverter.velocity_frames : 0;
      waiting.inverters.push_back(inverter.index);
    }
  }
  const bool queued = waiting.inverters.size() == 1 && scheduler_->velocityWaits(waiting.inverters.front());
  if (queued)
  {
    scheduler_->makeUrgent(waiting.inverters.front(), waiting.urgent);
  }
  if (!queued && !waiting.inverters.empty())
  {
    std::sort(waiting.inverters.begin(), waiting.inverters.end());
    waiting.id = next_command_++;
    waiting.not_before = now;
    scheduler_->push(waiting);
  }
}

/// Never refused; returns true if a frame is needed.
bool Coordinator::applyZero(TimePoint now, Inverter& inverter, const Publisher& publisher, const Target& target)
{
  if (target.near_zero)
  {
    inverter.interlock.nearlyZeroed(now, publisher);
  }
  else
  {
    inverter.interlock.zeroed(now, publisher);
  }
  inverter.acceptCommand();
  inverter.velocityConfirmed();
  refusals_.accepted(inverter.index);
  if (inverter.stop.pending())
  {
    return false;
  }
  if (!inverter.movement.runPossible())
  {
    inverter.movement.drop();
    scheduler_->eraseVelocity(inverter.index);
    inverter.interlock.resting();
    return false;
  }
  if (zeroNeedsStop(now, inverter))
  {
    requestStop(now, inverter, StopMode::Decelerate, gateway_.motionUntil(now, inverter.index).has_value(), "");
    return false;
  }
  inverter.movement.aim(target);
  return inverter.movement.active();
}

bool Coordinator::applyMove(TimePoint now, Inverter& inverter, const Publisher& publisher, const Target& target)
{
  inverter.interlock.commanded(now, publisher, true);
  inverter.acceptCommand();
  refusals_.accepted(inverter.index);
  // Only the stop of a command of 0 can be pending here; the newer command takes its place.
  inverter.stop.cancel();
  inverter.movement.aim(target);
  return inverter.movement.active();
}

void Coordinator::refuse(TimePoint now, const std::vector<std::size_t>& indices, std::uint16_t error_id,
                         const std::string& text, bool group)
{
  for (const std::size_t index : indices)
  {
    inverters_[index]->refuseCommand(error_id, text);
    refusals_.notCommanded(index, text);
  }
  if (group)
  {
    noteGroupError(now, error_id);
    // The text holds what somebody has sent: a stream of groups, each wrong in another way, is one kind all the same.
    refusals_.refused(now, std::nullopt, error_id, "grouped command refused: " + text);
  }
}

// --- stop ------------------------------------------------------------------------------------------------------------

void Coordinator::requestStop(TimePoint now, Inverter& inverter, StopMode mode, bool lock, const std::string& reason)
{
  if (!reason.empty() && !inverter.interlock.stopPending())
  {
    log(Level::Warn, inverter.config.name + ": stopping: " + reason);
  }
  inverter.movement.drop();
  inverter.movement.forgetWords();
  scheduler_->eraseVelocity(inverter.index);
  inverter.stop.request(now, mode);
  if (!inverter.stop.pending())
  {
    return;
  }
  if (lock)
  {
    inverter.stop.hold();
    inverter.interlock.stopRequested();
  }
}

void Coordinator::stop(TimePoint now, std::optional<std::size_t> index, std::uint8_t mode, AnswerCallback callback)
{
  if (ended_)
  {
    // Nothing would ever confirm it: the caller would wait for nothing.
    refuseCall(callback, ERROR_SHUTTING_DOWN, errorText(ERROR_SHUTTING_DOWN));
    return;
  }
  StopCall call;
  call.callback = std::move(callback);
  call.expires = now + seconds(bounds().stop);
  const StopMode wanted =
      mode <= static_cast<std::uint8_t>(StopMode::Quick) ? static_cast<StopMode>(mode) : StopMode::Decelerate;
  bool fell_back = mode > static_cast<std::uint8_t>(StopMode::Quick);
  for (const auto& inverter : inverters_)
  {
    if (index && *index != inverter->index)
    {
      continue;
    }
    requestStop(now, *inverter, wanted, true, "");
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
    // Nobody waits for the others: a flood of them must not be kept.
    stop_calls_.push_back(std::move(call));
  }
  finishStopCalls(now);
}

/// Address 0 is executed by every drive, and the same register means something else on each brand.
bool Coordinator::broadcastIsSafe() const
{
  const drive::Drive& first = inverters_.front()->drive;
  const auto stop_frame = [](const drive::Drive& drive) {
    const drive::Sequence* stop = drive.sequence("stop");
    return stop == nullptr ? wire::Bytes()
                           : drive.broadcast(stop->steps.front().point, stop->steps.front().value.value_or(0)).pdu;
  };
  // Its answer could pass for a single stop's where a gateway does not keep numbers and units.
  return connected_ && inverters_.size() > 1 && !stop_frame(first).empty() && line_.gatewayQuirk().empty() &&
         std::all_of(inverters_.begin(), inverters_.end(), [&](const std::unique_ptr<Inverter>& inverter) {
           const drive::Profile& profile = inverter->drive.profile();
           return profile.name == first.profile().name && profile.broadcast_stop && !inverter->config.ownPort() &&
                  inverter->settings.identity() == Identity::Right && stop_frame(inverter->drive) == stop_frame(first);
         });
}

void Coordinator::finishStopCalls(TimePoint now)
{
  for (auto call = stop_calls_.begin(); call != stop_calls_.end();)
  {
    auto& waiting = call->waiting;
    waiting.erase(std::remove_if(waiting.begin(), waiting.end(),
                                 [&](std::size_t index) { return !inverters_[index]->stop.pending(); }),
                  waiting.end());
    if (!waiting.empty() && now < call->expires)
    {
      ++call;
      continue;
    }
    for (const std::size_t index : waiting)
    {
      call->problems.push_back(stopProblem(*inverters_[index]));
      const std::uint16_t error_id = inverters_[index]->stop.lastError();
      call->error_id = error_id != 0 ? error_id : wire::ERROR_TIMEOUT;
      call->error_id = connected_ ? call->error_id : wire::ERROR_PORT_LOST;
    }
    Answer reply;
    reply.success = call->problems.empty();
    reply.error_id = reply.success ? ERROR_NONE : call->error_id;
    reply.message = reply.success ? "stopped: RUN is confirmed off" : "not confirmed; the node goes on insisting";
    for (const std::string& problem : call->problems)
    {
      reply.message += "; " + problem;
    }
    reply.message += call->note.empty() ? "" : "; " + call->note;
    answer(call->callback, reply);
    call = stop_calls_.erase(call);
  }
}

std::string Coordinator::stopProblem(const Inverter& inverter) const
{
  const std::uint16_t error_id = inverter.stop.lastError();
  const std::string& name = inverter.config.name;
  if (!connected_)
  {
    return name + ": the port is gone";
  }
  if (error_id == 0)
  {
    return name + ": acknowledged, but RUN is still on";
  }
  return name + ": " + refusalText(inverter, error_id);
}

/// In the drive's own words where it has answered.
std::string Coordinator::refusalText(const Inverter& inverter, std::uint16_t error_id) const
{
  const std::string text = inverter.drive.exceptionText(error_id);
  return text.empty() ? errorText(error_id) : text;
}

/// A brand or model that the profile is not for: what it would do with these requests, nobody knows.
bool Coordinator::refuseWrongDrive(const Inverter& inverter, const AnswerCallback& callback)
{
  const bool wrong = inverter.settings.identity() == Identity::Wrong;
  const std::string why = inverter.offline() && !wrong ? "" : inverter.wrongDrive();
  if (!why.empty() && !shutting_down_)
  {
    refuseCall(callback, inverter.settings.identity() == Identity::Wrong ? ERROR_NOT_ARMED : ERROR_OFFLINE, why);
  }
  return !why.empty() && !shutting_down_;
}

void Coordinator::stopConfirmed(TimePoint now, Inverter& inverter)
{
  inverter.movement.stopped(now);
  inverter.settings.released();
  inverter.interlock.stopConfirmed(now);
  inverter.interlock.resting();
  finishStopCalls(now);
}

// --- services --------------------------------------------------------------------------------------------------------

ServiceBounds Coordinator::bounds() const
{
  ServiceBounds bounds;
  // Slow buses and long scan lists get more time; docs/commands.md states how much.
  const double exchange = toSeconds(budget_.longest_exchange);
  const double inverters = static_cast<double>(inverters_.size());
  bounds.stop = std::max(bounds.stop, 3.0 * exchange * inverters);
  bounds.reset = std::max(bounds.reset, 40.0 * exchange);
  for (const auto& inverter : inverters_)
  {
    bounds.reset = std::max(bounds.reset, 2.0 * inverter->drive.profile().deaf_after_reset + 2.0);
  }
  bounds.read_faults = std::max(bounds.read_faults, 80.0 * exchange);
  bounds.read_parameter = std::max(bounds.read_parameter, 2.0 * exchange * (inverters + 2.0));
  bounds.write_parameter = std::max(bounds.write_parameter, 20.0 * exchange);
  if (gateway_.active())
  {
    // A lost request of somebody else may keep the gateway before the first frame, and one of its own behind it.
    for (double* bound :
         { &bounds.stop, &bounds.reset, &bounds.read_faults, &bounds.read_parameter, &bounds.write_parameter })
    {
      *bound += 2.0 * configuration_.bus.gateway_timeout;
    }
  }
  return bounds;
}

void Coordinator::answer(const AnswerCallback& callback, const Answer& answer)
{
  if (callback)
  {
    answers_.emplace_back(callback, answer);
  }
}

void Coordinator::refuseCall(const AnswerCallback& callback, std::uint16_t error_id, const std::string& message)
{
  Answer refused;
  refused.error_id = error_id;
  refused.message = message;
  answer(callback, refused);
}

bool Coordinator::refuseJob(std::size_t index, const AnswerCallback& callback)
{
  const Inverter& inverter = *inverters_[index];
  if (shutting_down_)
  {
    refuseCall(callback, ERROR_SHUTTING_DOWN, errorText(ERROR_SHUTTING_DOWN));
    return true;
  }
  if (refuseWrongDrive(inverter, callback))
  {
    return true;
  }
  if (inverter.offline() || !inverter.known())
  {
    refuseCall(callback, ERROR_OFFLINE,
               inverter.offline() ? errorText(ERROR_OFFLINE) + ": " + inverter.offlineReason()
                                  : "the inverter has not answered yet");
    return true;
  }
  return false;
}

void Coordinator::startJob(TimePoint now, std::size_t index, std::unique_ptr<Job> job, double bound,
                           AnswerCallback callback)
{
  const CommandId id = next_command_++;
  RunningJob running;
  running.job = std::move(job);
  running.inverter = index;
  running.expires = now + seconds(bound);
  running.callbacks.push_back(std::move(callback));
  jobs_.emplace(id, std::move(running));
  queueJob(id, now);
}

void Coordinator::queueJob(CommandId id, TimePoint not_before)
{
  const RunningJob& running = jobs_.at(id);
  WaitingCommand waiting;
  waiting.id = id;
  waiting.kind = running.job->kind();
  waiting.inverters = { running.inverter };
  waiting.not_before = not_before;
  scheduler_->push(waiting);
}

void Coordinator::endJob(CommandId id, const Answer& result)
{
  const auto found = jobs_.find(id);
  if (found == jobs_.end())
  {
    return;
  }
  noteJobEnd(*inverters_[found->second.inverter], *found->second.job, result);
  if (found->second.job->kind() == CommandKind::Reset)
  {
    inverters_[found->second.inverter]->reset_active = false;
  }
  for (const AnswerCallback& callback : found->second.callbacks)
  {
    answer(callback, result);
  }
  jobs_.erase(found);
}

void Coordinator::failJobs(std::size_t index, std::uint16_t error_id, const std::string& message)
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
    scheduler_->erase(id);
    endJob(id, failed);
  }
}

/// A second reset behind the first would reset a motor that was started between the two.
bool Coordinator::joinReset(std::size_t index, const AnswerCallback& callback)
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

void Coordinator::reset(TimePoint now, std::size_t index, AnswerCallback callback)
{
  Inverter& inverter = *inverters_[index];
  if (!shutting_down_ && inverter.drive.sequence("reset") == nullptr)
  {
    const std::string missing = inverter.drive.missingFor("reset");
    refuseCall(callback, missing.empty() ? ERROR_NOT_OFFERED : ERROR_NOT_ARMED,
               missing.empty() ? "this drive has no fault reset"
                               : "fault reset is not armed: " + inverter.drive.armingAdvice("reset"));
    return;
  }
  if (!shutting_down_ && !inverter.drive.tellsRun() && inverter.drive.sequence("stop") == nullptr)
  {
    refuseCall(
        callback, ERROR_NOT_ARMED,
        "a reset needs a confirmed stop before it, and a stop is not armed: " + inverter.drive.armingAdvice("stop"));
    return;
  }
  if (refuseJob(index, callback) || joinReset(index, callback))
  {
    return;
  }
  const drive::Monitor& told = inverter.refresh.fresh();
  // Not told, or told in a word that nobody knows: what can't be ruled out is reset.
  if (!inverter.interlock.isFaulted() && !told.tripped().value_or(true))
  {
    Answer nothing;
    nothing.success = true;
    nothing.message = "no trip: nothing was sent";
    answer(callback, nothing);
    return;
  }
  inverter.reset_active = true;
  if (!inverter.drive.tellsRun())
  {
    requestStop(now, inverter, StopMode::Decelerate, true, "");
  }
  startJob(now, index, std::make_unique<ResetJob>(inverter.drive, inverter.config.node, told.unknown_trip),
           bounds().reset, std::move(callback));
}

void Coordinator::readFaults(TimePoint now, std::size_t index, AnswerCallback callback)
{
  Inverter& inverter = *inverters_[index];
  if (!shutting_down_ && inverter.drive.faultEntries() == 0)
  {
    refuseCall(callback, ERROR_NOT_OFFERED, "this drive has no trip memory that can be read");
    return;
  }
  if (refuseJob(index, callback))
  {
    return;
  }
  startJob(now, index,
           std::make_unique<ReadFaultsJob>(inverter.drive, inverter.config.node, inverter.interlock.isFaulted()),
           bounds().read_faults, std::move(callback));
}

void Coordinator::readParameter(TimePoint now, std::size_t index, const std::string& name, AnswerCallback callback)
{
  Inverter& inverter = *inverters_[index];
  const auto parameter = inverter.drive.findParameter(name, false);
  if (!shutting_down_ && !parameter)
  {
    refuseParameter(inverter, name, callback);
    return;
  }
  if (refuseJob(index, callback))
  {
    return;
  }
  startJob(now, index, std::make_unique<ReadParameterJob>(inverter.drive, inverter.config.node, *parameter),
           bounds().read_parameter, std::move(callback));
}

void Coordinator::refuseParameter(const Inverter& inverter, const std::string& name, const AnswerCallback& callback)
{
  const drive::Profile& profile = inverter.drive.profile();
  const std::string missing = inverter.drive.missingForParameter(name);
  if (!missing.empty())
  {
    const bool unknown = profile.parameters.at(name).item.missing;
    refuseCall(callback, ERROR_NOT_ARMED,
               "parameter '" + name +
                   (unknown ? "': nobody knows its register: give it under overrides (parameters: {" + name +
                                  ": {register: ...}})"
                            : "' is unconfirmed: confirm '" + missing + "'"));
    return;
  }
  const bool any = std::any_of(profile.parameters.begin(), profile.parameters.end(),
                               [](const auto& entry) { return entry.second.item.unconfirmed.empty(); });
  if (!any)
  {
    refuseCall(callback, ERROR_NOT_ARMED,
               "the profile " + profile.name + " knows no parameter's place: give '" + wire::shown(name) +
                   "' under overrides");
    return;
  }
  refuseCall(callback, ERROR_OUT_OF_RANGE,
             "'" + wire::shown(name) + "' is no parameter of " + profile.name +
                 "; use the drive's own code, or 0x and the number printed in its manual");
}

/// The reasons that need no drive to refuse a write; 0: none.
std::uint16_t Coordinator::judgeWrite(const Inverter& inverter, const std::string& name, double value, bool persist,
                                      std::string& why, std::uint32_t& raw) const
{
  const drive::Profile& profile = inverter.drive.profile();
  const auto known = profile.parameters.find(name);
  const auto parameter = inverter.drive.findParameter(name, true);
  if (known == profile.parameters.end())
  {
    why = "'" + wire::shown(name) + "' is no parameter of " + profile.name + " that can be written";
    return ERROR_OUT_OF_RANGE;
  }
  if (parameter)
  {
    const drive::Encoded encoded = inverter.drive.encodeParameter(*parameter, value);
    raw = encoded.raw;
    if (!encoded.ok)
    {
      why = encoded.error;
      return ERROR_OUT_OF_RANGE;
    }
  }
  why = notOffered(configuration_.bus, inverter, known->second, persist);
  if (!why.empty())
  {
    return ERROR_NOT_OFFERED;
  }
  for (const char* sequence : { "open_setup", "close_setup" })
  {
    if (known->second.setup && inverter.drive.sequence(sequence) == nullptr)
    {
      why = name + " is taken in the drive's setup area only, and the way there is not armed: " +
            inverter.drive.armingAdvice(sequence);
      return ERROR_NOT_ARMED;
    }
  }
  if (!parameter)
  {
    why = name + (known->second.item.missing
                      ? ": nobody knows its place: give it under overrides"
                      : " is unconfirmed: confirm '" + inverter.drive.missingForParameter(name) + "'");
    return ERROR_NOT_ARMED;
  }
  if (persist && profile.writes == drive::Writes::Unknown)
  {
    why = "the drive's manual does not say whether a write outlives a power-off: call with persist = false";
    return ERROR_NOT_OFFERED;
  }
  return 0;
}

void Coordinator::writeParameter(TimePoint now, std::size_t index, const std::string& name, double value, bool persist,
                                 AnswerCallback callback)
{
  Inverter& inverter = *inverters_[index];
  std::string why;
  std::uint32_t raw = 0;
  const std::uint16_t error_id = judgeWrite(inverter, name, value, persist, why, raw);
  if (!shutting_down_ && error_id != 0)
  {
    refuseCall(callback, error_id, why);
    return;
  }
  if (refuseJob(index, callback))
  {
    return;
  }
  startJob(now, index,
           std::make_unique<WriteParameterJob>(inverter.drive, inverter.config.node,
                                               *inverter.drive.findParameter(name, true), raw, persist,
                                               inverter.ram_changes),
           bounds().write_parameter, std::move(callback));
}
}  // namespace bus
}  // namespace inverter_bus

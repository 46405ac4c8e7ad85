// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>

#include "bus/coordinator.h"

// What follows from the end of an exchange.

namespace inverter_bus
{
namespace bus
{
namespace
{
// A velocity unit that newer and newer targets keep going before it is complete makes room for others after so many frames
// per inverter.
constexpr unsigned MOST_FRAMES_PER_UNIT = 4;
// A port that has stayed open for so long works, though nobody answers: even a lone dead inverter was probed meanwhile.
constexpr double PORT_WORKS_AFTER_S = 3.0;

/// What the end of an exchange shows of the inverter's link. \p missed: without an answer it counts against its liveness.
void noteAnswer(Inverter& inverter, const wire::Reply& reply, bool missed)
{
  if (isAnswered(reply))
  {
    inverter.answered(reply);
  }
  else if (missed)
  {
    inverter.liveness.missed(reply.error_id);
  }
}

/// What it shows of the drive's loop-back. \p resync: the loop-back went before a request that waits.
void noteLoopback(Inverter& inverter, const wire::Reply& reply, bool loopback, bool resync)
{
  // A probe that nobody answers says nothing of the loop-back: the drive is away.
  if (loopback && (resync || isAnswered(reply)))
  {
    inverter.loopback.note(reply.outcome);
  }
  else if (!loopback && isAnswered(reply))
  {
    inverter.loopback.otherAnswered();
  }
}
}  // namespace

/// Lost or damaged: is it to be repeated?
bool Coordinator::repeat(int& tries, const wire::Reply& reply) const
{
  // A gateway that says that the drive is silent has tried itself.
  if (isAnswered(reply) || reply.gateway_code != 0)
  {
    tries = 0;
    return false;
  }
  if (++tries <= configuration_.bus.retries)
  {
    return true;
  }
  tries = 0;
  return false;
}

void Coordinator::done(const wire::Reply& reply)
{
  noteRunning(reply.finished_at);
  if (!current_)
  {
    return;
  }
  const Current current = *current_;
  current_.reset();
  // Before the end of the connection is booked: what was under way then may still be carried out.
  noteGateway(current, reply);
  if (reply.outcome != wire::Outcome::PortLost)
  {
    ended(current, reply);
    return;
  }
  if (!resumes(reply.finished_at, current.inverter))
  {
    portLost(reply.finished_at);
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
void Coordinator::ended(const Current& current, const wire::Reply& reply)
{
  if (reply.outcome != wire::Outcome::Timeout || reply.finished_at - opened_at_ > seconds(PORT_WORKS_AFTER_S))
  {
    portWorks();
  }
  last_error_ = reply.outcome == wire::Outcome::Ok ? std::uint16_t{ 0 } : reply.error_id;
  if (current.purpose == Purpose::Broadcast)
  {
    meter_.exchange(reply.sent_at, reply.finished_at, Duration{ 0 });
    return;
  }
  Inverter& inverter = *inverters_[current.inverter];
  inverter.noteExchange(reply);
  if (current.request.expects_reply)
  {
    inverter.record.note(reply);
    noteLink(reply);
    noteConnection(reply.finished_at, current, reply);
  }
  inverter.noteCost(current.pick.probe, reply.outcome, probePrice(current, reply));
  if (current.request.expects_reply)
  {
    noteAnswer(inverter, reply, !behind_another_ && (current.purpose != Purpose::Refresh || current.resync));
  }
  noteLoopback(inverter, reply, current.loopback, current.resync);
  // A loop-back that is refused has put nothing into step: to a stop that is a failed attempt.
  const bool refused_stop = current.purpose == Purpose::StopFrame && reply.outcome == wire::Outcome::Exception;
  if (current.resync && isAnswered(reply) && !refused_stop)
  {
    // The line is in step again: the real request keeps its turn.
    finishExchange(current, reply, true);
    return;
  }
  switch (current.purpose)
  {
    case Purpose::StopFrame:
      doneStop(current, reply);
      break;
    case Purpose::Velocity:
      doneVelocity(current, reply);
      break;
    case Purpose::Job:
      doneJob(current, reply);
      break;
    case Purpose::Refresh:
      doneRefresh(current, reply);
      break;
    case Purpose::KeepAlive:
      doneKeepAlive(current, reply);
      break;
    case Purpose::Setting:
      doneSetting(current, reply);
      break;
    default:
      inverter.noteProbed(reply);
      finishExchange(current, reply, false);
      break;
  }
}

void Coordinator::finishExchange(const Current& current, const wire::Reply& reply, bool more)
{
  Duration cost{ 0 };
  if (current.purpose == Purpose::Refresh && isAnswered(reply))
  {
    cost = line_.cost(current.request, Duration{ 0 });
  }
  meter_.exchange(reply.sent_at, reply.finished_at, cost);
  if (shutting_down_)
  {
    return;
  }
  scheduler_->done(current.pick, countedFrom(reply), reply.finished_at, more, isAnswered(reply));
  if (current.pick.probe && reply.outcome != wire::Outcome::Ok)
  {
    scheduler_->chargeProbe(reply.finished_at, probePrice(current, reply));
  }
}

void Coordinator::noteLost(TimePoint now, Inverter& inverter, std::uint16_t error_id)
{
  // Behind an older request that the gateway still works on it says nothing of this inverter (contract, 8.16).
  if (!behind_another_ && inverter.failed(now, error_id))
  {
    wentOffline(now, inverter);
    return;
  }
  failTrial(now, inverter, error_id);
}

/// It answers, but not what counts.
void Coordinator::noteRefusal(TimePoint now, Inverter& inverter, std::uint16_t error_id)
{
  if (inverter.refusedStatus(error_id))
  {
    wentOffline(now, inverter);
    return;
  }
  failTrial(now, inverter, error_id);
}

/// An offline inverter that has answered has shown no status after all: what that has cost is paid by the probes.
void Coordinator::failTrial(TimePoint now, Inverter& inverter, std::uint16_t error_id)
{
  if (inverter.onTrial() && !shutting_down_)
  {
    scheduler_->chargeProbe(now, inverter.endTrial(error_id));
  }
}

/// A lost write says little: a read is to show soon whether the drive is away, or loses writes only.
void Coordinator::noteLostWrite(TimePoint now, Inverter& inverter, std::uint16_t error_id)
{
  if (!behind_another_ && inverter.failed(now, error_id, true))
  {
    wentOffline(now, inverter);
    return;
  }
  failTrial(now, inverter, error_id);
  if (!inverter.offline() && inverter.liveness.needsRead())
  {
    scheduler_->readSoon(inverter.index);
  }
}

void Coordinator::wentOffline(TimePoint now, Inverter& inverter)
{
  scheduler_->eraseVelocity(inverter.index);
  failJobs(inverter.index, ERROR_OFFLINE, errorText(ERROR_OFFLINE) + ": " + inverter.offlineReason());
  if (connected_)
  {
    log(Level::Error, inverter.config.name + ": offline: " + inverter.offlineReason(), inverter.config.name);
    outputs_.traces.push_back(inverter.config.name + " went offline");
  }
  if (inverter.movement.runPossible())
  {
    requestStop(now, inverter, StopMode::Decelerate, true, "it may still run while it can't be reached");
  }
  publish(now, inverter);
}

void Coordinator::doneKeepAlive(const Current& current, const wire::Reply& reply)
{
  Inverter& inverter = *inverters_[current.inverter];
  // One that is lost gives the turn away.
  finishExchange(current, reply, isAnswered(reply));
  if (reply.outcome == wire::Outcome::Ok)
  {
    inverter.liveness.dataRead();
  }
  if (!isAnswered(reply))
  {
    noteLost(reply.finished_at, inverter, reply.error_id);
  }
}

// --- stop ------------------------------------------------------------------------------------------------------------

void Coordinator::doneStop(const Current& current, const wire::Reply& reply)
{
  Inverter& inverter = *inverters_[current.inverter];
  finishExchange(current, reply, false);
  if (!inverter.stop.pending())
  {
    // A fresh command took the place of a stop by 0 while its frame was on the wire: write all words anew.
    inverter.movement.forgetWords();
    return;
  }
  const bool write = !current.resync && !inverter.stop.written();
  if (reply.connection_closed && !inverter.offline() && !connection_.closedAgain(current.inverter))
  {
    // It counts no try: the same frame goes first over the next connection. Closed again in its place, it is its station
    // that is silent.
    noteLostStop(reply.finished_at, inverter, write, reply.error_id);
    return;
  }
  if (gateway_.active() && isAnswered(reply))
  {
    const auto latency = inverter.stop.answered(reply.finished_at);
    if (latency && !current.pick.probe)
    {
      noteStopLatency(*latency);
    }
  }
  if (write && gateway_.motionUntil(reply.sent_at, current.inverter))
  {
    inverter.stop.writeOnceMore();
    inverter.interlock.stopRequested();
    return;
  }
  const StopJob::Progress progress = inverter.stop.done(reply, current.may_be_late);
  if (write && reply.outcome == wire::Outcome::Ok && !current.may_be_late)
  {
    inverter.lost_writes.acknowledged();
  }
  if (!write && !current.resync && reply.outcome == wire::Outcome::Ok)
  {
    inverter.liveness.dataRead();
  }
  if (progress == StopJob::Progress::Confirmed)
  {
    stopConfirmed(reply.finished_at, inverter);
  }
  if (isAnswered(reply))
  {
    if (reply.outcome == wire::Outcome::Exception)
    {
      // An offline inverter's stop is its probe, however politely it is refused.
      failTrial(reply.finished_at, inverter, reply.error_id);
    }
    return;
  }
  noteLostStop(reply.finished_at, inverter, write, reply.error_id);
  if (write && !behind_another_ && inverter.lost_writes.lost() && !inverter.offline())
  {
    writesLost(reply.finished_at, inverter);
  }
}

/// A frame of a stop that nobody answered: a write, or a read of what became of it.
void Coordinator::noteLostStop(TimePoint now, Inverter& inverter, bool write, std::uint16_t error_id)
{
  if (write)
  {
    noteLostWrite(now, inverter, error_id);
  }
  else
  {
    noteLost(now, inverter, error_id);
  }
}

// --- velocity --------------------------------------------------------------------------------------------------------

void Coordinator::doneVelocity(const Current& current, const wire::Reply& reply)
{
  Inverter& inverter = *inverters_[current.inverter];
  const TimePoint now = reply.finished_at;
  const bool cancelled = !scheduler_->velocityWaits(current.inverter);
  noteBlockRefusal(current, reply);
  if (reply.outcome == wire::Outcome::Ok && !cancelled)
  {
    inverter.movement.confirmed(current.write, now);
    if (current.write.starts)
    {
      inverter.settings.commanded();
    }
    inverter.lost_writes.acknowledged();
    ++inverter.velocity_frames;
    finishVelocity(current, reply);
    return;
  }
  if (!current.resync)
  {
    // A loop-back that went in its place has changed nothing: what was in force still is, and is not sent anew.
    inverter.movement.doubtful(current.write, now);
  }
  const bool lost = !isAnswered(reply);
  // A loop-back that was lost writes nothing.
  const bool too_many = lost && !current.resync && !behind_another_ && inverter.lost_writes.lost();
  // A gateway that says so itself has tried already.
  const bool again = lost && inverter.lost_writes.tryAgain() && !too_many && reply.gateway_code == 0;
  if (again && !cancelled)
  {
    // The other members of a group go on without it.
    scheduler_->splitOff(current.pick.command, current.inverter, next_command_++, now,
                         inverter.movement.target() && inverter.movement.target()->zero);
    finishExchange(current, reply, true);
    return;
  }
  scheduler_->eraseVelocity(current.inverter);
  finishExchange(current, reply, !scheduler_->members(current.pick.command).empty());
  if (reply.outcome == wire::Outcome::Ok)
  {
    return;
  }
  inverter.lost_writes.velocityEnded();
  if (lost)
  {
    noteLostWrite(now, inverter, reply.error_id);
  }
  if (!cancelled)
  {
    failVelocity(current, reply, too_many);
  }
}

/// It is not sent again.
void Coordinator::failVelocity(const Current& current, const wire::Reply& reply, bool too_many_lost)
{
  Inverter& inverter = *inverters_[current.inverter];
  if (inverter.offline())
  {
    return;
  }
  const bool zero = inverter.movement.target() && inverter.movement.target()->zero;
  inverter.velocityFailed(reply.error_id, refusalText(inverter, reply.error_id));
  inverter.movement.giveUp();
  if (!isAnswered(reply) && (too_many_lost || inverter.movement.runPossible()))
  {
    writesLost(reply.finished_at, inverter);
    return;
  }
  if (!inverter.movement.runPossible())
  {
    inverter.interlock.resting();
  }
  if (zero || current.write.starts)
  {
    // Nobody knows whether the motor runs: it shall not.
    requestStop(reply.finished_at, inverter, StopMode::Decelerate, false, "");
  }
  if (current.write.starts)
  {
    inverter.stop.hold();
  }
}

/// Contract, 8.1: what can't be written to can't be commanded, however well it answers reads.
void Coordinator::writesLost(TimePoint now, Inverter& inverter)
{
  const std::string text = inverter.lost_writes.text();
  const bool news = !inverter.lost_writes.raised();
  if (news)
  {
    log(Level::Error, inverter.config.name + ": stopping and locking: " + text);
  }
  inverter.lost_writes.raise();
  inverter.velocityFailed(wire::ERROR_TIMEOUT, text);
  requestStop(now, inverter, StopMode::Decelerate, true, "");
  if (news && inverter.known())
  {
    publish(now, inverter);
  }
}

/// What reaches the drive's EEPROM wears it, answered or not, and each repeat again.
void Coordinator::countWear(const Current& current)
{
  if (current.purpose == Purpose::Broadcast)
  {
    return;
  }
  Inverter& inverter = *inverters_[current.inverter];
  const auto job = jobs_.find(current.job);
  const bool parameter = current.purpose == Purpose::Job && job != jobs_.end() &&
                         job->second.job->kind() == CommandKind::WriteParameter &&
                         inverter.drive.profile().writes == drive::Writes::Eeprom;
  const bool set_point = current.purpose == Purpose::Velocity && inverter.drive.wears(current.write.point) &&
                         !inverter.settings.connected();
  if (parameter || set_point)
  {
    inverter.noteEepromWrite();
  }
}

/// A drive that can't carry out a block write (slots empty or not in effect) gets its words one by one from the next
/// command on; this one is refused like any other, since nobody knows what the drive took of it.
void Coordinator::noteBlockRefusal(const Current& current, const wire::Reply& reply)
{
  constexpr std::uint8_t CANNOT_BE_EXECUTED = 0x04;
  const bool refused = reply.outcome == wire::Outcome::Exception && !current.write.more.empty();
  if (refused && (reply.error_id & 0xFFU) == CANNOT_BE_EXECUTED)
  {
    Inverter& inverter = *inverters_[current.inverter];
    inverter.dropBlock("the drive refuses the block write (" + inverter.drive.exceptionText(reply.error_id) + ")");
  }
}

void Coordinator::finishVelocity(const Current& current, const wire::Reply& reply)
{
  Inverter& inverter = *inverters_[current.inverter];
  const bool complete = !inverter.movement.next();
  // A newer target has come during its last frame: it has its own place in the order (contract, 3.6 and 8.1).
  const bool over = current.write.last || inverter.velocity_frames >= MOST_FRAMES_PER_UNIT;
  if (complete)
  {
    inverter.velocityConfirmed();
  }
  if (complete || over)
  {
    scheduler_->eraseVelocity(current.inverter);
  }
  finishExchange(current, reply, !scheduler_->members(current.pick.command).empty());
  if (!complete && over)
  {
    inverter.velocity_frames = 0;
    WaitingCommand waiting;
    waiting.id = next_command_++;
    waiting.inverters = { inverter.index };
    waiting.not_before = reply.finished_at;
    scheduler_->push(waiting);
  }
  if (complete && inverter.movement.zeroUnverified() && !inverter.drive.runBlock())
  {
    inverter.movement.stopped(reply.finished_at);
    inverter.interlock.resting();
  }
}

// --- services --------------------------------------------------------------------------------------------------------

void Coordinator::doneJob(const Current& current, const wire::Reply& reply)
{
  const auto found = jobs_.find(current.job);
  if (found == jobs_.end())
  {
    // Its bound passed, or the inverter went offline, while the frame was on the wire.
    finishExchange(current, reply, false);
    return;
  }
  RunningJob& running = found->second;
  Inverter& inverter = *inverters_[current.inverter];
  const bool reads =
      running.job->kind() == CommandKind::ReadParameter || running.job->kind() == CommandKind::ReadFaults;
  // What was under way when the connection was closed may have been carried out (contract, 8.9).
  const bool once = reply.connection_closed && !reads;
  if (!once && repeat(running.tries, reply))
  {
    finishExchange(current, reply, true);
    return;
  }
  if (reads && reply.outcome == wire::Outcome::Ok)
  {
    inverter.liveness.dataRead();
  }
  const Job::Progress progress = isAnswered(reply) ? running.job->done(reply) : running.job->lost(reply);
  if (isAnswered(reply))
  {
    inverter.noDeafness();
  }
  doneStep(reply.finished_at, current);
  finishExchange(current, reply, false);
  advanceJob(reply.finished_at, current.job, progress);
  if (!isAnswered(reply))
  {
    noteLost(reply.finished_at, inverter, reply.error_id);
  }
}

/// What follows from the frame of a job, whatever its answer: a drive that starts anew.
void Coordinator::doneStep(TimePoint now, const Current& current)
{
  Inverter& inverter = *inverters_[current.inverter];
  const RunningJob& running = jobs_.at(current.job);
  if (!current.request.expects_reply)
  {
    // It executes without a reply and is deaf for a while: neither a time-out nor an offline drive.
    inverter.refresh_not_before = now + running.job->pause();
  }
}

/// However a job ends: what it may have changed in the drive is looked at again.
void Coordinator::noteJobEnd(Inverter& inverter, const Job& job, const Answer& result)
{
  if (const auto* write = dynamic_cast<const WriteParameterJob*>(&job))
  {
    inverter.parameterWritten(write->parameter().name);
    inverter.setup_open = false;
    if (write->inSetup())
    {
      inverter.settings.leaveSetup();
    }
    if (write->parameter().setup)
    {
      // Leaving the setup area may have made the drive forget what it was told at connect.
      inverter.settings.connectAgain();
    }
  }
  const auto* reset = dynamic_cast<const ResetJob*>(&job);
  if (reset != nullptr && reset->resetting())
  {
    inverter.settings.connectAgain();
  }
  if (dynamic_cast<const ConfigureBlockJob*>(&job) != nullptr)
  {
    log(result.success ? Level::Ok : Level::Warn, inverter.config.name + ": configure_block: " + result.message);
    inverter.settings.restart();
  }
}

void Coordinator::advanceJob(TimePoint now, CommandId id, Job::Progress progress)
{
  RunningJob& running = jobs_.at(id);
  Inverter& inverter = *inverters_[running.inverter];
  auto* reset = dynamic_cast<ResetJob*>(running.job.get());
  if (reset != nullptr && reset->resetting())
  {
    // Resetting clears the drive's words, and it may be deaf for a while.
    if (reset->takeDeafening())
    {
      inverter.expectSilence(now, seconds(inverter.drive.profile().deaf_after_reset));
    }
    inverter.movement.forgetWords();
  }
  if (progress == Job::Progress::Done)
  {
    endJob(id, Answer(running.job->answer()));
    return;
  }
  if (progress == Job::Progress::NeedsStop)
  {
    requestStop(now, inverter, StopMode::Decelerate, true, "RUN must be off before the trip is reset");
  }
  queueJob(id, now + running.job->pause());
}

// --- refresh ---------------------------------------------------------------------------------------------------------

void Coordinator::doneRefresh(const Current& current, const wire::Reply& reply)
{
  Inverter& inverter = *inverters_[current.inverter];
  // What waited in a gateway behind an older request says nothing of this inverter.
  const bool says_nothing = behind_another_ && !isAnswered(reply);
  if (!current.resync && !says_nothing)
  {
    inverter.liveness.noteRead(line_.cost(current.request, Duration{ 0 }), reply);
  }
  if (isAnswered(reply))
  {
    inverter.refresh_tries = 0;
    if (reply.outcome == wire::Outcome::Ok)
    {
      inverter.liveness.dataRead();
    }
    const bool more =
        reply.outcome == wire::Outcome::Ok ? inverter.refresh.received(reply) : inverter.refresh.refused(reply);
    if (reply.outcome == wire::Outcome::Ok && inverter.lost_writes.readAnswered())
    {
      log(Level::Error, inverter.config.name + ": stopped and locked: " + inverter.lost_writes.text());
    }
    finishExchange(current, reply, more);
    inverter.noteStatus(reply, more);
    if (more)
    {
      actOn(reply.finished_at, inverter, inverter.judgeWords(reply.finished_at));
    }
    if (inverter.refresh.takeComplete())
    {
      judgeRefresh(reply.finished_at, inverter);
    }
    else if (!more)
    {
      refusedStatus(reply, inverter);
    }
    return;
  }
  // One that has lost as many writes as make a drive offline is not asked twice.
  const bool decided = inverter.offline() || inverter.liveness.needsRead();
  if (!decided && repeat(inverter.refresh_tries, reply))
  {
    finishExchange(current, reply, true);
    return;
  }
  inverter.refresh.failed();
  finishExchange(current, reply, false);
  const bool was_offline = inverter.offline();
  noteLost(reply.finished_at, inverter, reply.error_id);
  if (!was_offline && !inverter.offline() && inverter.known())
  {
    // Shows the error beside the last good values, which keep their stamp.
    publish(reply.finished_at, inverter);
  }
}

/// It answers, but refuses to tell: the last good values keep their stamp.
void Coordinator::refusedStatus(const wire::Reply& reply, Inverter& inverter)
{
  if (inverter.refresh.takeRefusal() || inverter.offline())
  {
    noteRefusal(reply.finished_at, inverter, reply.error_id);
  }
  if (!inverter.offline() && inverter.known())
  {
    inverter.noteExchangeError(reply.error_id);
    publish(reply.finished_at, inverter);
  }
}

void Coordinator::judgeRefresh(TimePoint now, Inverter& inverter)
{
  if (!inverter.known())
  {
    log(Level::Ok, inverter.config.name + ": " + inverter.onlineText(), inverter.config.name);
  }
  const Judgement judgement = inverter.judge(now);
  if (judgement.tripped)
  {
    log(Level::Error, inverter.config.name + ": tripped: " + judgement.trip_text);
    outputs_.traces.push_back(inverter.config.name + " tripped");
  }
  actOn(now, inverter, judgement);
  publish(now, inverter);
}

void Coordinator::actOn(TimePoint now, Inverter& inverter, const Judgement& judgement)
{
  if (!judgement.stop_reason.empty())
  {
    requestStop(now, inverter, StopMode::Decelerate, true, judgement.stop_reason);
  }
  else if (judgement.zero_failed)
  {
    requestStop(now, inverter, StopMode::Decelerate, false, "");
  }
}

void Coordinator::doneSetting(const Current& current, const wire::Reply& reply)
{
  Inverter& inverter = *inverters_[current.inverter];
  if (isAnswered(reply))
  {
    inverter.settings_tries = 0;
    inverter.settled(reply.finished_at, reply);
    // Before a status it took the refresh's turn, and gives it back.
    finishExchange(current, reply, current.pick.what == Pick::What::Refresh);
    configureBlock(reply.finished_at, inverter);
    return;
  }
  inverter.settled(reply.finished_at, reply);
  const bool again = !inverter.offline() && repeat(inverter.settings_tries, reply);
  finishExchange(current, reply, false);
  if (!again)
  {
    noteLost(reply.finished_at, inverter, reply.error_id);
  }
}

void Coordinator::configureBlock(TimePoint now, Inverter& inverter)
{
  const auto wanted =
      shutting_down_ ? std::vector<std::pair<std::string, std::uint32_t>>() : inverter.blockToConfigure();
  if (wanted.empty())
  {
    return;
  }
  log(Level::Warn, inverter.config.name + ": configure_block: writing " + std::to_string(wanted.size()) +
                       " parameters to the drive's EEPROM, once");
  startJob(now, inverter.index, std::make_unique<ConfigureBlockJob>(inverter.drive, inverter.config.node, wanted),
           bounds().write_parameter, AnswerCallback());
}

// --- port and second masters -----------------------------------------------------------------------------------------

void Coordinator::lateReply(TimePoint now, const wire::LateReply& late)
{
  link_.answered();
  const auto request = gateway_.answeredLate(now, late.ticket);
  if (request && request->risk == GatewayRisk::None)
  {
    othersFirst(now, *inverters_[request->inverter]);
  }
  const bool alone = !gateway_.active() || (request && request->alone);
  if (request && request->alone && request->probe)
  {
    scheduler_->chargeProbe(now, gateway_.block());
  }
  if (request && request->risk == GatewayRisk::Stop)
  {
    const auto latency = inverters_[request->inverter]->stop.answered(now);
    noteStopLatency(latency.value_or(Duration::zero()));
  }
  for (const auto& inverter : inverters_)
  {
    if (inverter->config.node != late.station || late.gateway_code != 0)
    {
      continue;
    }
    if (late.delay && alone)
    {
      inverter->lateReply(*late.delay);
    }
    // A probe that was given up early: worth asking for the status, at the probes' cost.
    inverter->beginTrial(late.delay.value_or(Duration::zero()));
  }
}

void Coordinator::noteLine(TimePoint now, const wire::LineCounters& counters, bool echo_found)
{
  if (counters.foreign_frames != counters_.foreign_frames)
  {
    foreign_at_ = now;
  }
  counters_ = counters;
  echo_found_ = echo_found;
}

void Coordinator::noteAdapter(const std::optional<wire::AdapterLatency>& latency)
{
  adapter_.note(latency);
}

void Coordinator::portOpened(TimePoint now)
{
  connected_ = true;
  opened_at_ = now;
  port_works_ = false;
  if (ever_opened_)
  {
    ++reconnects_;
  }
  ever_opened_ = true;
  link_.opened(now);
  telnet_ = false;
  last_unanswered_.reset();
  const bool same = connection_.resuming() || renewing_;
  renewing_ = false;
  // Connections that are closed again and again must not be a way around the probes' share (contract, 8.9).
  scheduler_->restartCycle(now, !same && connection_.closedUnused() == 0);
  connection_.opened(now, onlineInverters());
  if (!port_failing_ && !same)
  {
    port_complained_ = false;
    port_error_.clear();
    last_error_ = 0;
    log(Level::Ok, "port " + configuration_.bus.port + " is open", PORT);
  }
  for (const auto& inverter : inverters_)
  {
    inverter->refresh_not_before = now;
    attempts_at_open_[inverter->index] = inverter->stop.attempts();
    if (!inverter->known())
    {
      inverter->liveness.watchFrom(now);
    }
  }
}

/// Something was read from it, or it has been open for long: an adapter with I/O errors opens too.
void Coordinator::portWorks()
{
  port_works_ = true;
  if (port_failing_)
  {
    port_failing_ = false;
    port_complained_ = false;
    port_error_.clear();
    log(Level::Ok, "port " + configuration_.bus.port + " works again", PORT);
  }
}

void Coordinator::portMissing(TimePoint now, const std::string& error, bool in_use)
{
  if (connection_.resuming() && connection_.notOpen(now) == ConnectionWatch::Verdict::Resume)
  {
    return;
  }
  const bool news = connected_ || !port_complained_;
  connected_ = false;
  renewing_ = false;
  last_error_ = wire::ERROR_PORT_LOST;
  port_failing_ = false;
  port_error_ = error;
  if (news)
  {
    // Also when it was told of before: what was there over a connection since is gone now.
    port_complained_ = true;
    log(in_use ? Level::Warn : Level::Error,
        error + (in_use ? "; trying again for a while" : "; the node keeps trying"), PORT);
    portLost(now);
  }
}

void Coordinator::portLost(TimePoint now)
{
  const std::string& port = configuration_.bus.port;
  const bool unused = !port_works_;
  if (unused && configuration_.bus.gateway)
  {
    const std::string words = line_.peerWords();
    portFails(now, "port " + port + " is closed by its other end as soon as it is open" +
                       (words.empty() ? "" : ", which says '" + words + "'") +
                       ": another client may hold it, or it serves another protocol mode");
    return;
  }
  portFails(now, "port " + port +
                     (unused                       ? " can be opened, but fails in use: see dmesg, check the adapter"
                      : configuration_.bus.gateway ? " is gone"
                                                   : " is gone: plug it in"));
}

/// \p error says what is wrong with it, once.
void Coordinator::portFails(TimePoint now, const std::string& error)
{
  current_.reset();
  connection_.lost();
  gateway_.connectionEnded(now);
  if (connected_ && !(port_failing_ && port_error_ == error))
  {
    port_failing_ = !port_works_ || line_.telnetFound();
    port_error_ = error;
    log(Level::Error, port_error_ + "; the node keeps trying", PORT);
    port_complained_ = true;
  }
  connected_ = false;
  last_error_ = wire::ERROR_PORT_LOST;
  broadcast_due_ = false;
  loseEverybody(now, wire::ERROR_PORT_LOST);
}

// --- shutdown --------------------------------------------------------------------------------------------------------

void Coordinator::beginShutdown(TimePoint now)
{
  shutting_down_ = true;
  const double two_exchanges_each = 2.0 * toSeconds(budget_.longest_exchange) * static_cast<double>(inverters_.size());
  // Never over 10 s (contract, 4.4), the exchange that is under way then included.
  const double longest = std::max(2.0, 9.9 - toSeconds(budget_.longest_exchange));
  double needed = std::max(2.0, two_exchanges_each);
  for (const auto& inverter : inverters_)
  {
    // A stop that an old RUN in a gateway could follow counts only after it (contract, 8.8).
    const auto danger = gateway_.motionUntil(now, inverter->index);
    needed = danger ? std::max(needed, toSeconds(*danger - now) + two_exchanges_each) : needed;
  }
  shutdown_deadline_ = now + seconds(std::min(longest, needed));
  for (const auto& inverter : inverters_)
  {
    failJobs(inverter->index, ERROR_SHUTTING_DOWN, errorText(ERROR_SHUTTING_DOWN));
    scheduler_->eraseVelocity(inverter->index);
    if (inverter->movement.runPossible() || inverter->stop.pending())
    {
      requestStop(now, *inverter, StopMode::Decelerate, true, "");
    }
    inverter->movement.drop();
  }
}

bool Coordinator::shutdownDone(TimePoint now)
{
  if (now >= shutdown_deadline_)
  {
    return true;
  }
  return std::none_of(inverters_.begin(), inverters_.end(), [&](const std::unique_ptr<Inverter>& inverter) {
    const bool untried = !connected_ || !inverter->silent() || !shutdown_tried_[inverter->index];
    return (inverter->stop.pending() && untried && !untested(*inverter)) || (connected_ && releaseDue(*inverter));
  });
}

std::vector<std::string> Coordinator::endShutdown()
{
  ended_ = true;
  std::vector<std::string> unconfirmed;
  for (const auto& inverter : inverters_)
  {
    if (inverter->stop.pending() || inverter->movement.runPossible())
    {
      unconfirmed.push_back(stopProblem(*inverter));
    }
  }
  for (const StopCall& call : stop_calls_)
  {
    refuseCall(call.callback, ERROR_SHUTTING_DOWN, errorText(ERROR_SHUTTING_DOWN));
  }
  stop_calls_.clear();
  return unconfirmed;
}
}  // namespace bus
}  // namespace inverter_bus

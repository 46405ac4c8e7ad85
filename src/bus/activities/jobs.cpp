// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/jobs.h"

#include <algorithm>

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double VERIFY_PERIOD_S = 0.1;
constexpr double BUSY_PERIOD_S = 0.05;
constexpr unsigned VERIFICATIONS_BEFORE_REPEAT = 10;
constexpr unsigned MOST_RESENT = 2;
}  // namespace

Job::Job(const drive::Drive& drive, std::uint8_t station, CommandKind kind)
  : drive_(drive), station_(station), kind_(kind)
{
}

CommandKind Job::kind() const
{
  return kind_;
}

Duration Job::pause() const
{
  return pause_;
}

Answer& Job::answer()
{
  return answer_;
}

Job::Progress Job::fail(std::uint16_t error_id, const std::string& message)
{
  answer_.success = false;
  answer_.error_id = error_id;
  answer_.message = message;
  return Progress::Done;
}

Job::Progress Job::succeed(const std::string& message)
{
  answer_.success = true;
  answer_.error_id = ERROR_NONE;
  answer_.message = message;
  return Progress::Done;
}

Job::Progress Job::refusedByDrive(const wire::Reply& reply, const std::string& what)
{
  return fail(reply.error_id, what + ": " + drive_.exceptionText(reply.error_id));
}

Job::Progress Job::lost(const wire::Reply& reply)
{
  return fail(reply.error_id, errorText(reply.error_id, reply.gateway_code));
}

// --- reset -----------------------------------------------------------------------------------------------------------

ResetJob::ResetJob(const drive::Drive& drive, std::uint8_t station, std::optional<std::uint32_t> unknown_trip)
  : Job(drive, station, CommandKind::Reset)
  , unknown_trip_(unknown_trip)
  , phase_(drive.runBlock() ? Phase::CheckRun : Phase::Steps)
{
}

const drive::ReadBlock& ResetJob::verifyBlock() const
{
  const auto& blocks = drive_.fastBlocks();
  const auto found = std::find_if(blocks.begin(), blocks.end(), [](const drive::ReadBlock& block) {
    return std::find(block.fields.begin(), block.fields.end(), "faulted") != block.fields.end();
  });
  return found == blocks.end() ? blocks.front() : *found;
}

wire::Request ResetJob::next()
{
  pause_ = Duration{ 0 };
  if (phase_ == Phase::CheckRun)
  {
    return drive_.read(station_, *drive_.runBlock());
  }
  if (phase_ == Phase::Verify)
  {
    return drive_.read(station_, verifyBlock());
  }
  if (phase_ == Phase::CheckRestart)
  {
    return drive_.read(station_, drive_.blockOf({ "restarted" }));
  }
  begun_ = true;
  return drive_.command(station_, drive_.sequence("reset")->steps[step_]);
}

Job::Progress ResetJob::afterStep()
{
  const auto& steps = drive_.sequence("reset")->steps;
  pause_ = seconds(steps[step_].pause);
  const bool silent = !steps[step_].expects_reply;
  ++step_;
  if (silent && drive_.reports("restarted"))
  {
    phase_ = Phase::CheckRestart;
    return Progress::GoesOn;
  }
  phase_ = step_ < steps.size() ? Phase::Steps : Phase::Verify;
  return Progress::GoesOn;
}

/// A step without a reply that got lost on the line is sent again; one that made the drive start anew never is.
Job::Progress ResetJob::afterRestartCheck(const wire::Reply& reply)
{
  drive::Monitor monitor;
  drive_.decode(drive_.blockOf({ "restarted" }), reply.pdu, monitor);
  if (!monitor.restarted.value_or(true) && resent_ < MOST_RESENT)
  {
    ++resent_;
    --step_;
  }
  phase_ = step_ < drive_.sequence("reset")->steps.size() ? Phase::Steps : Phase::Verify;
  return Progress::GoesOn;
}

/// Rule 4.8: nothing is sent unless RUN is read as off.
Job::Progress ResetJob::afterRunCheck(const wire::Reply& reply)
{
  drive::Monitor monitor;
  drive_.decode(*drive_.runBlock(), reply.pdu, monitor);
  // A word that means nothing is no proof that RUN is off.
  if (!monitor.run_seen.value_or(true))
  {
    phase_ = Phase::Steps;
    return Progress::GoesOn;
  }
  if (run_was_on_)
  {
    return fail(ERROR_CANCELLED, "RUN is still on after a stop: nothing was reset, since the motor would start");
  }
  run_was_on_ = true;
  return Progress::NeedsStop;
}

Job::Progress ResetJob::notTold()
{
  return succeed("reset sent; this drive can't tell whether the trip is gone: its state is unknown");
}

Job::Progress ResetJob::verify(const wire::Reply& reply)
{
  drive::Monitor monitor;
  drive_.decode(verifyBlock(), reply.pdu, monitor);
  const std::optional<bool> tripped = monitor.tripped();
  if (!tripped)
  {
    return notTold();
  }
  if (!*tripped)
  {
    return succeed(unknown_trip_ ? "reset sent: the unknown state " + std::to_string(*unknown_trip_) + " is gone"
                                 : "trip cleared");
  }
  // Some causes (overheat, a safe stop that is still open) keep the trip: the bound ends the waiting.
  answer().error_id = wire::ERROR_TIMEOUT;
  answer().message = monitor.unknown_trip
                         ? "reset sent; whether the trip is gone is unknown: " + drive_.tripText(monitor)
                         : "the drive is still tripped after the reset: remove the cause first";
  pause_ = seconds(VERIFY_PERIOD_S);
  if (++still_tripped_ == VERIFICATIONS_BEFORE_REPEAT && drive_.runBlock() &&
      drive_.sequence("reset")->steps.front().expects_reply)
  {
    // Not where each reset makes the drive start anew.
    // A reset coil that an earlier master left on gave no edge the first time.
    phase_ = Phase::CheckRun;
    step_ = 0;
  }
  return Progress::GoesOn;
}

Job::Progress ResetJob::refused(const wire::Reply& reply)
{
  if (phase_ == Phase::CheckRun)
  {
    return refusedByDrive(reply, "nothing was reset, since the drive does not tell whether RUN is off");
  }
  if (phase_ != Phase::Verify)
  {
    return refusedByDrive(reply, "the drive refused the reset");
  }
  if (isLastingRefusal(reply))
  {
    return notTold();
  }
  // Busy, after all: the reset itself was taken.
  answer().error_id = reply.error_id;
  answer().message = "reset sent; whether the trip is gone is unknown: " + drive_.exceptionText(reply.error_id);
  pause_ = seconds(VERIFY_PERIOD_S);
  return Progress::GoesOn;
}

Job::Progress ResetJob::done(const wire::Reply& reply)
{
  deafening_ = phase_ == Phase::Steps;
  if (reply.outcome == wire::Outcome::Exception)
  {
    return refused(reply);
  }
  switch (phase_)
  {
    case Phase::CheckRun:
      return afterRunCheck(reply);
    case Phase::Steps:
      return afterStep();
    case Phase::CheckRestart:
      return afterRestartCheck(reply);
    default:
      return verify(reply);
  }
}

Job::Progress ResetJob::lost(const wire::Reply& reply)
{
  if (!resetting())
  {
    return Job::lost(reply);
  }
  // Sent again and again to a drive that is away, a step must not prolong the deafness for ever.
  deafening_ = phase_ == Phase::Steps && step_ >= steps_sent_;
  steps_sent_ = deafening_ ? step_ + 1 : steps_sent_;
  // A drive that restarts after a reset is deaf for a while; leaving the reset coil on would hold it in reset.
  answer().error_id = reply.error_id;
  answer().message = "the drive did not answer after the reset";
  pause_ = seconds(VERIFY_PERIOD_S);
  return Progress::GoesOn;
}

bool ResetJob::resetting() const
{
  return begun_;
}

bool ResetJob::takeDeafening()
{
  const bool deafening = deafening_;
  deafening_ = false;
  return deafening;
}

// --- faults ----------------------------------------------------------------------------------------------------------

ReadFaultsJob::ReadFaultsJob(const drive::Drive& drive, std::uint8_t station, bool faulted)
  : Job(drive, station, CommandKind::ReadFaults), faulted_(faulted), reads_(drive.faultReads(0))
{
}

wire::Request ReadFaultsJob::next()
{
  return drive_.read(station_, reads_[read_]);
}

Job::Progress ReadFaultsJob::done(const wire::Reply& reply)
{
  if (reply.outcome == wire::Outcome::Exception)
  {
    return refusedByDrive(reply, "reading the trip memory");
  }
  drive_.decodeFault(entry_, reads_[read_], reply.pdu, record_);
  if (++read_ < reads_.size())
  {
    return Progress::GoesOn;
  }
  if (record_.code != 0)
  {
    answer().faults.push_back(record_);
  }
  record_ = drive::FaultRecord();
  read_ = 0;
  if (++entry_ >= drive_.faultEntries())
  {
    return finish();
  }
  reads_ = drive_.faultReads(entry_);
  return Progress::GoesOn;
}

Job::Progress ReadFaultsJob::finish()
{
  if (faulted_ && !answer().faults.empty())
  {
    answer().present = answer().faults.front();
  }
  const std::size_t count = answer().faults.size();
  return succeed(count == 0 ? "the trip memory is empty" : std::to_string(count) + " trips, newest first");
}

// --- parameters ------------------------------------------------------------------------------------------------------

ReadParameterJob::ReadParameterJob(const drive::Drive& drive, std::uint8_t station, const drive::Parameter& parameter)
  : Job(drive, station, CommandKind::ReadParameter), parameter_(parameter)
{
}

wire::Request ReadParameterJob::next()
{
  return drive_.readParameter(station_, parameter_);
}

Job::Progress ReadParameterJob::done(const wire::Reply& reply)
{
  if (reply.outcome == wire::Outcome::Exception)
  {
    return refusedByDrive(reply, "reading " + parameter_.name);
  }
  answer().value = drive_.decodeParameter(parameter_, reply.pdu);
  answer().unit = parameter_.item.unit;
  return succeed(parameter_.title.empty() ? parameter_.name : parameter_.name + ": " + parameter_.title);
}

WriteParameterJob::WriteParameterJob(const drive::Drive& drive, std::uint8_t station, const drive::Parameter& parameter,
                                     std::uint32_t raw, bool persist, std::set<std::string>& ram_changes)
  : Job(drive, station, CommandKind::WriteParameter)
  , parameter_(parameter)
  , raw_(raw)
  , persist_(persist)
  , ram_changes_(ram_changes)
  , phase_(parameter.setup ? Phase::Open : Phase::Write)
{
}

const drive::Parameter& WriteParameterJob::parameter() const
{
  return parameter_;
}

wire::Request WriteParameterJob::next()
{
  pause_ = Duration{ 0 };
  if (phase_ == Phase::Write)
  {
    return drive_.writeParameter(station_, parameter_, raw_);
  }
  if (phase_ == Phase::Busy)
  {
    const auto busy = drive_.readStoreBusy(station_);
    return busy ? *busy : drive_.readParameter(station_, parameter_);
  }
  opened_ = opened_ || phase_ == Phase::Open;
  return drive_.command(station_, stepsOf(phase_)->steps[step_]);
}

bool WriteParameterJob::needsRest() const
{
  return phase_ == Phase::Open && !opened_;
}

bool WriteParameterJob::inSetup() const
{
  return opened_ && !closed_;
}

Job::Progress WriteParameterJob::lost(const wire::Reply& reply)
{
  if (!inSetup())
  {
    return Job::lost(reply);
  }
  // The drive must not stay in its setup area: leave it, until the bound ends the trying.
  refused_id_ = refused_id_ != 0 ? refused_id_ : reply.error_id;
  refused_ = refused_.empty() ? "writing " + parameter_.name + ": " + errorText(reply.error_id) : refused_;
  answer().error_id = refused_id_;
  answer().message = refused_ + "; the drive may still be in its setup area, where it can't run";
  phase_ = Phase::Close;
  step_ = 0;
  pause_ = seconds(VERIFY_PERIOD_S);
  return Progress::GoesOn;
}

const drive::Sequence* WriteParameterJob::stepsOf(Phase phase) const
{
  return drive_.sequence(phase == Phase::Open ? "open_setup" : phase == Phase::Close ? "close_setup" : "store");
}

Job::Progress WriteParameterJob::done(const wire::Reply& reply)
{
  if (reply.outcome == wire::Outcome::Exception && phase_ == Phase::Write && parameter_.setup)
  {
    // The drive must not stay in its setup area, where it can't run.
    refused_id_ = reply.error_id;
    refused_ = "writing " + parameter_.name + ": " + drive_.exceptionText(reply.error_id);
    phase_ = Phase::Close;
    return Progress::GoesOn;
  }
  if (reply.outcome == wire::Outcome::Exception)
  {
    const bool close = phase_ == Phase::Close;
    return refusedByDrive(reply, phase_ == Phase::Write  ? "writing " + parameter_.name
                                 : phase_ == Phase::Open ? "entering the setup area"
                                 : close                 ? "leaving the setup area, where the drive can't run"
                                                         : parameter_.name + " is written to RAM but not stored");
  }
  if (phase_ == Phase::Open || phase_ == Phase::Close)
  {
    return afterSetupStep();
  }
  if (phase_ == Phase::Write)
  {
    return afterWrite();
  }
  if (phase_ == Phase::Store)
  {
    return afterStoreStep();
  }
  if (drive_.readStoreBusy(station_) && drive_.decodeStoreBusy(reply.pdu))
  {
    pause_ = seconds(BUSY_PERIOD_S);
    return Progress::GoesOn;
  }
  return stored();
}

std::string WriteParameterJob::kept() const
{
  return drive_.profile().writes == drive::Writes::Eeprom
             ? " written to the EEPROM"
             : " written; the manual does not say whether it outlives a power-off";
}

Job::Progress WriteParameterJob::afterWrite()
{
  if (parameter_.setup)
  {
    phase_ = Phase::Close;
    step_ = 0;
    return Progress::GoesOn;
  }
  if (drive_.profile().writes != drive::Writes::Ram)
  {
    return succeed(parameter_.name + kept());
  }
  ram_changes_.insert(parameter_.name);
  if (!persist_)
  {
    return succeed(parameter_.name + " written to RAM; lost at power-off unless it is stored with persist");
  }
  phase_ = Phase::Store;
  return Progress::GoesOn;
}

Job::Progress WriteParameterJob::afterSetupStep()
{
  const auto& steps = stepsOf(phase_)->steps;
  pause_ = seconds(steps[step_].pause);
  if (++step_ < steps.size())
  {
    return Progress::GoesOn;
  }
  step_ = 0;
  if (phase_ == Phase::Open)
  {
    phase_ = Phase::Write;
    return Progress::GoesOn;
  }
  closed_ = true;
  return refused_id_ != 0 ? fail(refused_id_, refused_) : succeed(parameter_.name + kept());
}

Job::Progress WriteParameterJob::afterStoreStep()
{
  const auto& steps = drive_.sequence("store")->steps;
  pause_ = seconds(steps[step_].pause);
  if (++step_ < steps.size())
  {
    return Progress::GoesOn;
  }
  phase_ = Phase::Busy;
  if (drive_.readStoreBusy(station_))
  {
    pause_ = std::max(pause_, seconds(BUSY_PERIOD_S));
    return Progress::GoesOn;
  }
  // Without a busy flag the profile's pause is all that protects the writing; a read of the parameter ends it.
  return pause_ > Duration::zero() ? Progress::GoesOn : stored();
}

Job::Progress WriteParameterJob::stored()
{
  const std::string names = util::joined(ram_changes_);
  ram_changes_.clear();
  return succeed("stored in the EEPROM with every other RAM change of this drive; made here: " + names);
}

// --- block read and write --------------------------------------------------------------------------------------------

ConfigureBlockJob::ConfigureBlockJob(const drive::Drive& drive, std::uint8_t station,
                                     std::vector<std::pair<std::string, std::uint32_t>> wanted)
  : Job(drive, station, CommandKind::WriteParameter), wanted_(std::move(wanted))
{
}

wire::Request ConfigureBlockJob::next()
{
  const auto& entry = wanted_[step_];
  return drive_.writeParameter(station_, *drive_.findParameter(entry.first, true), entry.second);
}

Job::Progress ConfigureBlockJob::done(const wire::Reply& reply)
{
  if (reply.outcome == wire::Outcome::Exception)
  {
    return refusedByDrive(reply, "writing " + wanted_[step_].first);
  }
  if (++step_ < wanted_.size())
  {
    return Progress::GoesOn;
  }
  return succeed("the block read and write are set up");
}

bool ConfigureBlockJob::needsRest() const
{
  return true;
}

Job::Progress ConfigureBlockJob::lost(const wire::Reply& reply)
{
  if (step_ + 1 == wanted_.size())
  {
    // The last write resets the drive's communication: its reply may get lost with that.
    return succeed("the block read and write are set up (the last write was not acknowledged)");
  }
  return Job::lost(reply);
}
}  // namespace bus
}  // namespace inverter_bus

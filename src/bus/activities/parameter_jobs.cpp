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
}  // namespace

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

Aftermath WriteParameterJob::aftermath() const
{
  Aftermath aftermath;
  aftermath.parameter = parameter_.name;
  aftermath.leave_setup = inSetup();
  // Leaving the setup area may make the drive forget.
  aftermath.connect_again = parameter_.setup;
  return aftermath;
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

bool WriteParameterJob::lasting() const
{
  // Where the manual does not say, it may reach the EEPROM.
  const bool ram = phase_ == Phase::Write && drive_.profile().writes == drive::Writes::Ram;
  return phase_ != Phase::Busy && !ram;
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
  // The drive must not stay in its setup area: leave it, and keep trying until the bound is over.
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
             : " written; the manual does not say whether it survives a power-off";
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

// --- register map ----------------------------------------------------------------------------------------------------

ConfigureMapJob::ConfigureMapJob(const drive::Drive& drive, std::uint8_t station,
                                 std::vector<std::pair<std::string, std::uint32_t>> wanted,
                                 std::set<std::string>& ram_changes)
  : WriteParameterJob(drive, station, *drive.findParameter(wanted.back().first, true), wanted.back().second, true,
                      ram_changes)
  , wanted_(std::move(wanted))
  , written_(ram_changes)
{
}

/// The last one is written and stored as any parameter is.
bool ConfigureMapJob::last() const
{
  return place_ + 1 >= wanted_.size();
}

wire::Request ConfigureMapJob::next()
{
  const auto& entry = wanted_[place_];
  return last() ? WriteParameterJob::next()
                : drive_.writeParameter(station_, *drive_.findParameter(entry.first, true), entry.second);
}

Job::Progress ConfigureMapJob::done(const wire::Reply& reply)
{
  if (!last() && reply.outcome == wire::Outcome::Exception)
  {
    return refusedByDrive(reply, "writing " + wanted_[place_].first);
  }
  if (!last())
  {
    written_.insert(wanted_[place_].first);
    ++place_;
    return Progress::GoesOn;
  }
  const Progress progress = WriteParameterJob::done(reply);
  if (progress == Progress::Done && answer().success)
  {
    answer().message += "; switch the drive off and on: its register map takes effect then";
  }
  return progress;
}

bool ConfigureMapJob::needsRest() const
{
  return true;
}

Aftermath ConfigureMapJob::aftermath() const
{
  Aftermath aftermath;
  aftermath.logged_as = "configure_map";
  return aftermath;
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

Aftermath ConfigureBlockJob::aftermath() const
{
  Aftermath aftermath;
  aftermath.logged_as = "configure_block";
  return aftermath;
}

bool ConfigureBlockJob::lasting() const
{
  return true;
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

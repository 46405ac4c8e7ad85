// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_JOBS_H
#define INVERTER_BUS_BUS_JOBS_H

#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bus/rules/scheduler.h"
#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// What a job has changed in the drive, or may have, however it ended: it is read again.
struct Aftermath
{
  /// Name of the parameter that was written; empty: none.
  std::string parameter;
  /// The drive still has to be led out of its setup area.
  bool leave_setup = false;
  /// The drive may have forgotten what it was sent at connect.
  bool connect_again = false;
  /// No caller waits for the answer: it is logged under this name, and all settings are read again. Empty: a caller waits.
  std::string logged_as;
};

/// A service call that needs exchanges with one drive. A job is a sequence of single exchanges; the scheduler puts other
/// things between them. It ends with an answer, at the latest when its bound is over.
class Job
{
public:
  enum class Progress
  {
    /// Queue the next exchange, after pause().
    GoesOn,
    /// RUN must be confirmed off before this job may send anything further: stop the inverter, then ask again.
    NeedsStop,
    /// answer() is complete.
    Done
  };

  Job(const drive::Drive& drive, std::uint8_t station, CommandKind kind);
  virtual ~Job() = default;

  virtual wire::Request next() = 0;
  /// A valid reply or an exception.
  virtual Progress done(const wire::Reply& reply) = 0;
  /// Lost after its repeats. Ends the job unless a subclass overrides that.
  virtual Progress lost(const wire::Reply& reply);

  /// The next frame may go only while the motor is at rest and no command waits.
  virtual bool needsRest() const
  {
    return false;
  }

  /// The frame that next() returned last reaches the EEPROM, or resets the drive: its reply is waited for in any case
  /// (contract, 8.4).
  virtual bool lasting() const
  {
    return false;
  }

  /// The drive has been led into its setup area and not out of it again.
  virtual bool inSetup() const
  {
    return false;
  }

  /// A frame has left after which the drive has forgotten its words.
  virtual bool clearsWords() const
  {
    return false;
  }

  /// The exchange before was one after which the drive may be deaf (see the profile), for the first time.
  virtual bool takeDeafening()
  {
    return false;
  }

  virtual Aftermath aftermath() const
  {
    return Aftermath();
  }

  CommandKind kind() const;
  Duration pause() const;
  Answer& answer();

protected:
  Progress fail(std::uint16_t error_id, const std::string& message);
  Progress succeed(const std::string& message);
  Progress refusedByDrive(const wire::Reply& reply, const std::string& what);

  const drive::Drive& drive_;
  const std::uint8_t station_;
  Duration pause_{ 0 };

private:
  const CommandKind kind_;
  Answer answer_;
};

/// Clears a trip. Sends nothing that could start a motor: RUN is read back as off directly before the reset. Where the
/// drive can't report RUN, the coordinator has a stop confirmed first.
class ResetJob : public Job
{
public:
  /// \p unknown_trip the drive's state where the profile does not know it, see drive::Monitor.
  ResetJob(const drive::Drive& drive, std::uint8_t station, std::optional<std::uint32_t> unknown_trip = std::nullopt);
  wire::Request next() override;
  Progress done(const wire::Reply& reply) override;
  Progress lost(const wire::Reply& reply) override;
  bool lasting() const override;
  /// A reset frame has left.
  bool clearsWords() const override;
  bool takeDeafening() override;
  Aftermath aftermath() const override;

private:
  enum class Phase
  {
    CheckRun,
    Steps,
    /// After a step that has no reply: has it arrived?
    CheckRestart,
    Verify
  };
  const drive::ReadBlock& verifyBlock() const;
  Progress afterStep();
  Progress afterRestartCheck(const wire::Reply& reply);
  Progress afterRunCheck(const wire::Reply& reply);
  Progress verify(const wire::Reply& reply);
  Progress refused(const wire::Reply& reply);
  Progress notTold();

  const std::optional<std::uint32_t> unknown_trip_;
  Phase phase_;
  std::size_t step_ = 0;
  bool run_was_on_ = false;
  bool begun_ = false;
  bool deafening_ = false;
  /// Steps that were sent at least once.
  std::size_t steps_sent_ = 0;
  unsigned still_tripped_ = 0;
  unsigned resent_ = 0;
};

class ReadFaultsJob : public Job
{
public:
  ReadFaultsJob(const drive::Drive& drive, std::uint8_t station, bool faulted);
  wire::Request next() override;
  Progress done(const wire::Reply& reply) override;

private:
  Progress finish();

  bool faulted_;
  std::size_t entry_ = 0;
  std::size_t read_ = 0;
  std::vector<drive::ReadBlock> reads_;
  drive::FaultRecord record_;
};

class ReadParameterJob : public Job
{
public:
  ReadParameterJob(const drive::Drive& drive, std::uint8_t station, const drive::Parameter& parameter);
  wire::Request next() override;
  Progress done(const wire::Reply& reply) override;

private:
  drive::Parameter parameter_;
};

/// Writes a parameter; with persist, stores every RAM change of the drive and waits until its EEPROM is done. Where the
/// drive takes it in its setup area only, leads it there and back.
class WriteParameterJob : public Job
{
public:
  /// \p ram_changes names of the parameters written to RAM through this node since the last store; kept up to date.
  WriteParameterJob(const drive::Drive& drive, std::uint8_t station, const drive::Parameter& parameter,
                    std::uint32_t raw, bool persist, std::set<std::string>& ram_changes);
  wire::Request next() override;
  Progress done(const wire::Reply& reply) override;
  Progress lost(const wire::Reply& reply) override;
  bool needsRest() const override;
  bool lasting() const override;
  bool inSetup() const override;
  Aftermath aftermath() const override;

private:
  enum class Phase
  {
    Open,
    Write,
    Close,
    Store,
    Busy
  };
  const drive::Sequence* stepsOf(Phase phase) const;
  Progress afterWrite();
  Progress afterStoreStep();
  Progress afterSetupStep();
  Progress stored();
  std::string kept() const;

  drive::Parameter parameter_;
  std::uint32_t raw_;
  bool persist_;
  std::set<std::string>& ram_changes_;
  Phase phase_;
  std::size_t step_ = 0;
  bool opened_ = false;
  bool closed_ = false;
  /// Why the write failed while the drive is still to be led out of its setup area.
  std::uint16_t refused_id_ = 0;
  std::string refused_;
};

/// Writes the parameters of the drive's register map, and stores them (MX2: P201-P310, P200, Enter), once.
class ConfigureMapJob : public WriteParameterJob
{
public:
  /// \p wanted, not empty: parameters and raw values in the order of writing. \p ram_changes as for WriteParameterJob.
  ConfigureMapJob(const drive::Drive& drive, std::uint8_t station,
                  std::vector<std::pair<std::string, std::uint32_t>> wanted, std::set<std::string>& ram_changes);
  wire::Request next() override;
  Progress done(const wire::Reply& reply) override;
  bool needsRest() const override;
  Aftermath aftermath() const override;

private:
  bool last() const;

  std::vector<std::pair<std::string, std::uint32_t>> wanted_;
  std::set<std::string>& written_;
  std::size_t place_ = 0;
};

/// Selects the words of the block read and write in the drive (VF-S15: F870-F879, then F899), once.
class ConfigureBlockJob : public Job
{
public:
  /// \p wanted parameters and raw values, in the order of writing.
  ConfigureBlockJob(const drive::Drive& drive, std::uint8_t station,
                    std::vector<std::pair<std::string, std::uint32_t>> wanted);
  wire::Request next() override;
  Progress done(const wire::Reply& reply) override;
  Progress lost(const wire::Reply& reply) override;
  bool needsRest() const override;
  bool lasting() const override;
  Aftermath aftermath() const override;

private:
  std::vector<std::pair<std::string, std::uint32_t>> wanted_;
  std::size_t step_ = 0;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_JOBS_H

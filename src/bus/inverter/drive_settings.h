// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_DRIVE_SETTINGS_H
#define INVERTER_BUS_BUS_DRIVE_SETTINGS_H

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// What the drive says of itself against what its profile expects.
enum class Identity
{
  /// It fits, or the profile knows nothing that would tell it from another.
  Right,
  /// It has not been asked yet.
  Unknown,
  Wrong
};

/// How the words of a block read and a block write are selected in the drive, by code.
struct BlockSlots
{
  std::vector<int> read;
  std::vector<int> write;
};

/// What is settled with a drive once at every connect. First what decides whether it may be commanded at all: what it is
/// (identity) and what it must be told (the profile's sequence `connect`). Then, in the lowest class, its own settings
/// that decide over safety: who may command it, what it does when the bus falls silent, whether it restarts by itself, how
/// long it waits before it answers (contract, sections 3.8, 3.12, 4.1 and 4.5).
class DriveSettings
{
public:
  DriveSettings(const drive::Drive& drive, std::uint8_t station);

  /// Settles everything again (the drive has come back).
  void restart();
  /// The drive has forgotten what it was told: the sequence `connect` goes again.
  void connectAgain();
  /// The drive may have been left in its setup area: it is led out of it before anything else.
  void leaveSetup();
  bool leavingSetup() const;
  /// Something is left that comes before the first status.
  bool urgent() const;
  /// Another exchange is to be made.
  bool pending() const;
  /// next() writes.
  bool nextWrites() const;
  wire::Request next() const;
  void done(const wire::Reply& reply);
  /// How long the next exchange of the lowest class is to wait: 0, or, when all that is left was refused for the moment,
  /// 1 s, doubled with each refusal up to 64 s.
  Duration pauseBeforeNext() const;
  /// A parameter was written through the node: what it means may have changed.
  void reread(const std::string& parameter);
  /// A command of ours is in force: who commands the drive can be seen only now. Again: it is looked at anew.
  void commanded();
  /// A stop of ours was confirmed: what was seen under command counts no more.
  void released();

  Identity identity() const;
  /// Why the drive gets no command but a stop: it is the wrong one, or has not told yet what it is; empty: it is right.
  std::string identityText() const;
  /// As the drive names itself (CompoWay/F); empty: not told.
  const std::string& model() const;
  /// The sequence `connect` was carried out, or there is none.
  bool connected() const;
  /// Ratings as read from the drive.
  drive::Ratings ratings() const;
  /// Selections of the block read and write; empty before all are known, or where the drive refuses to tell.
  std::optional<BlockSlots> blockSlots() const;

  /// The drive's own communication time-out, as read or assumed; nothing: none, or not known yet.
  std::optional<Duration> driveTimeout() const;
  /// The drive's own reply delay; 0 before it is known.
  Duration replyDelay() const;
  /// WARN and ERROR lines that say what to set.
  std::vector<Finding> findings() const;
  /// Settings as read, for /diagnostics.
  std::vector<std::pair<std::string, std::string>> values() const;

private:
  enum class State
  {
    Unread,
    Known,
    Refused
  };
  struct Setting
  {
    drive::Parameter parameter;
    /// Read before the first status.
    bool urgent = false;
    /// Read only while a command of ours is in force.
    bool when_commanded = false;
    State state = State::Unread;
    /// Known, but to be read anew.
    bool again = false;
    /// In a row, each of them of the moment.
    unsigned refusals = 0;
    std::uint32_t raw = 0;
    double value = 0.0;
  };
  void want(const std::string& parameter);
  void want(const std::vector<drive::Expectation>& expectations, bool urgent);
  const Setting* find(const std::string& parameter) const;
  const Setting* known(const std::string& parameter) const;
  const Setting* unread() const;
  bool due(const Setting& setting) const;
  bool modelDue() const;
  bool connectDue() const;
  void doneModel(const wire::Reply& reply);
  void doneConnect(const wire::Reply& reply);
  std::optional<std::vector<int>> codesOf(const std::vector<std::string>& slots) const;
  void expectationFindings(const std::vector<drive::Expectation>& expectations, const std::string& prefix,
                           std::vector<Finding>& findings) const;
  void lossFindings(std::vector<Finding>& findings) const;

  const drive::Drive& drive_;
  std::uint8_t station_;
  std::vector<Setting> settings_;
  bool wants_model_ = false;
  State model_state_ = State::Unread;
  std::string model_;
  std::size_t connect_step_ = 0;
  State connect_state_ = State::Unread;
  std::uint16_t connect_error_ = 0;
  bool commanded_ = false;
  bool leave_setup_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_DRIVE_SETTINGS_H

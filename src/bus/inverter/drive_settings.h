// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_DRIVE_SETTINGS_H
#define INVERTER_BUS_BUS_DRIVE_SETTINGS_H

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/inverter/connect_steps.h"
#include "bus/inverter/drive_identity.h"
#include "bus/inverter/map_table.h"
#include "bus/inverter/setting_facts.h"
#include "bus/inverter/setting_list.h"
#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// What is settled with a drive once at every connect. First what decides whether it may be commanded at all: what it is
/// (identity) and what it must be sent (the profile's sequence `connect`). Then, in the lowest class, its own settings
/// that decide safety: which source may command it, what it does when the bus falls silent, whether it restarts by
/// itself, how long it waits before it answers (contract, sections 3.8, 3.12, 4.1 and 4.5).
class DriveSettings
{
public:
  /// \p map_wanted: what the drive has in its register map is of interest.
  DriveSettings(const drive::Drive& drive, std::uint8_t station, bool map_wanted = false);

  /// Settles everything again. \p perhaps_another: the drive has come back, and what it is counts no more until it is read;
  /// otherwise many of its parameters were written, and nothing is locked meanwhile.
  void restart(bool perhaps_another = true);
  /// The drive has forgotten what it was sent: the sequence `connect` goes again.
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
  /// next() asks for what was reported before, or refused for the moment: it takes from the share of the slow values
  /// (contract, 8.3).
  bool repeats() const;
  wire::Request next() const;
  void done(const wire::Reply& reply);
  /// How long the next exchange of the lowest class is to wait: 0, or, when all that is left was refused for the moment,
  /// 1 s, doubled with each refusal up to 64 s.
  Duration pauseBeforeNext() const;
  /// A parameter was written through the node: what it means may have changed.
  void reread(const std::string& parameter);
  /// A command of this node is \p in_force: only now can it be seen what commands the drive; calling it again re-reads it.
  /// False: a stop was confirmed, and what was seen under command no longer counts.
  void underCommand(bool in_force);

  Identity identity() const;
  /// Why the drive gets no command but a stop: it is the wrong one, or has not reported yet what it is; empty: it is right.
  std::string identityText() const;
  /// As the drive names itself (CompoWay/F); empty: not reported.
  const std::string& model() const;
  /// The sequence `connect` was carried out, or there is none.
  bool connected() const;
  /// Ratings as read from the drive.
  drive::Ratings ratings() const;
  /// Selections of the block read and write; empty before all are known, or where the drive refuses the read.
  std::optional<BlockSlots> blockSlots() const;

  /// What the drive has in its register map.
  const MapTable& map() const;

  /// The drive's own communication time-out, as read or assumed; nothing: none, or not known yet.
  std::optional<Duration> driveTimeout() const;
  /// The drive's own reply delay; 0 before it is known.
  Duration replyDelay() const;
  /// WARN and ERROR lines that say what to set.
  std::vector<Finding> findings() const;
  /// Settings as read, for /diagnostics.
  std::vector<std::pair<std::string, std::string>> values() const;

private:
  const drive::Step* connectStep() const;

  const drive::Drive& drive_;
  std::uint8_t station_;
  SettingList settings_;
  DriveIdentity identity_;
  ConnectSteps connect_;
  MapTable map_;
  bool leave_setup_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_DRIVE_SETTINGS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_INVERTER_H
#define INVERTER_BUS_BUS_INVERTER_H

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/inverter/block_transfer.h"
#include "bus/inverter/command_error.h"
#include "bus/inverter/drive_settings.h"
#include "bus/inverter/feeding.h"
#include "bus/inverter/link.h"
#include "bus/inverter/link_record.h"
#include "bus/inverter/liveness.h"
#include "bus/inverter/loopback_knowledge.h"
#include "bus/inverter/lost_writes.h"
#include "bus/inverter/map_use.h"
#include "bus/inverter/motion_watch.h"
#include "bus/inverter/movement.h"
#include "bus/inverter/pauses.h"
#include "bus/inverter/refresh.h"
#include "bus/inverter/repeats.h"
#include "bus/inverter/run_evidence.h"
#include "bus/inverter/service_state.h"
#include "bus/inverter/stop_job.h"
#include "bus/rules/interlock.h"
#include "bus/rules/reply_times.h"
#include "bus/rules/scheduler.h"

namespace inverter_bus
{
namespace bus
{
/// One inverter of the bus: an aggregate of parts, each with its own task, and the events that concern several of them at
/// once. Not thread safe; the bus guards it.
class Inverter
{
public:
  /// \p config and \p drive must outlive it. \p offline_after failures in a row make it offline, a lost frame of a velocity
  /// is repeated \p retries times (bus parameters).
  Inverter(std::size_t index, const InverterConfig& config, const drive::Drive& drive, int offline_after, int retries);

  // --- parts --------------------------------------------------------------------------------------------------------
  /// Its place in node order.
  const std::size_t index;
  const InverterConfig& config;
  const drive::Drive& drive;
  Interlock interlock;
  Movement movement;
  StopJob stop;
  Refresh refresh;
  DriveSettings settings;
  LoopbackKnowledge loopback;
  Link link;
  RunEvidence evidence;
  Feeding feeding;
  MotionWatch motion;
  BlockTransfer block_transfer;
  MapUse map_use;
  CommandError command_error;
  /// What has come since the last complete status.
  LinkRecord record;
  LostWrites lost_writes;
  Liveness liveness;
  ReplyTimes reply_times;
  Pauses pauses;
  /// Of the exchange at hand for its settings.
  Repeats setting_repeats;
  ServiceState services;

  // --- the link -----------------------------------------------------------------------------------------------------
  /// An exchange failed after its repeats. Returns true if the inverter has just gone offline. Lost writes of command words
  /// alone don't take it offline (contract, 8.1): a read must have been lost among them.
  bool failed(TimePoint now, std::uint16_t error_id, bool write = false);
  /// The run words were refused. Returns true if the inverter has just gone offline.
  bool refusedStatus(std::uint16_t error_id);
  /// The port is gone, or the inverter is given up: offline at once.
  void goOffline(std::uint16_t error_id);
  /// The trial of an offline inverter has led to nothing, since an exchange ended with \p error_id. Returns its price.
  Duration endTrial(std::uint16_t error_id);
  /// When it must hear something, because of a communication time-out of its own; nothing: it has none.
  std::optional<TimePoint> serveBy(Duration deadline_margin) const;

  // --- requests -----------------------------------------------------------------------------------------------------
  /// \p request with the time-outs and silences of this inverter.
  wire::Request prepared(wire::Request request) const;
  /// A loop-back may take the place of another request. Not to a port of the drive's own before it has reported its status
  /// (contract, 8.8).
  bool loopbackUsable() const;
  /// A keep-alive may repeat the confirmed command words (contract, 4.1).
  bool mayRepeatWords(TimePoint now) const;

  // --- what is settled at connect -----------------------------------------------------------------------------------
  /// Identity and the sequence `connect` are settled before its first status.
  bool connectDue(TimePoint now) const;
  /// After each exchange for its settings.
  void settled(TimePoint now, const wire::Reply& reply);
  /// Its parameters may be written: the motor is at rest, and no command is about to move it.
  bool standsStill() const;
  /// The drive takes no block write: direct reads and single writes from now on.
  void dropBlock(const std::string& why);
  /// A parameter was written through this node.
  void parameterWritten(const std::string& name);

  // --- status -------------------------------------------------------------------------------------------------------
  /// An exchange ended; a lost one invalidates all that was proven about RUN.
  void noteExchange(const wire::Reply& reply);
  /// It was a read of a refresh (which goes on, with \p more): what it shows about RUN.
  void noteStatus(const wire::Reply& reply, bool more);
  /// After each read of a refresh that goes on: a matter of safety does not wait until the rest has come or failed to come.
  Judgement wordsRead(TimePoint now);
  /// After a complete refresh.
  Judgement statusComplete(TimePoint now);
  /// RUN is off at last, as far as is known: confirmed, or seen off by a read that left at \p now.
  void cameToRest(TimePoint now);

  // --- answers ------------------------------------------------------------------------------------------------------
  /// The motor may turn, as far as is known.
  bool mayRun() const;
  /// What bars velocities as long as it lasts, for the interlock.
  Holds holds() const;
  /// What is in the way of a velocity now.
  Obstacles obstacles(TimePoint now) const;
  /// What the scheduler must know about it.
  InverterView view(TimePoint now, Duration deadline_margin) const;

private:
  void forgetDrive(bool after_silence);
  Judgement compare(TimePoint now, const StatusWords& words, bool complete);
  std::string noteRestart(const drive::Monitor& words, TimePoint sent_at);
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_INVERTER_H

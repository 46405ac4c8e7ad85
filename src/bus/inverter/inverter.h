// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_INVERTER_H
#define INVERTER_BUS_BUS_INVERTER_H

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bus/inverter/command_error.h"
#include "bus/inverter/drive_settings.h"
#include "bus/inverter/link_record.h"
#include "bus/inverter/liveness.h"
#include "bus/inverter/lost_writes.h"
#include "bus/inverter/movement.h"
#include "bus/inverter/refresh.h"
#include "bus/inverter/stop_job.h"
#include "bus/rules/interlock.h"
#include "bus/rules/scheduler.h"

namespace inverter_bus
{
namespace bus
{
/// What a complete refresh means for safety. The coordinator acts on it.
struct Judgement
{
  /// Stop the inverter and lock it; empty: no reason to.
  std::string stop_reason;
  /// RUN is on although a command of 0 took it off: insist, without a lock.
  bool zero_failed = false;
  /// The trip is new; its reason in words.
  bool tripped = false;
  std::string trip_text;
};

/// Whether the drive really has the loop-back that its profile promises. One that answers it with an exception has not,
/// nor one that is silent on it time and again but answers other requests.
class LoopbackKnowledge
{
public:
  /// \p most_misses so often it may be left unanswered: one that got lost on a line says little, a server's silence much.
  explicit LoopbackKnowledge(unsigned most_misses) : most_misses_(most_misses)
  {
  }

  void note(wire::Outcome outcome)
  {
    works_ = works_ || outcome == wire::Outcome::Ok;
    refused_ = refused_ || outcome == wire::Outcome::Exception;
    misses_ += missed_ ? 0 : 1;
    missed_ = true;
  }
  /// Another request was answered: only now a loop-back that was not says something of the loop-back.
  void otherAnswered()
  {
    missed_ = false;
  }
  /// The drive has come back: another one may stand there now.
  void tryAgain()
  {
    misses_ = 0;
  }
  /// Worth sending where its answer is needed.
  bool usable() const
  {
    return works_ || !(refused_ || misses_ >= most_misses_);
  }
  /// Worth sending where its answer would be good news.
  bool worthATry() const
  {
    return works_ || !refused_;
  }
  bool proven() const
  {
    return works_;
  }

private:
  unsigned most_misses_;
  bool works_ = false;
  bool refused_ = false;
  unsigned misses_ = 0;
  /// Counted already: a drive that is silent on everything misses once.
  bool missed_ = false;
};

/// One inverter of the bus: its parts, its link, and what its words mean together.
class Inverter
{
public:
  Inverter(std::size_t index, const InverterConfig& config, const drive::Drive& drive, int offline_after, int retries);

  // --- parts ------------------------------------------------------------------------------------------------------
  const std::size_t index;
  const InverterConfig& config;
  const drive::Drive& drive;
  Interlock interlock;
  Movement movement;
  StopJob stop;
  Refresh refresh;
  DriveSettings settings;
  std::set<std::string> ram_changes;
  LoopbackKnowledge loopback;
  /// What came since the last complete status.
  LinkRecord record;
  LostWrites lost_writes;
  Liveness liveness;

  // --- link -------------------------------------------------------------------------------------------------------
  /// A valid reply came, of whatever kind. It makes an offline inverter worth a trial, and no more: it is back with a complete
  /// status only (contract, 8.15).
  void answered(const wire::Reply& reply);
  /// A reply to a probe came late, \p delay after its request: worth a trial, too.
  void beginTrial(Duration delay);
  /// Offline, but it answers: its settings and its status are being read, at the probes' cost if that leads to nothing.
  bool onTrial() const;
  /// The trial has led to nothing, since an exchange ended with \p error_id. Returns what it has cost.
  Duration endTrial(std::uint16_t error_id);
  /// Offline, and it is not even known to answer.
  bool silent() const;
  /// An exchange with it has ended (bookkeeping of probes and trials).
  void noteCost(bool probe, wire::Outcome outcome, Duration cost);
  /// An exchange failed after its repeats. Returns true if the inverter has just gone offline. Lost writes of command words
  /// alone don't take it offline (contract, 8.1): a read must have been lost among them.
  bool failed(TimePoint now, std::uint16_t error_id, bool write = false);
  /// The run words were refused. Returns true if the inverter has just gone offline.
  bool refusedStatus(std::uint16_t error_id);
  /// No complete status has come for too long (contract, 8.15); \p period of its refreshes.
  bool overdue(TimePoint now, Duration period) const;
  /// The port is gone, or the inverter is given up: offline at once.
  void goOffline(std::uint16_t error_id);
  bool offline() const;
  /// A complete status has come since start or return.
  bool known() const;
  /// A complete status has come since the node was started.
  bool everKnown() const;
  /// When it must hear something, because of a communication time-out of its own; nothing: it has none.
  std::optional<TimePoint> serveBy(Duration deadline_margin) const;
  /// All reads that a refresh may be made of.
  std::vector<drive::ReadBlock> reads() const;
  /// Silence is expected for so long (after a step of a trip reset).
  void expectSilence(TimePoint now, Duration duration);
  /// It has answered a frame of the reset: if it is deaf, then from the next one on.
  void noDeafness();

  wire::Request prepared(wire::Request request) const;
  /// Identity and what the drive must be told are settled before its first status.
  bool connectDue(TimePoint now) const;
  /// After each exchange for its settings.
  void settled(TimePoint now, const wire::Reply& reply);
  /// The drive has selected exactly the words that are configured.
  bool blockFits() const;
  /// Parameters and values that make the block read and write fit, empty where nothing is to be written (any more).
  std::vector<std::pair<std::string, std::uint32_t>> blockToConfigure();
  /// The drive takes no block write: direct reads and single writes from now on.
  void dropBlock(const std::string& why);
  /// An exchange ended; a lost one ends all that was proven of RUN.
  void noteExchange(const wire::Reply& reply);
  /// It was a read of a refresh (that goes on, with \p more): what it shows of RUN.
  void noteStatus(const wire::Reply& reply, bool more);
  /// A parameter was written through this node.
  void parameterWritten(const std::string& name);
  /// A parameter is being written in the drive's setup area, where it can't run.
  bool inSetup() const;
  /// A refresh may repeat the confirmed command words (rule 4.1).
  bool mayRepeatWords(TimePoint now) const;
  /// The motor may turn, as far as anybody can tell.
  bool mayRun() const;
  /// RUN must not be sent again before a status has shown that the motor runs: a frame that turns it round got lost.
  bool mustBeSeenRunning() const;
  /// Why the drive gets no command but a stop; empty: it does.
  std::string wrongDrive() const;
  /// The drive's EEPROM has been written once more by this node.
  void noteEepromWrite();
  /// A loop-back may take the place of another request. Not to a port of the drive's own before it has told its status
  /// (contract, 8.8).
  bool loopbackUsable() const;
  /// The next probe() is a loop-back, if the drive's profile has one.
  bool probesByLoopback() const;
  /// The question that shows whether an offline drive is back.
  wire::Request probe(std::uint16_t number, Duration response_timeout) const;
  /// Longest turnaround seen while the drive answered.
  Duration slowestReply() const;
  void lateReply(Duration delay);
  /// What the log says when it answers (again), and what is to be done before it moves.
  std::string onlineText() const;
  /// What the log says when it goes offline.
  std::string offlineReason() const;

  // --- status -----------------------------------------------------------------------------------------------------
  /// After a complete refresh.
  Judgement judge(TimePoint now);
  /// After each read of a refresh that goes on: what concerns safety is not put off until the rest has come, or not come.
  Judgement judgeWords(TimePoint now);
  InverterStatus status(TimePoint now) const;
  std::vector<Finding> findings(TimePoint now) const;
  std::vector<std::pair<std::string, std::string>> values(TimePoint now) const;
  InverterView view(TimePoint now, Duration deadline_margin) const;

  void refuseCommand(std::uint16_t error_id, const std::string& text);
  /// As a member of a group that was refused for the sake of another one, for what stood in its own way see CommandError.
  void refuseForOther(std::uint16_t error_id, const std::string& reasons, std::uint16_t own_error_id,
                      const std::string& own_text);
  void acceptCommand();
  /// A velocity that was accepted has failed at the drive; shown until one is confirmed, since a stream of accepted ones
  /// would hide it.
  void velocityFailed(std::uint16_t error_id, const std::string& text);
  /// One was confirmed, or a 0 came.
  void velocityConfirmed();
  void noteExchangeError(std::uint16_t error_id);
  /// How a probe ended: while it is offline that is the reason, not the port that was gone before.
  void noteProbed(const wire::Reply& reply);

  bool reset_active = false;
  /// Frames of a job have led the drive into its setup area.
  bool setup_open = false;
  TimePoint refresh_not_before;
  TimePoint connect_not_before;
  /// Its settings are not asked for before that.
  TimePoint setting_not_before;
  int refresh_tries = 0;
  /// Frames of the velocity unit under way, so that a stream of changes can't keep a unit going for ever.
  unsigned velocity_frames = 0;
  int settings_tries = 0;
  unsigned probes = 0;

private:
  void forgetDrive(bool after_silence);
  void noteBack();
  void adoptSettings();
  bool followsTarget(const drive::Monitor& monitor);
  bool writesWear() const;
  std::string blockFinding() const;
  std::vector<int> wantedWriteCodes() const;
  void judgeRestart(const drive::Monitor& monitor, TimePoint sent_at, Judgement& judgement);
  void judgeRun(const drive::Monitor& monitor, TimePoint sent_at, Judgement& judgement);
  void judgeOperation(TimePoint now, const drive::Monitor& monitor, TimePoint sent_at, Judgement& judgement);
  void compareMovement(TimePoint now, const drive::Monitor& monitor);
  std::vector<Finding> errors(TimePoint now) const;
  std::string exchangeText() const;
  std::string offlineText(TimePoint now) const;
  std::string silenceText() const;
  Obstacles obstacles() const;
  void showError(TimePoint now, InverterStatus& status) const;

  int offline_after_;
  /// Since its last status words; counted up to offline_after_.
  int exchanges_without_data_;
  bool known_ = false;  ///< a complete status has come since start or return
  bool ever_known_ = false;
  bool offline_ = false;
  bool on_trial_ = false;
  /// What the trial has cost since the probe that began it, and how much of that was lost or refused.
  Duration trial_cost_{ 0 };
  Duration trial_waste_{ 0 };
  /// Since the last trial, and nobody has answered it yet.
  bool probed_ = false;
  std::uint16_t exchange_error_ = 0;
  /// By which a gateway said that the drive had not answered the last exchange; 0: it did not.
  std::uint8_t gateway_code_ = 0;
  CommandError command_error_;
  std::uint16_t velocity_error_ = 0;
  std::string velocity_error_text_;
  TimePoint last_reply_;
  bool ever_answered_ = false;
  TimePoint silence_until_;
  /// All settings that are left were refused for the moment.
  TimePoint refused_setting_not_before_;
  Duration slowest_reply_{ 0 };
  Duration latest_late_reply_{ 0 };
  std::uint64_t returns_ = 0;

  // commanded against actual
  bool operation_seen_ = false;
  std::optional<TimePoint> operation_off_since_;
  bool at_rest_seen_ = true;
  std::optional<TimePoint> idle_since_;
  std::optional<TimePoint> wrong_direction_since_;
  std::optional<TimePoint> deviates_since_;
  double last_frequency_ = 0.0;
  bool unexpected_motion_ = false;
  bool leftover_judged_ = false;
  bool early_trip_ = false;
  TimePoint command_source_at_;

  // block read and write
  std::optional<TimePoint> run_shown_at_;
  /// The drive's own copy of our RUN command was read as on since the last lost exchange.
  bool run_proven_ = false;
  /// By then the drive had not restarted.
  TimePoint no_restart_until_;
  double last_shown_hz_ = 0.0;
  bool block_configured_ = false;
  std::string block_note_;
  std::uint64_t eeprom_writes_ = 0;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_INVERTER_H

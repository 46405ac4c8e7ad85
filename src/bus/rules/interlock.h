// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_INTERLOCK_H
#define INVERTER_BUS_BUS_INTERLOCK_H

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// What a velocity that is not 0 may do right now.
enum class Permission
{
  Granted,
  /// An old message of a latched publisher: no effect at all.
  Repeat,
  Offline,
  StopPending,
  Locked
};

/// Why it is Locked. All reasons are here, so that `locked` in a status and the refusal 0xB005 can't differ.
enum class LockReason
{
  /// It is not.
  None,
  /// The drive has not reported what it is, yet or again.
  Unidentified,
  /// No complete status has come since the start.
  Unread,
  /// A reset of the drive is under way.
  Resetting,
  /// A parameter is being written in the drive's setup area.
  InSetup,
  Tripped,
  /// The publisher has not returned to neutral.
  Neutral
};

/// What bars velocities for as long as it lasts. Other parts of the inverter know it, so it is passed in with each
/// question.
struct Holds
{
  /// A stop is pending that no velocity replaces, though it locks no publisher: 0xB002.
  bool stop = false;
  bool unidentified = false;
  bool resetting = false;
  bool in_setup = false;
};

/// Return to neutral and command watchdog of one inverter (contract, sections 4.2 and 4.3), as one pure state machine:
/// time comes in, permissions come out.
///
///     start-up ----+
///     stop --------+--> LOCKED --(stop confirmed, no fault, online, and the publisher has sent 0 or was silent)--> free
///     watchdog ----+       ^                                                                                       |
///     fault -------+       +---------------------------------------------------------------------------------------+
///     offline -----+
///
/// A lock counts per publisher: one that has not returned to neutral since stays refused, whatever others do. A hold locks
/// while it lasts; after it, only those whose velocities it has refused must return to neutral: nothing has stopped, but a
/// stream must not start a motor at an unforeseeable moment. Not thread safe; the bus guards it.
class Interlock
{
public:
  /// \p command_timeout [s] without an accepted command before watchdogDue(); 0: never.
  explicit Interlock(double command_timeout);

  // --- what happened ----------------------------------------------------------------------------------------------
  /// The inverter has answered for the first time (start-up) or again (return): the silence counts from here.
  void online(TimePoint now);
  void offline();
  /// A stop was requested by anything but a command of 0: all publishers must return to neutral.
  void stopRequested();
  void stopConfirmed(TimePoint now);
  void faulted(bool faulted);

  // --- velocities -------------------------------------------------------------------------------------------------
  struct Verdict
  {
    Permission permission = Permission::Granted;
    /// If it is Locked.
    LockReason reason = LockReason::None;
  };
  /// Judges a velocity other than 0 and changes nothing. What takes precedence comes first (contract, section 2: the
  /// order of ids).
  Verdict judge(TimePoint now, const Publisher& publisher, const Holds& holds) const;
  /// Books a velocity other than 0. \p accepted: it was granted and is in range; feeds the command watchdog. A refused
  /// one ends the publisher's neutral: a stream of refused commands must not come through when the lock's reason goes
  /// away.
  void commanded(TimePoint now, const Publisher& publisher, bool accepted, const Holds& holds);
  /// Books a velocity of 0: neutral for this publisher.
  void zeroed(TimePoint now, const Publisher& publisher);
  /// Books a velocity near 0: for the lock as if nothing had come, so that it neither ends a silence nor is a return to
  /// neutral; for the command watchdog as a 0.
  void nearlyZeroed(TimePoint now, const Publisher& publisher);
  /// No RUN from this node is in force any more: nothing for the command watchdog to watch.
  void resting();

  // --- answers ----------------------------------------------------------------------------------------------------
  /// A command is in force and none has come for `command_timeout`.
  bool watchdogDue(TimePoint now) const;
  /// When watchdogDue() becomes true if nothing comes; nothing: never.
  std::optional<TimePoint> watchdogAt() const;
  /// What status shows: true while no publisher has returned to neutral and a stream goes on being refused, or the lock's
  /// reason is not over. False, a publisher whose stream has never paused is still refused: the lock counts per
  /// publisher.
  bool locked(TimePoint now, const Holds& holds) const;
  /// Silence that unlocks for a publisher that was never heard; one that sends slowly needs twice its spacing.
  Duration silenceNeeded() const;
  bool stopPending() const;
  bool isOffline() const;
  bool isFaulted() const;
  /// Publishers whose non-zero commands came within the last 2 s.
  unsigned activePublishers(TimePoint now) const;

private:
  struct Stream
  {
    /// The last message that breaks a silence; nothing: none has come yet.
    std::optional<TimePoint> last;
    /// The last message of any kind.
    TimePoint heard;
    std::array<Duration, 3> spacings{};
    std::size_t next_spacing = 0;
    bool neutral = false;
    unsigned admitted = 0;
    bool nonzero = false;
    std::set<std::string> topics;
  };
  LockReason reason(const Holds& holds) const;
  bool silent(TimePoint now, const Stream* stream) const;
  const Stream* find(const std::string& name) const;
  Stream& hear(TimePoint now, const Publisher& publisher);
  Stream& book(TimePoint now, const Publisher& publisher);
  void lock();

  Duration command_timeout_;
  std::map<std::string, Stream> streams_;
  /// The last message of any publisher that is no longer in streams_.
  TimePoint forgotten_last_;
  unsigned generation_ = 1;
  bool stop_pending_ = false;
  bool faulted_ = false;
  bool offline_ = false;
  /// A status was read since the start.
  bool seen_ = false;
  std::optional<TimePoint> neutral_since_;
  std::optional<TimePoint> last_accepted_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_INTERLOCK_H

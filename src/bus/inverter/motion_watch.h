// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_MOTION_WATCH_H
#define INVERTER_BUS_BUS_MOTION_WATCH_H

#include <optional>
#include <string>
#include <vector>

#include "bus/inverter/movement.h"

namespace inverter_bus
{
namespace bus
{
/// What a status means for safety. The coordinator acts on it.
struct Judgement
{
  /// Stop the inverter and lock it; empty: no reason to.
  std::string stop_reason;
  /// RUN is on although a command of 0 took it off: keep stopping it, without a lock.
  bool zero_failed = false;
  /// The trip is new; its reason in words.
  bool tripped = false;
  std::string trip_text;
};

/// Words of a status, and what is known beside them.
struct Observation
{
  const drive::Monitor& words;
  /// When the request for them left.
  TimePoint sent_at;
  TimePoint now;
  /// All words of the status have come; otherwise the refresh goes on.
  bool complete;
  const Movement& movement;
  bool stop_pending;
  /// A trip is known already.
  bool faulted;
};

/// A judgement, and what it means for the rest of the inverter.
struct MotionVerdict
{
  Judgement judgement;
  /// Tripped or not; nothing: it stays as it was.
  std::optional<bool> faulted;
  /// RUN was seen off after a command of 0.
  bool came_to_rest = false;
  /// The drive has reported its state after the frame that was to reverse it got lost.
  bool told_after_turn = false;
};

/// Compares what the drive does with its commands (contract, 4.1, 4.7 and 4.8): trips, a lost or a leftover RUN, a motor
/// that runs or stops by itself, in the wrong direction or at another speed. It remembers what it has seen and changes
/// nothing else: the caller acts on the verdict. Pure: time comes in as an argument. Not thread safe; the bus guards it.
class MotionWatch
{
public:
  /// Both must outlive it.
  MotionWatch(const drive::Drive& drive, const InverterConfig& config);

  /// After each read of a refresh that goes on, and after the last one of a complete status: a matter of safety does not
  /// wait until the rest has come or failed to come.
  MotionVerdict judge(const Observation& seen);
  /// The inverter went offline: its motion can no longer be seen.
  void wentOffline();
  /// What was read of the drive no longer counts: the next status is the first one.
  void forget();

  /// What users are to look for, a sentence each.
  std::vector<std::string> warnings(TimePoint now) const;

private:
  void judgeTrip(const Observation& seen, MotionVerdict& verdict);
  void judgeRun(const Observation& seen, MotionVerdict& verdict);
  void judgeRunSeen(const Observation& seen, MotionVerdict& verdict);
  void judgeOperation(const Observation& seen, MotionVerdict& verdict);
  void judgeUncommanded(const Observation& seen, bool operation, MotionVerdict& verdict);
  void compare(const Observation& seen, bool commanded);
  double commandedHz(const Movement& movement) const;

  const drive::Drive& drive_;
  const InverterConfig& config_;
  bool operation_seen_ = false;
  std::optional<TimePoint> operation_off_since_;
  bool at_rest_seen_ = true;
  std::optional<TimePoint> idle_since_;
  std::optional<TimePoint> wrong_direction_since_;
  std::optional<TimePoint> deviates_since_;
  double last_frequency_ = 0.0;
  bool unexpected_motion_ = false;
  /// Whether a RUN of the bus was left on from before has been seen.
  bool leftover_judged_ = false;
  /// A trip was acted on before the status with its code was complete.
  bool early_trip_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_MOTION_WATCH_H

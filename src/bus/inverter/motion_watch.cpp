// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/motion_watch.h"

#include <algorithm>
#include <cmath>

namespace inverter_bus
{
namespace bus
{
namespace
{
// At reversal a drive may show "stopped" for a moment: only a longer one means that it lost its RUN.
constexpr double OPERATION_LOST_S = 0.5;
// Below this a drive may legitimately be at rest with RUN on (start frequency).
constexpr double LOWEST_JUDGED_HZ = 1.0;
constexpr double MOVEMENT_PATIENCE_S = 3.0;
constexpr double DEVIATION_PATIENCE_S = 2.0;

bool lasts(const std::optional<TimePoint>& since, TimePoint now, double patience)
{
  return since && now - *since >= seconds(patience);
}

void watch(std::optional<TimePoint>& since, bool condition, TimePoint now)
{
  since = condition ? since.value_or(now) : std::optional<TimePoint>();
}

/// Words requested before this node last changed RUN say nothing about it.
bool isEvidence(const Observation& seen)
{
  return seen.sent_at >= seen.movement.runChangedAt();
}
}  // namespace

MotionWatch::MotionWatch(const drive::Drive& drive, const InverterConfig& config) : drive_(drive), config_(config)
{
}

MotionVerdict MotionWatch::judge(const Observation& seen)
{
  MotionVerdict verdict;
  judgeTrip(seen, verdict);
  judgeRun(seen, verdict);
  judgeOperation(seen, verdict);
  if (seen.complete)
  {
    const auto& target = seen.movement.target();
    compare(seen, seen.movement.runConfirmed() && !verdict.came_to_rest && target && !target->zero);
    leftover_judged_ = leftover_judged_ || seen.words.run_seen || !drive_.reports("run_seen");
  }
  return verdict;
}

void MotionWatch::judgeTrip(const Observation& seen, MotionVerdict& verdict)
{
  Judgement& judgement = verdict.judgement;
  // A status that can't show a trip does not end one.
  const bool tripped = seen.words.tripped().value_or(seen.complete && seen.faulted);
  const bool is_new = tripped && !seen.faulted;
  if (!seen.complete)
  {
    if (is_new)
    {
      verdict.faulted = true;
      early_trip_ = true;
      judgement.stop_reason = seen.words.unknown_trip ? drive_.tripText(seen.words) : "the drive has tripped";
    }
    return;
  }
  verdict.faulted = tripped;
  judgement.tripped = is_new || early_trip_;
  early_trip_ = false;
  if (judgement.tripped)
  {
    judgement.trip_text = drive_.tripText(seen.words);
    judgement.stop_reason = is_new ? judgement.trip_text : std::string();
  }
}

void MotionWatch::judgeRun(const Observation& seen, MotionVerdict& verdict)
{
  if (!leftover_judged_ && !drive_.reports("run_seen") && !seen.stop_pending && !seen.movement.runPossible())
  {
    verdict.judgement.stop_reason = "the drive can't tell whether a RUN of the bus is on";
    return;
  }
  if (seen.words.run_seen && isEvidence(seen) && !seen.stop_pending)
  {
    judgeRunSeen(seen, verdict);
  }
}

void MotionWatch::judgeRunSeen(const Observation& seen, MotionVerdict& verdict)
{
  const bool run_seen = *seen.words.run_seen;
  Judgement& judgement = verdict.judgement;
  if (seen.movement.runConfirmed() && !run_seen)
  {
    judgement.stop_reason = "the drive lost its RUN without a stop from this node (switched off and on, or reset)";
  }
  judgement.zero_failed = seen.movement.zeroUnverified() && run_seen;
  verdict.came_to_rest = seen.movement.zeroUnverified() && !run_seen;
  if (!run_seen || seen.movement.runPossible())
  {
    return;
  }
  if (!leftover_judged_)
  {
    judgement.stop_reason = "a leftover RUN on the bus command is cleared";
    return;
  }
  const bool new_motion = !unexpected_motion_;
  unexpected_motion_ = true;
  if (new_motion && config_.stop_unexpected_motion)
  {
    judgement.stop_reason = "RUN is on without a command of this node";
  }
}

void MotionWatch::judgeOperation(const Observation& seen, MotionVerdict& verdict)
{
  const std::optional<bool>& operation = seen.words.operation ? seen.words.operation : seen.words.running;
  if (!operation)
  {
    return;
  }
  const Movement& movement = seen.movement;
  if (!movement.runPossible() || verdict.came_to_rest)
  {
    judgeUncommanded(seen, *operation, verdict);
    return;
  }
  at_rest_seen_ = false;
  unexpected_motion_ = false;
  verdict.told_after_turn = movement.turnLostAt() && seen.sent_at > *movement.turnLostAt();
  if (verdict.told_after_turn && !*operation)
  {
    verdict.judgement.stop_reason = "the drive stopped while it was to reverse (switched off and on?)";
  }
  operation_seen_ = operation_seen_ || *operation;
  const bool lost = operation_seen_ && !*operation && movement.runConfirmed() &&
                    commandedHz(movement) >= LOWEST_JUDGED_HZ && isEvidence(seen);
  watch(operation_off_since_, lost, seen.now);
  if (lasts(operation_off_since_, seen.now, OPERATION_LOST_S))
  {
    verdict.judgement.stop_reason = "the drive stopped without a stop from this node (STOP key, terminal or safe stop)";
    operation_seen_ = false;
  }
}

/// No RUN from this node is on. A motor that coasts down after its stop is no surprise; one that starts from rest is.
void MotionWatch::judgeUncommanded(const Observation& seen, bool operation, MotionVerdict& verdict)
{
  operation_seen_ = false;
  operation_off_since_.reset();
  const bool by_the_bus = seen.words.run_seen.value_or(false);
  if (!operation)
  {
    at_rest_seen_ = true;
    unexpected_motion_ = unexpected_motion_ && by_the_bus;
  }
  const bool surprising = operation && (at_rest_seen_ || !leftover_judged_) && !by_the_bus;
  if (surprising && !unexpected_motion_)
  {
    unexpected_motion_ = true;
    if (config_.stop_unexpected_motion && !seen.stop_pending)
    {
      verdict.judgement.stop_reason = "the motor runs without a command of this node";
    }
  }
}

void MotionWatch::compare(const Observation& seen, bool commanded)
{
  const drive::Monitor& words = seen.words;
  const double frequency = words.output_frequency.value_or(0.0);
  const double target = commanded ? commandedHz(seen.movement) : 0.0;
  watch(idle_since_, commanded && words.output_frequency && frequency <= 0.0 && target >= LOWEST_JUDGED_HZ, seen.now);
  const int sense = commanded && seen.movement.target()->reverse ? -1 : 1;
  watch(wrong_direction_since_,
        commanded && words.direction && *words.direction == -sense && frequency >= last_frequency_, seen.now);
  const bool deviates = commanded && words.at_speed.value_or(false) && words.output_frequency && frequency > 0.0 &&
                        std::fabs(frequency - target) > std::max(0.5, 0.02 * target);
  watch(deviates_since_, deviates, seen.now);
  last_frequency_ = frequency;
}

double MotionWatch::commandedHz(const Movement& movement) const
{
  return movement.target() ? movement.target()->counts * drive_.frequencyResolution() : 0.0;
}

void MotionWatch::wentOffline()
{
  unexpected_motion_ = false;
}

void MotionWatch::forget()
{
  leftover_judged_ = false;
  early_trip_ = false;
  operation_seen_ = false;
  operation_off_since_.reset();
}

std::vector<std::string> MotionWatch::warnings(TimePoint now) const
{
  std::vector<std::string> warnings;
  if (unexpected_motion_)
  {
    warnings.emplace_back("runs without a command of this node; look for a second master, the panel or terminals");
  }
  if (lasts(idle_since_, now, MOVEMENT_PATIENCE_S))
  {
    warnings.emplace_back(
        "does not move although RUN is on; check the enable inputs and which source may command the drive");
  }
  if (lasts(wrong_direction_since_, now, MOVEMENT_PATIENCE_S))
  {
    warnings.emplace_back("turns in the wrong direction; check the drive's direction settings and hz_per_unit");
  }
  if (lasts(deviates_since_, now, DEVIATION_PATIENCE_S))
  {
    warnings.emplace_back(
        "runs at a speed other than commanded; check for a takeover at the panel and the drive's frequency limits");
  }
  return warnings;
}
}  // namespace bus
}  // namespace inverter_bus

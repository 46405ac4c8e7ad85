// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/run_evidence.h"

#include <algorithm>
#include <cmath>

namespace inverter_bus
{
namespace bus
{
namespace
{
// A drive that was switched off and on is deaf for a second: within half of that it can't have lost its RUN unnoticed.
constexpr double LASTS_S = 0.5;
constexpr double SOURCE_PERIOD_S = 5.0;
}  // namespace

RunEvidence::RunEvidence(const drive::Drive& drive) : drive_(drive)
{
}

void RunEvidence::exchangeEnded(wire::Outcome outcome)
{
  shown_at_.reset();
  proven_ = proven_ && outcome == wire::Outcome::Ok;
}

void RunEvidence::statusRead(const drive::Monitor& words, const wire::Reply& reply, const Movement& movement)
{
  const bool evidence = reply.sent_at >= movement.runChangedAt();
  if (words.run_seen)
  {
    proven_ = *words.run_seen && evidence && movement.runConfirmed();
  }
  const bool runs = words.operation.value_or(false) || words.running.value_or(false);
  if (runs && evidence && proven_ && followsTarget(words, movement))
  {
    shown_at_ = reply.finished_at;
  }
}

/// The motor turns as commanded, or is on its way there: not on its way to rest after a RUN that the drive has lost.
bool RunEvidence::followsTarget(const drive::Monitor& words, const Movement& movement)
{
  const auto& target = movement.target();
  if (!target || target->zero || !words.output_frequency)
  {
    return false;
  }
  const double wanted = target->counts * drive_.frequencyResolution();
  const double distance = std::fabs(*words.output_frequency - wanted);
  const double before = std::fabs(last_shown_hz_ - wanted);
  last_shown_hz_ = *words.output_frequency;
  const bool turns_right = !words.direction || *words.direction == (target->reverse ? -1 : 1);
  return turns_right && (distance <= std::max(0.5, 0.02 * wanted) || distance < before);
}

Restart RunEvidence::restartRead(bool restarted, TimePoint sent_at, const Movement& movement, bool stop_pending)
{
  if (!restarted)
  {
    no_restart_until_ = sent_at;
    return Restart::None;
  }
  proven_ = false;
  const bool perhaps_before = movement.runConfirmed() && no_restart_until_ < movement.runChangedAt() && !stop_pending;
  return perhaps_before ? Restart::PerhapsBeforeRun : Restart::Restarted;
}

void RunEvidence::forget()
{
  shown_at_.reset();
  proven_ = false;
}

bool RunEvidence::shows(TimePoint now, const Movement& movement) const
{
  return shown_at_ && now - *shown_at_ < seconds(LASTS_S) && *shown_at_ >= movement.runChangedAt() &&
         movement.runConfirmed();
}

bool RunEvidence::takeSourceDue(TimePoint now, const Movement& movement, Duration period)
{
  const Duration least = std::max(seconds(SOURCE_PERIOD_S), period);
  const bool due = movement.runConfirmed() && now - source_asked_at_ >= least;
  source_asked_at_ = due ? now : source_asked_at_;
  return due;
}
}  // namespace bus
}  // namespace inverter_bus

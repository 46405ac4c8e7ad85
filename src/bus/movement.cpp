// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/bus/movement.h"

#include <cmath>
#include <sstream>

namespace inverter_bus
{
namespace bus
{
namespace
{
const std::string FORWARD = "forward";
const std::string REVERSE = "reverse";
const std::string STOP = "stop";

JudgedVelocity refused(std::uint16_t error_id, const std::string& text)
{
  JudgedVelocity judged;
  judged.error_id = error_id;
  judged.text = text;
  return judged;
}

std::string number(double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}
}  // namespace

Movement::Movement(const drive::Drive& drive, const InverterConfig& config) : drive_(drive), config_(config)
{
  if (const drive::Sequence* stop = drive.sequence(STOP))
  {
    for (const drive::Step& step : stop->steps)
    {
      if (step.value)
      {
        stop_values_[step.point] = *step.value;
      }
    }
  }
}

JudgedVelocity Movement::judge(double velocity) const
{
  if (!std::isfinite(velocity))
  {
    return refused(ERROR_OUT_OF_RANGE, "velocity " + number(velocity) + " is not a finite number");
  }
  JudgedVelocity judged;
  judged.target.velocity = velocity;
  if (velocity == 0.0)
  {
    judged.target.zero = true;
    return judged;
  }
  const double magnitude = std::fabs(velocity);
  if (magnitude > config_.max_velocity || magnitude < config_.min_velocity)
  {
    return refused(ERROR_OUT_OF_RANGE, "velocity " + number(velocity) + " is out of range: 0, or " +
                                           number(config_.min_velocity) + " to " + number(config_.max_velocity) +
                                           " in either direction");
  }
  const double frequency = velocity * config_.hz_per_unit;
  judged.target.counts = drive_.frequencyCounts(std::fabs(frequency));
  judged.target.reverse = frequency < 0.0;
  if (judged.target.counts == 0)
  {
    return refused(ERROR_OUT_OF_RANGE, "velocity " + number(velocity) + " rounds to 0 Hz; the drive's step is " +
                                           number(drive_.frequencyResolution()) + " Hz");
  }
  const std::string& name = judged.target.reverse ? REVERSE : FORWARD;
  if (drive_.sequence(name) == nullptr)
  {
    const std::string missing = drive_.missingFor(name);
    return missing.empty() ? refused(ERROR_NOT_OFFERED, "this drive has no " + name)
                           : refused(ERROR_NOT_ARMED, name + " is not armed: check '" + missing +
                                                          "' in the drive's manual, then confirm or override it");
  }
  if (drive_.sequence(STOP) == nullptr)
  {
    return refused(ERROR_NOT_ARMED, "motion is not armed: the stop command is not confirmed");
  }
  return judged;
}

void Movement::aim(const Target& target)
{
  target_ = target;
  // A second 0 leaves the question open whether the first one has taken RUN off.
  zero_unverified_ = target.zero && zero_unverified_;
  active_ = next().has_value();
  if (target.zero && !active_)
  {
    drop();
  }
}

void Movement::drop()
{
  target_.reset();
  confirmed_target_.reset();
  active_ = false;
}

const std::optional<Target>& Movement::target() const
{
  return target_;
}

bool Movement::active() const
{
  return active_;
}

const std::string& Movement::sequenceName() const
{
  if (target_->zero)
  {
    return STOP;
  }
  return target_->reverse ? REVERSE : FORWARD;
}

std::optional<Write> Movement::next() const
{
  if (!target_)
  {
    return std::nullopt;
  }
  const drive::Sequence* sequence = drive_.sequence(sequenceName());
  if (sequence == nullptr)
  {
    return std::nullopt;
  }
  for (const drive::Step& step : sequence->steps)
  {
    Write write;
    write.point = step.point;
    write.raw = step.value ? *step.value : target_->counts;
    const auto word = words_.find(step.point);
    if (word != words_.end() && word->second == write.raw)
    {
      continue;
    }
    const auto stop_value = stop_values_.find(step.point);
    write.starts = stop_value != stop_values_.end() && stop_value->second != write.raw;
    write.request = drive_.write(config_.node, write.point, write.raw);
    return write;
  }
  return std::nullopt;
}

void Movement::sent(const Write& write)
{
  words_.erase(write.point);
  if (write.starts)
  {
    run_command_ = true;
    run_possible_ = true;
  }
  else if (stop_values_.count(write.point) != 0)
  {
    run_command_ = false;
    run_confirmed_ = false;
  }
}

void Movement::confirmed(const Write& write, TimePoint now)
{
  words_[write.point] = write.raw;
  if (stop_values_.count(write.point) != 0)
  {
    run_confirmed_ = write.starts;
    run_changed_at_ = now;
  }
  if (next())
  {
    return;
  }
  active_ = false;
  confirmed_target_ = target_;
  if (target_ && target_->zero)
  {
    zero_unverified_ = true;
    target_.reset();
  }
}

void Movement::doubtful(const Write& write)
{
  words_.erase(write.point);
}

void Movement::giveUp()
{
  active_ = false;
  // What ran before goes on, and that is what is in force.
  target_ = run_possible_ ? confirmed_target_ : std::nullopt;
}

void Movement::stopped(TimePoint now)
{
  confirmed_target_.reset();
  words_.clear();
  run_changed_at_ = now;
  run_command_ = false;
  run_possible_ = false;
  run_confirmed_ = false;
  zero_unverified_ = false;
}

void Movement::forgetWords()
{
  words_.clear();
  run_confirmed_ = false;
}

bool Movement::runCommand() const
{
  return run_command_;
}

bool Movement::runPossible() const
{
  return run_possible_;
}

bool Movement::runConfirmed() const
{
  return run_confirmed_;
}

TimePoint Movement::runChangedAt() const
{
  return run_changed_at_;
}

bool Movement::zeroUnverified() const
{
  return zero_unverified_;
}
}  // namespace bus
}  // namespace inverter_bus

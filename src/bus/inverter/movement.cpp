// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/movement.h"

#include <algorithm>
#include <cmath>

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
const std::string FORWARD = "forward";
const std::string REVERSE = "reverse";
const std::string STOP = "stop";
const std::string FREQUENCY = "frequency";
// A newer frequency goes before direction and RUN, but a stream of them must not keep these waiting.
constexpr unsigned MOST_FREQUENCIES = 2;

JudgedVelocity refused(std::uint16_t error_id, const std::string& text)
{
  JudgedVelocity judged;
  judged.error_id = error_id;
  judged.text = text;
  return judged;
}

}  // namespace

Movement::Movement(const drive::Drive& drive, const InverterConfig& config)
  : drive_(drive), config_(config), range_(drive, config)
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

const VelocityRange& Movement::range() const
{
  return range_;
}

JudgedVelocity Movement::judge(double velocity, double factor) const
{
  using Kind = RangedVelocity::Kind;
  const RangedVelocity ranged = range_.judge(velocity, factor);
  if (ranged.kind == Kind::Refused)
  {
    return refused(ERROR_OUT_OF_RANGE, ranged.why);
  }
  JudgedVelocity judged;
  judged.target.velocity = ranged.velocity;
  judged.target.near_zero = ranged.kind == Kind::NearZero;
  judged.target.zero = judged.target.near_zero || ranged.kind == Kind::Zero;
  if (judged.target.zero)
  {
    return judged;
  }
  const double frequency = ranged.velocity * config_.hz_per_unit;
  judged.target.counts = drive_.frequencyCounts(std::fabs(frequency));
  judged.target.reverse = frequency < 0.0;
  const std::string& name = judged.target.reverse ? REVERSE : FORWARD;
  if (drive_.sequence(name) == nullptr)
  {
    return drive_.missingFor(name).empty()
               ? refused(ERROR_NOT_OFFERED, "this drive has no " + name)
               : refused(ERROR_NOT_ARMED, name + " is not armed: " + drive_.armingAdvice(name));
  }
  if (drive_.sequence(STOP) == nullptr)
  {
    return refused(ERROR_NOT_ARMED, "motion is not armed, since a stop is not: " + drive_.armingAdvice(STOP));
  }
  return judged;
}

void Movement::aim(const Target& target)
{
  frequencies_told_ = active_ ? frequencies_told_ : 0;
  target_ = target;
  // A second 0 leaves open whether the first one has taken RUN off.
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

/// The words that the target asks for, in the order of sending.
std::vector<drive::Word> Movement::wantedWords() const
{
  std::vector<drive::Word> words;
  const drive::Sequence* sequence = target_ ? drive_.sequence(sequenceName()) : nullptr;
  if (sequence != nullptr)
  {
    for (const drive::Step& step : sequence->steps)
    {
      words.emplace_back(step.point, step.value ? *step.value : target_->counts);
    }
  }
  return words;
}

bool Movement::isConfirmed(const drive::Word& word) const
{
  const auto confirmed = words_.find(word.first);
  return confirmed != words_.end() && confirmed->second == word.second;
}

bool Movement::startsWith(const drive::Word& word) const
{
  const auto stop_value = stop_values_.find(word.first);
  return stop_value != stop_values_.end() && stop_value->second != word.second;
}

std::optional<Write> Movement::next() const
{
  std::optional<Write> newer_frequency;
  const std::vector<drive::Word> words = wantedWords();
  const auto missing =
      std::count_if(words.begin(), words.end(), [this](const drive::Word& word) { return !isConfirmed(word); });
  for (const drive::Word& word : words)
  {
    if (isConfirmed(word))
    {
      continue;
    }
    Write write;
    write.last = missing == 1;
    write.point = word.first;
    write.raw = word.second;
    write.starts = startsWith(word);
    write.request = drive_.write(config_.node, write.point, write.raw);
    if (word.first != FREQUENCY || frequencies_told_ < MOST_FREQUENCIES)
    {
      return write;
    }
    // A stream that changes faster than a frame takes must not keep direction and RUN waiting for ever.
    newer_frequency = write;
  }
  return newer_frequency;
}

std::optional<Write> Movement::nextCombined(const std::optional<drive::ReadBlock>& read) const
{
  const std::vector<drive::Word> words = wantedWords();
  const bool confirmed =
      std::all_of(words.begin(), words.end(), [this](const drive::Word& word) { return isConfirmed(word); });
  if (confirmed || !drive_.fitsBlockWrite(words))
  {
    return std::nullopt;
  }
  Write write;
  // The word that starts the motor gives the frame its name.
  write.point = words.back().first;
  write.raw = words.back().second;
  write.more.assign(words.begin(), words.end() - 1);
  // A word that is confirmed already changes nothing, whether the frame arrives or not.
  write.starts = std::any_of(words.begin(), words.end(),
                             [this](const drive::Word& word) { return startsWith(word) && !isConfirmed(word); });
  write.request = read ? drive_.writeAndRead(config_.node, words, *read) : drive_.writeChosen(config_.node, words);
  write.last = true;
  return write;
}

std::vector<drive::Word> Movement::wordsInForce() const
{
  const std::vector<drive::Word> words = wantedWords();
  const bool all =
      std::all_of(words.begin(), words.end(), [this](const drive::Word& word) { return isConfirmed(word); });
  const bool in_force = run_confirmed_ && target_ && !target_->zero && all;
  return in_force ? words : std::vector<drive::Word>();
}

void Movement::sentWord(const drive::Word& word)
{
  if (isConfirmed(word))
  {
    return;
  }
  words_.erase(word.first);
  if (startsWith(word))
  {
    run_command_ = true;
    run_possible_ = true;
  }
  else if (stop_values_.count(word.first) != 0)
  {
    run_command_ = false;
    run_confirmed_ = false;
  }
}

void Movement::sent(const Write& write)
{
  for (const drive::Word& word : write.more)
  {
    sentWord(word);
  }
  sentWord({ write.point, write.raw });
}

void Movement::confirmedWord(const drive::Word& word, TimePoint now)
{
  if (isConfirmed(word))
  {
    return;
  }
  words_[word.first] = word.second;
  frequencies_told_ += word.first == FREQUENCY ? 1 : 0;
  if (stop_values_.count(word.first) != 0)
  {
    run_confirmed_ = startsWith(word);
    run_changed_at_ = now;
    turn_lost_at_.reset();
  }
}

void Movement::confirmed(const Write& write, TimePoint now)
{
  for (const drive::Word& word : write.more)
  {
    confirmedWord(word, now);
  }
  confirmedWord({ write.point, write.raw }, now);
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

void Movement::doubtful(const Write& write, TimePoint now)
{
  turn_lost_at_ = write.starts && run_confirmed_ ? now : turn_lost_at_;
  std::vector<drive::Word> words = write.more;
  words.emplace_back(write.point, write.raw);
  for (const drive::Word& word : words)
  {
    // Sending has taken out what the frame was to change; what is left was in force before, and must not be sent again
    // because of a lost frame: that would restore a RUN that the drive has lost.
    if (!isConfirmed(word))
    {
      words_.erase(word.first);
    }
  }
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
  frequencies_told_ = 0;
  run_changed_at_ = now;
  run_command_ = false;
  run_possible_ = false;
  run_confirmed_ = false;
  zero_unverified_ = false;
  turn_lost_at_.reset();
}

void Movement::forgetWords()
{
  words_.clear();
  frequencies_told_ = 0;
  run_confirmed_ = false;
  turn_lost_at_.reset();
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

std::optional<TimePoint> Movement::turnLostAt() const
{
  return turn_lost_at_;
}

void Movement::seenRunning()
{
  turn_lost_at_.reset();
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

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/rules/interlock.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double SHORTEST_SILENCE_S = 0.5;
constexpr double LONGEST_SPACING_SILENCE_S = 5.0;
// Names of publishers come from outside: more than these and the longest silent one is forgotten.
constexpr std::size_t MOST_PUBLISHERS = 64;
constexpr double ACTIVE_PUBLISHER_S = 2.0;
}  // namespace

Interlock::Interlock(double command_timeout) : command_timeout_(seconds(command_timeout))
{
}

void Interlock::lock()
{
  ++generation_;
  neutral_since_.reset();
  last_accepted_.reset();
  for (auto& stream : streams_)
  {
    stream.second.neutral = false;
  }
}

void Interlock::online(TimePoint now)
{
  offline_ = false;
  // At start-up the silence counts from the first status, also where a stop was confirmed before it.
  if (!stop_pending_ && (!neutral_since_ || !seen_))
  {
    neutral_since_ = now;
  }
  seen_ = true;
}

void Interlock::offline()
{
  if (!offline_)
  {
    lock();
  }
  offline_ = true;
}

void Interlock::stopRequested()
{
  lock();
  stop_pending_ = true;
}

void Interlock::stopConfirmed(TimePoint now)
{
  if (stop_pending_)
  {
    stop_pending_ = false;
    neutral_since_ = now;
  }
}

void Interlock::faulted(bool faulted)
{
  if (faulted && !faulted_)
  {
    lock();
  }
  faulted_ = faulted;
}

/// The reason that no publisher gets past; Neutral: all must return to it, and none can have done so yet.
LockReason Interlock::reason(const Holds& holds) const
{
  if (holds.unidentified)
  {
    return LockReason::Unidentified;
  }
  if (!seen_)
  {
    // Silence counts from the first status, not from a stop that was confirmed before it.
    return LockReason::Unread;
  }
  if (holds.resetting)
  {
    return LockReason::Resetting;
  }
  if (holds.in_setup)
  {
    return LockReason::InSetup;
  }
  if (faulted_)
  {
    return LockReason::Tripped;
  }
  return neutral_since_ ? LockReason::None : LockReason::Neutral;
}

bool Interlock::silent(TimePoint now, const Stream* stream) const
{
  Duration needed = silenceNeeded();
  // A publisher that is not known may be one of the forgotten, whose stream goes on.
  const bool commanded = stream != nullptr && stream->last;
  TimePoint since = commanded ? *neutral_since_ : std::max(*neutral_since_, forgotten_last_);
  if (commanded)
  {
    // The longest of the last few: a publisher that sends in pairs does not count as a fast one.
    const Duration spacing = *std::max_element(stream->spacings.begin(), stream->spacings.end());
    needed = std::max(needed, std::min(2 * spacing, seconds(LONGEST_SPACING_SILENCE_S)));
    since = std::max(since, *stream->last);
  }
  return now - since >= needed;
}

const Interlock::Stream* Interlock::find(const std::string& name) const
{
  const auto found = streams_.find(name);
  return found == streams_.end() ? nullptr : &found->second;
}

Interlock::Verdict Interlock::judge(TimePoint now, const Publisher& publisher, const Holds& holds) const
{
  const Stream* stream = find(publisher.name);
  const bool old_message = publisher.latched && publisher.first_on_connection;
  // A publisher that is not known may be among the forgotten.
  const bool heard_before =
      stream == nullptr ? forgotten_last_ != TimePoint() : stream->topics.count(publisher.topic) != 0;
  if (old_message && heard_before)
  {
    return { Permission::Repeat, LockReason::None };
  }
  if (offline_)
  {
    return { Permission::Offline, LockReason::None };
  }
  if (stop_pending_ || holds.stop)
  {
    return { Permission::StopPending, LockReason::None };
  }
  const LockReason barred = reason(holds);
  if (barred != LockReason::None)
  {
    return { Permission::Locked, barred };
  }
  const bool admitted = stream != nullptr && (stream->admitted == generation_ || stream->neutral);
  if ((old_message && publisher.before_start) || !(admitted || silent(now, stream)))
  {
    return { Permission::Locked, LockReason::Neutral };
  }
  return { Permission::Granted, LockReason::None };
}

/// A publisher that has sent anything is known from then on: what it repeats on its next connection is old.
Interlock::Stream& Interlock::hear(TimePoint now, const Publisher& publisher)
{
  auto found = streams_.find(publisher.name);
  if (found == streams_.end())
  {
    if (streams_.size() >= MOST_PUBLISHERS)
    {
      const auto oldest = std::min_element(streams_.begin(), streams_.end(), [](const auto& left, const auto& right) {
        return left.second.heard < right.second.heard;
      });
      forgotten_last_ = std::max(forgotten_last_, oldest->second.heard);
      streams_.erase(oldest);
    }
    found = streams_.emplace(publisher.name, Stream()).first;
  }
  found->second.heard = now;
  found->second.topics.insert(publisher.topic);
  return found->second;
}

Interlock::Stream& Interlock::book(TimePoint now, const Publisher& publisher)
{
  Stream& stream = hear(now, publisher);
  if (stream.last)
  {
    stream.spacings[stream.next_spacing] = now - *stream.last;
    stream.next_spacing = (stream.next_spacing + 1) % stream.spacings.size();
  }
  stream.last = now;
  return stream;
}

void Interlock::commanded(TimePoint now, const Publisher& publisher, bool accepted, const Holds& holds)
{
  Stream& stream = book(now, publisher);
  stream.nonzero = true;
  stream.neutral = false;
  if (accepted)
  {
    stream.admitted = generation_;
    last_accepted_ = now;
  }
  else if (reason(holds) != LockReason::None)
  {
    stream.admitted = 0;
  }
}

void Interlock::zeroed(TimePoint now, const Publisher& publisher)
{
  Stream& stream = book(now, publisher);
  stream.neutral = true;
  stream.nonzero = false;
  // What was moving is on its way to rest, and the stop of a 0 keeps trying by itself: nothing is left for the command
  // watchdog.
  last_accepted_.reset();
}

void Interlock::nearlyZeroed(TimePoint now, const Publisher& publisher)
{
  // Neither a message nor a 0: a stream that passes through zero must not get past a lock that way, and one that rests near
  // zero is silent all the while.
  hear(now, publisher).nonzero = false;
  last_accepted_.reset();
}

void Interlock::resting()
{
  last_accepted_.reset();
}

std::optional<TimePoint> Interlock::watchdogAt() const
{
  if (!last_accepted_ || command_timeout_ <= Duration::zero())
  {
    return std::nullopt;
  }
  return *last_accepted_ + command_timeout_;
}

bool Interlock::watchdogDue(TimePoint now) const
{
  const auto due = watchdogAt();
  return due && now >= *due;
}

bool Interlock::locked(TimePoint now, const Holds& holds) const
{
  if (offline_ || stop_pending_ || reason(holds) != LockReason::None)
  {
    return true;
  }
  const bool somebody_is_free = std::any_of(streams_.begin(), streams_.end(), [this](const auto& stream) {
    return stream.second.neutral || stream.second.admitted == generation_;
  });
  if (somebody_is_free)
  {
    return false;
  }
  return !silent(now, nullptr) || !std::all_of(streams_.begin(), streams_.end(),
                                               [&](const auto& stream) { return silent(now, &stream.second); });
}

Duration Interlock::silenceNeeded() const
{
  return std::max(command_timeout_, seconds(SHORTEST_SILENCE_S));
}

bool Interlock::stopPending() const
{
  return stop_pending_;
}

bool Interlock::isOffline() const
{
  return offline_;
}

bool Interlock::isFaulted() const
{
  return faulted_;
}

unsigned Interlock::activePublishers(TimePoint now) const
{
  return static_cast<unsigned>(std::count_if(streams_.begin(), streams_.end(), [&](const auto& stream) {
    return stream.second.nonzero && now - *stream.second.last < seconds(ACTIVE_PUBLISHER_S);
  }));
}
}  // namespace bus
}  // namespace inverter_bus

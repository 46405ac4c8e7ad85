// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/stop_job.h"

#include <utility>

namespace inverter_bus
{
namespace bus
{
namespace
{
// A stop that was confirmed so often in a row, and asked for again within so short a time, is part of a flood.
constexpr unsigned FLOOD_OF_STOPS = 8;
constexpr double FLOOD_PAUSE_S = 0.5;

// What every drive with a confirmed stop command has.
const char* const DECELERATION = "stop";

const char* sequenceName(StopMode mode)
{
  // No default: a mode that is new in the enum doesn't compile before it has a sequence.
  switch (mode)
  {
    case StopMode::Decelerate:
      return DECELERATION;
    case StopMode::Coast:
      return "coast";
    case StopMode::Quick:
      return "quick";
  }
  return DECELERATION;
}
}  // namespace

std::optional<StopMode> stopModeOf(std::uint8_t number)
{
  const auto mode = static_cast<StopMode>(number);
  // No default: a mode that is new in the enum doesn't compile before it is here.
  switch (mode)
  {
    case StopMode::Decelerate:
    case StopMode::Coast:
    case StopMode::Quick:
      return mode;
  }
  return std::nullopt;
}

StopJob::StopJob(const drive::Drive& drive, std::uint8_t station) : drive_(drive), station_(station)
{
}

std::string StopJob::sequenceFor(StopMode mode) const
{
  const char* const own = sequenceName(mode);
  return drive_.sequence(own) != nullptr ? own : DECELERATION;
}

void StopJob::request(TimePoint now, StopMode mode)
{
  if (pending_ && (mode == mode_ || mode == StopMode::Decelerate))
  {
    return;
  }
  if (!pending_)
  {
    attempts_ = 0;
    repeats_ = confirmed_ && now - last_sent_at_ < seconds(FLOOD_PAUSE_S) ? repeats_ + 1 : 0;
    confirmed_ = false;
    told_costly_ = false;
  }
  pending_ = sequenceFor(mode) != "stop" || drive_.sequence("stop") != nullptr;
  mode_ = mode;
  step_ = 0;
  acknowledged_in_doubt_ = false;
  wants_clear_line_ = false;
  ++version_;
  requested_at_ = now;
  first_frame_left_ = false;
  first_frame_answered_ = false;
  provisional_ = false;
  last_error_ = 0;
}

bool StopJob::pending() const
{
  return pending_;
}

bool StopJob::askedSince(TimePoint time) const
{
  return pending_ && !first_frame_left_ && attempts_ == 0 && requested_at_ >= time;
}

unsigned StopJob::attempts() const
{
  return attempts_;
}

bool StopJob::written() const
{
  return step_ >= drive_.sequence(sequenceFor(mode_))->steps.size();
}

bool StopJob::repeats() const
{
  return repeats_ >= FLOOD_OF_STOPS;
}

bool StopJob::takeCostly()
{
  return !std::exchange(told_costly_, true);
}

TimePoint StopJob::lastSentAt() const
{
  return last_sent_at_;
}

wire::Request StopJob::next() const
{
  if (written())
  {
    return drive_.read(station_, *drive_.runBlock());
  }
  return drive_.command(station_, drive_.sequence(sequenceFor(mode_))->steps[step_]);
}

std::optional<Duration> StopJob::sent(TimePoint now)
{
  version_on_wire_ = version_;
  provisional_ = false;
  last_sent_at_ = now;
  if (first_frame_left_)
  {
    return std::nullopt;
  }
  first_frame_left_ = true;
  return now - requested_at_;
}

StopJob::Progress StopJob::done(const wire::Reply& reply, bool may_be_late)
{
  if (version_on_wire_ != version_)
  {
    // The mode was upgraded while this frame was on its way: its answer says nothing of the new one.
    return Progress::GoesOn;
  }
  if (written() && isLastingRefusal(reply) && !has_told_)
  {
    // Such a read has never worked on this drive: it can't report RUN, so the acknowledged write must suffice.
    return confirmByAcknowledgement();
  }
  if (reply.outcome != wire::Outcome::Ok)
  {
    // A read-back that got lost says nothing: RUN may be on or off, so the whole attempt starts again.
    return fail(reply.error_id);
  }
  if (!written())
  {
    ++step_;
    acknowledged_in_doubt_ = acknowledged_in_doubt_ || may_be_late;
    return written() && !drive_.runBlock() ? confirmByAcknowledgement() : Progress::GoesOn;
  }
  drive::Monitor monitor;
  drive_.decode(*drive_.runBlock(), reply.pdu, monitor);
  has_told_ = true;
  // A word that means nothing is no proof that RUN is off.
  const bool still_on = monitor.run_seen.value_or(true);
  if (still_on)
  {
    return fail(0);
  }
  confirm();
  return Progress::Confirmed;
}

/// The drive can't report whether RUN is off: its acknowledgement counts, unless it may belong to another request.
StopJob::Progress StopJob::confirmByAcknowledgement()
{
  if (acknowledged_in_doubt_)
  {
    const Progress progress = fail(wire::ERROR_TIMEOUT);
    wants_clear_line_ = true;
    return progress;
  }
  confirm();
  return Progress::Confirmed;
}

StopJob::Progress StopJob::fail(std::uint16_t error_id)
{
  last_error_ = error_id;
  step_ = 0;
  acknowledged_in_doubt_ = false;
  // A loop-back and a write take turns: RUN may still be on.
  wants_clear_line_ = false;
  ++attempts_;
  return Progress::Failed;
}

void StopJob::writeAgain()
{
  fail(wire::ERROR_TIMEOUT);
}

void StopJob::writeOnceMore()
{
  step_ = 0;
  acknowledged_in_doubt_ = false;
  provisional_ = true;
}

bool StopJob::provisional() const
{
  return provisional_;
}

std::optional<Duration> StopJob::answered(TimePoint now)
{
  if (!first_frame_left_ || first_frame_answered_)
  {
    return std::nullopt;
  }
  first_frame_answered_ = true;
  return now - requested_at_;
}

bool StopJob::wantsClearLine() const
{
  return wants_clear_line_;
}

void StopJob::hold()
{
  held_ = pending_;
}

bool StopJob::held() const
{
  return held_;
}

void StopJob::confirm()
{
  pending_ = false;
  held_ = false;
  step_ = 0;
  attempts_ = 0;
  acknowledged_in_doubt_ = false;
  wants_clear_line_ = false;
  provisional_ = false;
  confirmed_ = true;
}

void StopJob::cancel()
{
  confirm();
  confirmed_ = false;
}

void StopJob::forgetConfirmation()
{
  confirmed_ = false;
  repeats_ = 0;
}

std::uint16_t StopJob::lastError() const
{
  return last_error_;
}
}  // namespace bus
}  // namespace inverter_bus

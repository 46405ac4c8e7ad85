// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/jobs.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double VERIFY_PERIOD_S = 0.1;
constexpr unsigned VERIFICATIONS_BEFORE_REPEAT = 10;
constexpr unsigned MOST_RESENT = 2;
}  // namespace

ResetJob::ResetJob(const drive::Drive& drive, std::uint8_t station, std::optional<std::uint32_t> unknown_trip)
  : Job(drive, station, CommandKind::Reset)
  , unknown_trip_(unknown_trip)
  , phase_(drive.runBlock() ? Phase::CheckRun : Phase::Steps)
{
}

const drive::ReadBlock& ResetJob::verifyBlock() const
{
  const auto& blocks = drive_.fastBlocks();
  const auto found = std::find_if(blocks.begin(), blocks.end(), [](const drive::ReadBlock& block) {
    return std::find(block.fields.begin(), block.fields.end(), "faulted") != block.fields.end();
  });
  return found == blocks.end() ? blocks.front() : *found;
}

wire::Request ResetJob::next()
{
  pause_ = Duration{ 0 };
  if (phase_ == Phase::CheckRun)
  {
    return drive_.read(station_, *drive_.runBlock());
  }
  if (phase_ == Phase::Verify)
  {
    return drive_.read(station_, verifyBlock());
  }
  if (phase_ == Phase::CheckRestart)
  {
    return drive_.read(station_, drive_.blockOf({ "restarted" }));
  }
  begun_ = true;
  return drive_.command(station_, drive_.sequence("reset")->steps[step_]);
}

bool ResetJob::lasting() const
{
  return phase_ == Phase::Steps;
}

Job::Progress ResetJob::afterStep()
{
  const auto& steps = drive_.sequence("reset")->steps;
  pause_ = seconds(steps[step_].pause);
  const bool silent = !steps[step_].expects_reply;
  ++step_;
  if (silent && drive_.reports("restarted"))
  {
    phase_ = Phase::CheckRestart;
    return Progress::GoesOn;
  }
  phase_ = step_ < steps.size() ? Phase::Steps : Phase::Verify;
  return Progress::GoesOn;
}

/// A step without a reply that got lost on the line is sent again; one that made the drive restart never is.
Job::Progress ResetJob::afterRestartCheck(const wire::Reply& reply)
{
  drive::Monitor monitor;
  drive_.decode(drive_.blockOf({ "restarted" }), reply.pdu, monitor);
  if (!monitor.restarted.value_or(true) && resent_ < MOST_RESENT)
  {
    ++resent_;
    --step_;
  }
  phase_ = step_ < drive_.sequence("reset")->steps.size() ? Phase::Steps : Phase::Verify;
  return Progress::GoesOn;
}

/// Rule 4.8: nothing is sent unless RUN is read as off.
Job::Progress ResetJob::afterRunCheck(const wire::Reply& reply)
{
  drive::Monitor monitor;
  drive_.decode(*drive_.runBlock(), reply.pdu, monitor);
  // A word that means nothing is no proof that RUN is off.
  if (!monitor.run_seen.value_or(true))
  {
    phase_ = Phase::Steps;
    return Progress::GoesOn;
  }
  if (run_was_on_)
  {
    return fail(ERROR_CANCELLED, "RUN is still on after a stop: nothing was reset, since the motor would start");
  }
  run_was_on_ = true;
  return Progress::NeedsStop;
}

Job::Progress ResetJob::notTold()
{
  return succeed("reset sent; this drive can't tell whether the trip is gone: its state is unknown");
}

Job::Progress ResetJob::verify(const wire::Reply& reply)
{
  drive::Monitor monitor;
  drive_.decode(verifyBlock(), reply.pdu, monitor);
  const std::optional<bool> tripped = monitor.tripped();
  if (!tripped)
  {
    return notTold();
  }
  if (!*tripped)
  {
    return succeed(unknown_trip_ ? "reset sent: the unknown state " + std::to_string(*unknown_trip_) + " is gone"
                                 : "trip cleared");
  }
  // Some causes (overheat, a safe stop that is still open) keep the trip: the bound ends the waiting.
  answer().error_id = wire::ERROR_TIMEOUT;
  answer().message = monitor.unknown_trip
                         ? "reset sent; whether the trip is gone is unknown: " + drive_.tripText(monitor)
                         : "the drive is still tripped after the reset: remove the cause first";
  pause_ = seconds(VERIFY_PERIOD_S);
  if (++still_tripped_ == VERIFICATIONS_BEFORE_REPEAT && drive_.runBlock() &&
      drive_.sequence("reset")->steps.front().expects_reply)
  {
    // Not where each reset makes the drive restart.
    // A reset coil that an earlier master left on gave no edge the first time.
    phase_ = Phase::CheckRun;
    step_ = 0;
  }
  return Progress::GoesOn;
}

Job::Progress ResetJob::refused(const wire::Reply& reply)
{
  if (phase_ == Phase::CheckRun)
  {
    return refusedByDrive(reply, "nothing was reset, since the drive does not report whether RUN is off");
  }
  if (phase_ != Phase::Verify)
  {
    return refusedByDrive(reply, "the drive refused the reset");
  }
  if (isLastingRefusal(reply))
  {
    return notTold();
  }
  // Busy, after all: the reset itself was accepted.
  answer().error_id = reply.error_id;
  answer().message = "reset sent; whether the trip is gone is unknown: " + drive_.exceptionText(reply.error_id);
  pause_ = seconds(VERIFY_PERIOD_S);
  return Progress::GoesOn;
}

Job::Progress ResetJob::done(const wire::Reply& reply)
{
  deafening_ = phase_ == Phase::Steps;
  if (reply.outcome == wire::Outcome::Exception)
  {
    return refused(reply);
  }
  switch (phase_)
  {
    case Phase::CheckRun:
      return afterRunCheck(reply);
    case Phase::Steps:
      return afterStep();
    case Phase::CheckRestart:
      return afterRestartCheck(reply);
    default:
      return verify(reply);
  }
}

Job::Progress ResetJob::lost(const wire::Reply& reply)
{
  if (!clearsWords())
  {
    return Job::lost(reply);
  }
  // Sent again and again to a drive that is away, a step must not prolong its deafness for ever.
  deafening_ = phase_ == Phase::Steps && step_ >= steps_sent_;
  steps_sent_ = deafening_ ? step_ + 1 : steps_sent_;
  // A drive that restarts after a reset is deaf for a while; leaving the reset coil on would hold it in reset.
  answer().error_id = reply.error_id;
  answer().message = "the drive did not answer after the reset";
  pause_ = seconds(VERIFY_PERIOD_S);
  return Progress::GoesOn;
}

bool ResetJob::clearsWords() const
{
  return begun_;
}

Aftermath ResetJob::aftermath() const
{
  Aftermath aftermath;
  aftermath.connect_again = clearsWords();
  return aftermath;
}

bool ResetJob::takeDeafening()
{
  const bool deafening = deafening_;
  deafening_ = false;
  return deafening;
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>
#include <cmath>
#include <string>

#include "fuzz/bus/checker.h"

// Contract, 8.1 and 8.15: nobody takes another one's turn, and alive means data.

namespace inverter_bus
{
namespace fuzz
{
namespace
{
// After a lost exchange what is alike waits for a while (rule 3.9).
constexpr double BARRED_S = 3.0;
// Of a drive's own time-out: before it has passed, the drive is not late yet, but it has the next turn.
constexpr double NEAR_SHARE = 0.95;
// Coarser than the rounding of every brand.
constexpr double SET_POINT_STEP_HZ = 0.051;
// Three refresh periods as the losses themselves stretch them, the one before and the one that is under way.
constexpr unsigned FAILED_TURNS = 5;
constexpr int PERIODS = 3;
constexpr double BAR_S = 1.0;
// A VF-S15 starts anew; no profile says more.
constexpr double DEAF_AFTER_RESET_S = 3.0;
}  // namespace

/// Somebody has asked for something of this inverter before the last exchange began, and nothing of it has been sent; or its
/// own time-out is near.
bool Checker::waits(TimePoint now, std::size_t index) const
{
  const Lane& lane = lanes_[index];
  if (!online(index) || lane.stopping || (lane.lost_at != TimePoint() && now - lane.lost_at < seconds(BARRED_S)))
  {
    return false;
  }
  // Commanded once more what is in force already: there is nothing to send.
  const bool in_force = lane.run_answered && lane.run_reverse == (lane.hertz < 0.0) && lane.held &&
                        std::fabs(*lane.held - std::fabs(lane.hertz)) < SET_POINT_STEP_HZ;
  // The dead man ends a command of which nothing was sent as well.
  const bool commanded = lane.permit && lane.fed && !lane.settled && !in_force && lane.run_copies == 0 &&
                         lane.set_copies + lane.run_set_copies == 0 && !lane.set_answered &&
                         lane.accepted_at < turn_began_;
  const double timeout = scene_.inverters[index].drive_timeout;
  const bool near = timeout > 0.0 && lane.timeout_known && lane.status.run_command && lane.last_heard &&
                    now - *lane.last_heard > seconds(NEAR_SHARE * timeout);
  return commanded || near;
}

/// But for stops, who did not answer gets no second exchange while another one waits or has a deadline. (Answered frames
/// that belong together are short; that they alternate is held by the scheduler's own tests.)
void Checker::checkTurn(TimePoint now)
{
  const std::optional<std::size_t> last = turn_of_;
  // Before a stop that a late reply could answer goes a loop-back, also before that of a 0.
  const bool before_stop = facts_.loopback && facts_.inverter && !lanes_[*facts_.inverter].permit;
  const bool of_stop =
      facts_.broadcast || facts_.stop || before_stop || (facts_.inverter && lanes_[*facts_.inverter].stopping);
  turn_of_ = of_stop ? std::optional<std::size_t>() : facts_.inverter;
  // The lowest class has every eighth exchange, whoever waits.
  const bool again = turn_of_ && last == turn_of_ && !answered_before_ && !facts_.reads_parameter && !shutting_down_;
  for (std::size_t index = 0; again && index < lanes_.size(); ++index)
  {
    if (index != *turn_of_ && waits(now, index))
    {
      fail(now, "nobody takes another one's turn",
           nameOf(*turn_of_) + " gets two exchanges in a row while " + nameOf(index) +
               " waits: " + simulation::toHex(request_));
    }
  }
  turn_began_ = now;
}

/// A velocity is bounded whatever follows it: after 1 + retries lost frames of an inverter that may run a stop is next. The
/// copies of one velocity are counted elsewhere; here newer ones may have come meanwhile.
void Checker::checkBounded(TimePoint now) const
{
  if (!facts_.inverter || !facts_.commands() || facts_.stop || shutting_down_)
  {
    return;
  }
  const Lane& lane = lanes_[*facts_.inverter];
  if ((lane.run_answered || lane.run_sent) && lane.lost_frames > scene_.retries)
  {
    fail(now, "a velocity is bounded whatever follows it",
         nameOf(*facts_.inverter) + " is sent one more velocity after " + std::to_string(lane.lost_frames) +
             " lost frames");
  }
}

/// An inverter that has failed so often and shown no complete status since is published as offline, whatever else it
/// answers. Who could not be asked, since the wire was taken by others, is not: nobody is offline because of them.
void Checker::checkBlindness(TimePoint now) const
{
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    const Lane& lane = lanes_[index];
    const Duration blind = now - std::max(lane.status.stamp, lane.deaf_until);
    const bool watched = connected_ && !shutting_down_ && lane.online && !lane.stopping &&
                         lane.failed_reads >= FAILED_TURNS * (1 + scene_.retries);
    // What was lost bars its like for a second, and so stretches its own turn.
    const Duration own = seconds(BAR_S) + (1 + scene_.retries) * scene_.longestExchange();
    const Duration period = std::max({ lane.pause, lane.pause_before, own });
    const Duration patience = std::max(seconds(scene_.longestBlindness()), PERIODS * period);
    if (watched && blind > patience + babble(now))
    {
      fail(now, "alive means data",
           nameOf(index) + " is shown as online, its last complete status is " + std::to_string(toSeconds(blind)) +
               " s old");
    }
  }
}

void Checker::noteFailedRead()
{
  Lane& lane = lanes_[*facts_.inverter];
  const bool failed = !answered_ || lane.exception_at >= sent_at_;
  lane.failed_reads += facts_.reads && !facts_.reads_parameter && failed ? 1 : 0;
  if (facts_.reset)
  {
    lane.deaf_until = now_() + seconds(DEAF_AFTER_RESET_S);
  }
  // Each refresh has one of these, and nothing else has.
  if (facts_.reads_frequency)
  {
    lane.pause = lane.asked_at == TimePoint() ? lane.pause : std::max(lane.pause, sent_at_ - lane.asked_at);
    lane.asked_at = sent_at_;
  }
}

/// Nobody is offline because others are.
void Checker::checkWentOffline(TimePoint now, std::size_t index) const
{
  const Lane& lane = lanes_[index];
  const Duration lately = seconds(scene_.longestBlindness());
  // Published before anybody has said that the exchange is over.
  const bool just_now = in_flight_ && facts_.inverter == index && !answered_;
  const bool lost = just_now || (lane.lost_at != TimePoint() && now - lane.lost_at < lately);
  const bool refused = lane.exception_at != TimePoint() && now - lane.exception_at < lately;
  const bool broken = !connected_ || now - connected_since_ < lately;
  if (!lost && !refused && !broken)
  {
    fail(now, "a healthy drive is not shown as offline",
         nameOf(index) + " has answered everything that it was asked lately");
  }
}
}  // namespace fuzz
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/liveness.h"

#include <algorithm>

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
namespace
{
// Three refresh periods as the losses themselves stretch them, the one before and the one that is under way.
constexpr unsigned FAILED_TURNS = 5;
constexpr int PERIODS = 3;
constexpr double BAR_S = 1.0;
}  // namespace

Liveness::Liveness(const Observed& observed) : observed_(observed), lanes_(observed.inverters.size())
{
}

void Liveness::answered(TimePoint now, std::size_t index, const ReplyFacts& reply)
{
  lanes_[index].refused_at = reply.good ? lanes_[index].refused_at : now;
}

void Liveness::ended()
{
  const Exchange& exchange = observed_.exchange;
  if (!exchange.facts.inverter)
  {
    return;
  }
  Lane& lane = lanes_[*exchange.facts.inverter];
  const bool failed = !exchange.answered || lane.refused_at >= exchange.began;
  lane.failed_reads += exchange.facts.reads && !exchange.facts.reads_parameter && failed ? 1 : 0;
  // Each refresh has one of these, and nothing else has.
  if (exchange.facts.reads_frequency)
  {
    lane.pause = lane.asked_at == TimePoint() ? lane.pause : std::max(lane.pause, exchange.began - lane.asked_at);
    lane.asked_at = exchange.began;
  }
}

/// An inverter that could not be asked, since the wire was taken by others, is not blind.
void Liveness::checkAlive(TimePoint now) const
{
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    const InverterRecord& inverter = observed_.inverters[index];
    const Duration blind = now - std::max(inverter.told.status.stamp, inverter.link.deaf_until);
    const int turns = static_cast<int>(FAILED_TURNS) * (1 + observed_.scene.retries);
    const bool watched = observed_.connected && !observed_.shutting_down && inverter.told.online &&
                         !inverter.stop.active && lanes_[index].failed_reads >= static_cast<unsigned>(turns);
    if (watched && blind > patience(index) + observed_.babble(now))
    {
      fail(now, "alive means data",
           observed_.scene.title(index) + " is shown as online, its last complete status is " +
               std::to_string(toSeconds(blind)) + " s old");
    }
  }
}

Duration Liveness::patience(std::size_t index) const
{
  // What was lost bars its like for a second, and so stretches its own turn.
  const Duration own = seconds(BAR_S) + (1 + observed_.scene.retries) * observed_.scene.longestExchange();
  const Duration period = std::max({ lanes_[index].pause, lanes_[index].pause_before, own });
  return std::max(seconds(observed_.scene.longestBlindness()), PERIODS * period);
}

void Liveness::checkWentOffline(TimePoint now, std::size_t index) const
{
  const TimePoint lost_at = observed_.inverters[index].link.lost_at;
  const TimePoint refused_at = lanes_[index].refused_at;
  const Duration lately = seconds(observed_.scene.longestBlindness());
  const Exchange& exchange = observed_.exchange;
  // Published before the exchange was reported as over.
  const bool just_now = exchange.in_flight && exchange.facts.inverter == index && !exchange.answered;
  const bool lost = just_now || (lost_at != TimePoint() && now - lost_at < lately);
  const bool refused = refused_at != TimePoint() && now - refused_at < lately;
  const bool broken = !observed_.connected || now - observed_.connected_since < lately;
  if (!lost && !refused && !broken)
  {
    fail(now, "a healthy drive is not shown as offline",
         observed_.scene.title(index) + " has answered everything that it was asked lately");
  }
}

void Liveness::published(const bus::InverterStatus& status)
{
  const Told& told = observed_.inverters[status.index].told;
  if (told.any && status.stamp == told.status.stamp && !status.communication_error)
  {
    return;
  }
  Lane& lane = lanes_[status.index];
  lane.failed_reads = 0;
  lane.pause_before = lane.pause;
  lane.pause = Duration{ 0 };
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

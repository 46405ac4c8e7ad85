// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/values.h"

#include <algorithm>
#include <cmath>

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
namespace
{
constexpr std::size_t KEPT_ENDS = 512;
constexpr std::size_t KEPT_READS = 64;
constexpr std::size_t READS_IN_QUESTION = 3;  // a reset's or a probe's read may come beside the refresh's
constexpr double KEPT_SAMPLES_S = 120.0;
constexpr double OLDEST_SLOW_VALUE_S = 10.0;  // contract, 8.3: in any case, and so many periods
constexpr double OLDEST_SLOW_VALUE_PERIODS = 2.5;
constexpr double LONG_TURNING_S =
    1.5;  // beside changing velocities of eight drives at 9600 baud a status is read in 0.6 s
constexpr double TORQUE_TOLERANCE = 1.5;  // [%] of rated: drives report whole percents
constexpr double MEMORY_OF_LATE_S = 2.0;  // the longest bar, and the exchange that it lets through
}  // namespace

Values::Values(const Observed& observed, Plant& plant)
  : observed_(observed), plant_(plant), lanes_(observed.inverters.size())
{
}

void Values::begins(TimePoint now)
{
  const std::optional<std::size_t> index = observed_.exchange.facts.inverter;
  if (!index)
  {
    return;
  }
  plant_.advance(now, *index);
  const Truth seen = plant_.truth(*index);
  Lane& lane = lanes_[*index];
  lane.least = seen.hertz;
  lane.most = seen.hertz;
  lane.sign = seen.direction;
}

void Values::widen(std::size_t index)
{
  Lane& lane = lanes_[index];
  const Truth seen = plant_.truth(index);
  // It may have reversed meanwhile.
  lane.least = seen.direction * lane.sign < 0 ? 0.0 : std::min(lane.least, seen.hertz);
  lane.most = std::max(lane.most, seen.hertz);
  lane.sign = seen.direction;
}

void Values::glance(TimePoint now, std::size_t index)
{
  plant_.advance(now, index);
  widen(index);
  sample(now, index);
}

void Values::heard(TimePoint now, std::size_t index)
{
  widen(index);
  sample(now, index);
}

void Values::sample(TimePoint now, std::size_t index)
{
  std::deque<Sample>& samples = lanes_[index].samples;
  const Truth seen = plant_.truth(index);
  std::optional<TimePoint>& since = lanes_[index].turning_since;
  since = seen.hertz > 0.0 ? since.value_or(now) : std::optional<TimePoint>();
  if (seen.torque)
  {
    samples.push_back({ now, *seen.torque });
  }
  while (!samples.empty() && now - samples.front().time > seconds(KEPT_SAMPLES_S))
  {
    samples.pop_front();
  }
}

void Values::answered(TimePoint now, std::size_t index, const ReplyFacts& reply)
{
  Lane& lane = lanes_[index];
  lane.ends.push_back(now);
  if (lane.ends.size() > KEPT_ENDS)
  {
    lane.ends.pop_front();
  }
  if (!observed_.exchange.facts.reads_frequency || !reply.good)
  {
    return;
  }
  widen(index);
  lane.frequencies.push_back({ now, lane.least, lane.most });
  if (lane.frequencies.size() > KEPT_READS)
  {
    lane.frequencies.pop_front();
  }
}

void Values::ended(TimePoint now)
{
  if (!observed_.exchange.facts.inverter)
  {
    return;
  }
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    plant_.advance(now, index);
    sample(now, index);
  }
}

void Values::check(TimePoint now, const bus::InverterStatus& status)
{
  plant_.advance(now, status.index);
  sample(now, status.index);
  checkStamp(now, status);
  checkFrequency(now, status);
  checkRunning(now, status);
  checkTorque(now, status);
}

/// Of drives whose running bit follows the motor. It may be read a moment before the frequency: only a motor that has been
/// turning for long counts.
void Values::checkRunning(TimePoint now, const bus::InverterStatus& status) const
{
  const std::optional<TimePoint>& since = lanes_[status.index].turning_since;
  const bool follows = observed_.scene.inverters[status.index].brand == Brand::HITACHI;
  const bool long_enough = follows && since && status.has_stamp && status.stamp - *since > seconds(LONG_TURNING_S);
  if (long_enough && !status.monitor.running.value_or(true))
  {
    fail(now, "a motor that turns is not shown at rest",
         observed_.scene.title(status.index) + ": running is false, and the motor has been turning for " +
             decimal(toSeconds(status.stamp - *since)) + " s");
  }
}

void Values::checkStamp(TimePoint now, const bus::InverterStatus& status) const
{
  const std::deque<TimePoint>& ends = lanes_[status.index].ends;
  const TimePoint imitated_at = observed_.inverters[status.index].link.imitated_at;
  const bool imitated = imitated_at != TimePoint() && now - imitated_at < seconds(MEMORY_OF_LATE_S);
  const bool of_a_reply = std::find(ends.begin(), ends.end(), status.stamp) != ends.end();
  if (!ends.empty() && status.stamp >= ends.front() && !of_a_reply && !imitated)
  {
    fail(
        now, "no value from another request's reply",
        observed_.scene.title(status.index) + ": the stamp is not the end of a reply to a request that was waited for");
  }
}

void Values::checkFrequency(TimePoint now, const bus::InverterStatus& status)
{
  const std::deque<FrequencyRead>& frequencies = lanes_[status.index].frequencies;
  const std::optional<double>& hertz = status.monitor.output_frequency;
  if (!hertz || frequencies.empty() || status.stamp < frequencies.front().end)
  {
    return;
  }
  ++compared_;
  const double tolerance = observed_.scene.inverters[status.index].brand == Brand::JE ? 0.11 : 0.021;
  std::size_t looked_at = 0;
  bool fits = false;
  std::string seen;
  for (auto read = frequencies.rbegin(); read != frequencies.rend() && looked_at < READS_IN_QUESTION; ++read)
  {
    if (read->end <= status.stamp)
    {
      ++looked_at;
      fits = fits || (*hertz >= read->least - tolerance && *hertz <= read->most + tolerance);
      seen += " " + decimal(read->least) + "-" + decimal(read->most);
    }
  }
  if (looked_at > 0 && !fits)
  {
    fail(now, "no value older than its stamp, none from another drive",
         observed_.scene.title(status.index) + ": published " + decimal(*hertz) + " Hz, the motor had" + seen + " Hz");
  }
}

void Values::checkTorque(TimePoint now, const bus::InverterStatus& status) const
{
  const std::deque<Sample>& samples = lanes_[status.index].samples;
  const std::optional<double>& torque = status.monitor.torque;
  // A status that is published once more keeps its stamp and what was read with it; the rest is as old as it may be.
  const double periods = OLDEST_SLOW_VALUE_PERIODS * toSeconds(observed_.scene.longestSlowPeriod());
  const Duration age = seconds(std::max(OLDEST_SLOW_VALUE_S, periods)) + observed_.scene.longestExchange();
  const TimePoint oldest = std::min(status.stamp, now) - age;
  if (!torque || samples.empty() || samples.front().time > oldest)
  {
    return;
  }
  double least = 1e9;
  double most = -1e9;
  for (const Sample& sample : samples)
  {
    const bool counts = (sample.time >= oldest && sample.time <= status.stamp) || sample.time >= now - age;
    least = counts ? std::min(least, sample.torque) : least;
    most = counts ? std::max(most, sample.torque) : most;
  }
  if (least <= most && (std::fabs(*torque) < least - TORQUE_TOLERANCE || std::fabs(*torque) > most + TORQUE_TOLERANCE))
  {
    fail(now, "slow values are not older than 2.5 periods, or 10 s",
         observed_.scene.title(status.index) + ": published torque " + decimal(*torque) + " %, within the last " +
             decimal(toSeconds(age)) + " s it was " + decimal(least) + " to " + decimal(most) + " %");
  }
}

std::uint64_t Values::compared() const
{
  return compared_;
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

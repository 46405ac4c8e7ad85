// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
constexpr double QUIET_S = 0.006;      // a 3G3JE wants 5 ms
constexpr double TURNAROUND_S = 0.03;  // after a broadcast, with a margin
constexpr double BABBLE_S = 0.15;      // settle() waits at most 0.1 s for a line that is not silent
constexpr double DISTURBANCE_S = 0.5;
}  // namespace

Observed::Observed(const Scene& scene) : scene(scene), inverters(scene.inverters.size())
{
}

bool Observed::online(std::size_t index) const
{
  return inverters[index].told.online && connected;
}

bool Observed::isRepeat(std::size_t index, const bus::Publisher& publisher) const
{
  const auto& streams = inverters[index].streams;
  const auto stream = streams.find(publisher.name);
  return publisher.latched && publisher.first_on_connection && stream != streams.end() &&
         stream->second.topics.count(publisher.topic) != 0;
}

Duration Observed::quiet() const
{
  return scene.compoway ? seconds(QUIET_S) : Duration{ 0 };
}

Duration Observed::babble(TimePoint now) const
{
  return disturbed_at != TimePoint() && now - disturbed_at < seconds(DISTURBANCE_S) ? seconds(BABBLE_S) : Duration{ 0 };
}

bool Observed::decidedBefore(TimePoint now, TimePoint time) const
{
  const bool prolonged = scene.compoway && time != TimePoint() && heard_in_between > time - quiet();
  return now - time < quiet() || prolonged;
}

Duration Observed::longestWait(TimePoint now) const
{
  return scene.longestExchange() + 2 * scene.gap() + seconds(QUIET_S + TURNAROUND_S) + babble(now);
}
}  // namespace fuzz
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/told_locks.h"

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
constexpr double LONGEST_OF_A_STREAM_S = 5.0;  // contract, rule 4.2
}  // namespace

ToldLocks::ToldLocks(const Observed& observed) : observed_(observed), lanes_(observed.inverters.size())
{
}

void ToldLocks::told(TimePoint now, std::size_t index, bool locked)
{
  lanes_[index].locked = locked;
  lanes_[index].locked_at = locked ? now : lanes_[index].locked_at;
}

void ToldLocks::check(TimePoint now, std::size_t index, const bus::Publisher& publisher, std::uint16_t result) const
{
  const bool locked = lanes_[index].locked;
  const bool old_message = publisher.latched && publisher.first_on_connection;
  if (result == bus::ERROR_LOCKED && !locked && !old_message && hasReturned(now, index, publisher.name))
  {
    fail(now, "a lock is reported",
         observed_.scene.title(index) + " refuses a velocity of " + publisher.name +
             " as locked, which has returned to neutral, while its status says that it is free");
  }
  const bool accepted = result == 0 && !observed_.isRepeat(index, publisher);
  if (accepted && locked && isAlone(index, publisher.name))
  {
    fail(now, "a lock is reported",
         observed_.scene.title(index) + " takes a velocity of " + publisher.name +
             ", which alone commands it, while its status says that it is locked");
  }
}

/// It has sent 0 since, or nothing for as long as any silence has to be.
bool ToldLocks::hasReturned(TimePoint now, std::size_t index, const std::string& publisher) const
{
  const TimePoint locked_at = lanes_[index].locked_at;
  const auto& streams = observed_.inverters[index].streams;
  const auto stream = streams.find(publisher);
  if (stream == streams.end())
  {
    return now - locked_at >= longestSilence(index);
  }
  const TimePoint last = stream->second.last;
  const bool zeroed = stream->second.zeroed_at == last && last > locked_at;
  return zeroed || now - std::max(locked_at, last) >= longestSilence(index);
}

bool ToldLocks::isAlone(std::size_t index, const std::string& publisher) const
{
  const auto& streams = observed_.inverters[index].streams;
  return std::all_of(streams.begin(), streams.end(), [&](const auto& stream) { return stream.first == publisher; });
}

/// Of any publisher, however slowly it sends.
Duration ToldLocks::longestSilence(std::size_t index) const
{
  const double timeout = observed_.scene.inverters[index].command_timeout;
  return seconds(std::max(timeout, LONGEST_OF_A_STREAM_S) + SILENCE_TOLERANCE_S);
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

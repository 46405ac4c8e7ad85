// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/user_watch.h"

#include <algorithm>

#include "fuzz/bus/limits.h"

namespace inverter_bus
{
namespace fuzz
{
UserWatch::UserWatch(Checks& checks) : checks_(checks)
{
}

void UserWatch::commanded(TimePoint now, const bus::VelocityCommand& command, const std::vector<bool>& locked,
                          std::uint16_t result)
{
  checks_.commands.check(now, command, result);
  checkTold(now, command, locked, result);
  const Scene& scene = checks_.observed.scene;
  // A repeat is ignored, with all that it carries for other inverters.
  const bool repeat = std::any_of(command.targets.begin(), command.targets.end(), [&](const auto& target) {
    return moves(scene.inverters[target.first], target.second) &&
           checks_.observed.isRepeat(target.first, command.publisher);
  });
  const double factor = groupFactor(scene, command);
  for (const auto& target : command.targets)
  {
    if (target.second == 0.0)
    {
      takeZero(now, target.first, command.publisher);
    }
    else if (isNearZero(scene.inverters[target.first], target.second))
    {
      // For the lock it is as if nothing had come, but its publisher has been heard.
      checks_.recorder.bookedNearZero(target.first, command.publisher);
      takeRunOff(now, target.first);
    }
    else if (result == 0 && !repeat)
    {
      accept(now, target.first, target.second * factor, command.publisher);
    }
    else if (!repeat)
    {
      refuse(now, target.first, command.publisher);
    }
  }
}

void UserWatch::checkTold(TimePoint now, const bus::VelocityCommand& command, const std::vector<bool>& locked,
                          std::uint16_t result)
{
  for (std::size_t position = 0; position < locked.size(); ++position)
  {
    checks_.told_locks.told(now, command.targets[position].first, locked[position]);
  }
  const auto& target = command.targets.front();
  // Of a group only the answer for all is known.
  if (command.targets.size() == 1 && moves(checks_.observed.scene.inverters[target.first], target.second))
  {
    checks_.told_locks.check(now, target.first, command.publisher, result);
  }
}

void UserWatch::accept(TimePoint now, std::size_t index, double velocity, const bus::Publisher& publisher)
{
  checks_.locks.check(now, index, publisher);
  checks_.recorder.booked(now, index, publisher, false);
  checks_.locks.admitted(index, publisher.name);
  checks_.recorder.accepted(now, index, velocity * checks_.observed.scene.inverters[index].hz_per_unit, publisher.name);
  checks_.refusals.forget(index);
  checks_.zeros.drop(index);
}

void UserWatch::refuse(TimePoint now, std::size_t index, const bus::Publisher& publisher)
{
  checks_.recorder.booked(now, index, publisher, false);
  checks_.locks.booked(index, publisher.name, false);
  checks_.refusals.refused(now, index);
}

void UserWatch::takeZero(TimePoint now, std::size_t index, const bus::Publisher& publisher)
{
  checks_.recorder.booked(now, index, publisher, true);
  checks_.locks.booked(index, publisher.name, true);
  takeRunOff(now, index);
}

void UserWatch::takeRunOff(TimePoint now, std::size_t index)
{
  checks_.zeros.commanded(now, index);
  checks_.cut_waits.zeroCame();
  checks_.bounded_velocities.wantedOff();
  checks_.refusals.forget(index);
  checks_.forbid(now, index);
}

checks::Services::Callback UserWatch::stopCalled(TimePoint now, std::optional<std::size_t> index, double bound)
{
  const Scene& scene = checks_.observed.scene;
  const std::string what = index ? "stop of " + scene.inverters[*index].name : std::string("stop of all");
  return checks_.services.asked(what, bound, [this, index, asked_at = now](const bus::Answer& /*answer*/) {
    for (std::size_t one = 0; one < checks_.observed.inverters.size(); ++one)
    {
      if (!index || *index == one)
      {
        checks_.confirmed_stops.check(checks_.clock.now(), one, asked_at);
      }
    }
  });
}

void UserWatch::stopRequested(TimePoint now, std::optional<std::size_t> index)
{
  for (std::size_t one = 0; one < checks_.observed.inverters.size(); ++one)
  {
    if (index && *index != one)
    {
      continue;
    }
    if (!checks_.observed.online(one))
    {
      // Its stop is tried once immediately, and after that is the probe.
      checks_.probes.allow(1.0);
    }
    checks_.lockUp(now, one, true);
    checks_.zeros.drop(one);
    checks_.stops.requested(now, one);
    if (checks_.stops.waits(one))
    {
      // One of a flood at rest is in no hurry.
      checks_.cut_waits.asked(now, one);
    }
    checks_.bounded_velocities.wantedOff();
    checks_.recorder.stopRequested(one);
  }
}

/// Rule 4.4. The order of these stops is the shutdown's own.
void UserWatch::shutdownBegun(TimePoint now)
{
  checks_.recorder.shutdownBegun();
  for (std::size_t index = 0; index < checks_.observed.inverters.size(); ++index)
  {
    checks_.lockUp(now, index, true);
    checks_.stops.drop(index);
    checks_.zeros.drop(index);
    // One frame to each that is offline.
    checks_.probes.allow(1.0);
  }
}

void UserWatch::shutdownEnded(TimePoint now, TimePoint begun, const std::vector<std::string>& unconfirmed) const
{
  checks_.shutdown.checkDuration(now, begun);
  checks_.services.checkNoneLeft(now);
  checks_.shutdown.checkDrives(now, begun, unconfirmed);
}
}  // namespace fuzz
}  // namespace inverter_bus

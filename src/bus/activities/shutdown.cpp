// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/shutdown.h"

#include <algorithm>
#include <utility>

namespace inverter_bus
{
namespace bus
{
namespace
{
/// At shutdown stops take turns: every one is written before the first of them is read back, so that no motor waits for
/// another's confirmation; nor for one whose stop is requested again and again.
bool goesBefore(const StopJob& stop, const StopJob& other)
{
  return std::make_pair(stop.attempts(), stop.lastSentAt()) < std::make_pair(other.attempts(), other.lastSentAt());
}
}  // namespace

Shutdown::Shutdown(BusState& bus, const GatewayTraffic& traffic, Stops& stops, Services& services)
  : bus_(bus)
  , traffic_(traffic)
  , stops_(stops)
  , services_(services)
  , tried_(bus.inverters.size(), false)
  , released_(bus.inverters.size(), false)
{
}

void Shutdown::begin(TimePoint now)
{
  bus_.shutting_down = true;
  const double two_exchanges_each =
      2.0 * toSeconds(bus_.budget.longest_exchange) * static_cast<double>(bus_.inverters.size());
  // Never over 10 s (contract, 4.4), the exchange that is under way then included.
  const double longest = std::max(2.0, 9.9 - toSeconds(bus_.budget.longest_exchange));
  double needed = std::max(2.0, two_exchanges_each);
  for (const auto& inverter : bus_.inverters)
  {
    // A stop that an old RUN in a gateway could follow counts only after it (contract, 8.8).
    const auto danger = bus_.gateway.motionUntil(now, inverter->index);
    needed = danger ? std::max(needed, toSeconds(*danger - now) + two_exchanges_each) : needed;
  }
  deadline_ = now + seconds(std::min(longest, needed));
  for (const auto& inverter : bus_.inverters)
  {
    services_.fail(inverter->index, ERROR_SHUTTING_DOWN, errorText(ERROR_SHUTTING_DOWN));
    bus_.scheduler.eraseVelocity(inverter->index);
    if (inverter->movement.runPossible() || inverter->stop.pending())
    {
      stops_.request(now, *inverter, StopMode::Decelerate, true, "");
    }
    inverter->movement.drop();
  }
}

Pick Shutdown::pick(TimePoint now)
{
  Pick pick;
  pick.what = Pick::What::Stop;
  const Inverter* best = nullptr;
  for (const auto& inverter : bus_.inverters)
  {
    const bool may_go = inverter->stop.pending() && traffic_.stopNotBefore(now, *inverter) <= now;
    const bool live = may_go && !inverter->link.silent();
    if (live && (best == nullptr || goesBefore(inverter->stop, best->stop)))
    {
      best = inverter.get();
    }
  }
  for (const auto& inverter : bus_.inverters)
  {
    const bool one_frame =
        inverter->stop.pending() && inverter->link.silent() && !tried_[inverter->index] && !untested(*inverter);
    if (best == nullptr && one_frame)
    {
      best = inverter.get();
      tried_[best->index] = true;
    }
  }
  for (const auto& inverter : bus_.inverters)
  {
    if (best == nullptr && releaseDue(*inverter))
    {
      best = inverter.get();
      pick.what = Pick::What::Release;
    }
  }
  if (best == nullptr)
  {
    pick.what = Pick::What::Nothing;
    const TimePoint next = nextStop(now);
    pick.wake = bus_.gateway.active() || next < deadline_ ? std::max(now, std::min(deadline_, next)) : now;
    return pick;
  }
  pick.inverter = best->index;
  return pick;
}

InFlight Shutdown::composeRelease(const Pick& pick)
{
  Inverter& inverter = *bus_.inverters[pick.inverter];
  const drive::Step& step = inverter.drive.sequence("release")->steps.front();
  released_[pick.inverter] = true;
  InFlight current = exchangeFor(pick);
  current.request = inverter.prepared(inverter.drive.command(inverter.config.node, step));
  return current;
}

/// When the next frame of a live inverter's stop that waits for a gateway may go; a silent inverter has had its own.
TimePoint Shutdown::nextStop(TimePoint now) const
{
  TimePoint at = TimePoint::max();
  for (const auto& inverter : bus_.inverters)
  {
    at = inverter->stop.pending() && !inverter->link.silent() ? std::min(at, traffic_.stopNotBefore(now, *inverter))
                                                              : at;
  }
  return at;
}

bool Shutdown::releaseDue(const Inverter& inverter) const
{
  return inverter.config.release_on_exit && !released_[inverter.index] && !inverter.link.offline() &&
         !inverter.stop.pending() && inverter.drive.sequence("release") != nullptr;
}

bool Shutdown::done(TimePoint now)
{
  if (now >= deadline_)
  {
    return true;
  }
  return std::none_of(bus_.inverters.begin(), bus_.inverters.end(), [&](const std::unique_ptr<Inverter>& inverter) {
    const bool untried = !bus_.connected || !inverter->link.silent() || !tried_[inverter->index];
    return (inverter->stop.pending() && untried && !untested(*inverter)) || (bus_.connected && releaseDue(*inverter));
  });
}

std::vector<std::string> Shutdown::end()
{
  bus_.ended = true;
  std::vector<std::string> unconfirmed;
  for (const auto& inverter : bus_.inverters)
  {
    if (inverter->stop.pending() || inverter->movement.runPossible())
    {
      unconfirmed.push_back(stops_.problem(*inverter));
    }
  }
  stops_.refuseCalls();
  return unconfirmed;
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/telnet_stops.h"

#include <algorithm>
#include <tuple>

namespace inverter_bus
{
namespace bus
{
namespace
{
// Failed attempts at a stop over a telnet connection before it is closed.
constexpr unsigned TELNET_STOP_ATTEMPTS = 1;
// How soon a write that waits for the first valid reply of a connection is looked at again.
constexpr double UNPROVEN_PERIOD_S = 0.02;
}  // namespace

TelnetStops::TelnetStops(BusState& bus, Absences& absences)
  : bus_(bus), absences_(absences), attempts_at_open_(bus.inverters.size(), 0)
{
}

void TelnetStops::opened()
{
  found_ = false;
  for (const auto& inverter : bus_.inverters)
  {
    attempts_at_open_[inverter->index] = inverter->stop.attempts();
  }
}

/// Its stop has had its attempts on this connection, in vain.
bool TelnetStops::tried(const Inverter& inverter) const
{
  return inverter.stop.attempts() >= attempts_at_open_[inverter.index] + TELNET_STOP_ATTEMPTS;
}

/// Only stops go over a telnet connection, those of offline inverters as well, and then it is closed.
bool TelnetStops::over(TimePoint now)
{
  if (!bus_.line_watch.facts().telnet_found)
  {
    return false;
  }
  if (!found_)
  {
    found_ = true;
    absences_.loseEverybody(now, wire::ERROR_PORT_LOST);
  }
  return std::none_of(bus_.inverters.begin(), bus_.inverters.end(),
                      [this](const auto& inverter) { return inverter->stop.pending() && !tried(*inverter); });
}

Pick TelnetStops::pick(TimePoint now) const
{
  const auto key = [](const Inverter& inverter) {
    return std::make_tuple(inverter.link.silent(), inverter.stop.attempts(), inverter.stop.lastSentAt());
  };
  Pick pick;
  pick.wake = now;
  for (const auto& inverter : bus_.inverters)
  {
    const bool due = inverter->stop.pending() && !tried(*inverter);
    if (due && (pick.what == Pick::What::Nothing || key(*inverter) < key(*bus_.inverters[pick.inverter])))
    {
      pick.what = Pick::What::Stop;
      pick.inverter = inverter->index;
      pick.probe = inverter->link.silent();
    }
  }
  return pick;
}

/// Nothing but reads and stops goes to a server that may speak telnet (contract, 8.11).
bool TelnetStops::mustWait(TimePoint now, const InFlight& current)
{
  const bool unproven = bus_.configuration.bus.gateway && !bus_.configuration.bus.modbus_tcp &&
                        !bus_.line_watch.facts().proven_since_open;
  const bool writes = current.pick.isCommand();
  if (unproven && writes)
  {
    bus_.scheduler.postpone(current.pick.command, now + seconds(UNPROVEN_PERIOD_S));
  }
  return unproven && (writes || current.pick.what == Pick::What::Release);
}
}  // namespace bus
}  // namespace inverter_bus

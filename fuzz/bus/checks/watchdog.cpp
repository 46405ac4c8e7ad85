// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/watchdog.h"

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
Watchdog::Watchdog(const Observed& observed) : observed_(observed)
{
}

Duration Watchdog::timeout(std::size_t index) const
{
  return seconds(observed_.scene.inverters[index].command_timeout);
}

std::optional<TimePoint> Watchdog::expired(TimePoint now, std::size_t index) const
{
  // The silence before its frame comes after the decision, and a second master's frame in it makes it longer.
  const Duration quiet = observed_.scene.compoway ? observed_.quiet() + observed_.babble(now) : Duration{ 0 };
  const std::optional<TimePoint>& fed = observed_.inverters[index].order.fed;
  if (!fed || timeout(index) == Duration{ 0 } || now - quiet < *fed + timeout(index))
  {
    return std::nullopt;
  }
  return *fed + timeout(index);
}

void Watchdog::checkOverdue(TimePoint now, std::size_t index) const
{
  // The node looks at its watchdogs before each exchange, and wakes up for them while there is none.
  const InverterRecord& inverter = observed_.inverters[index];
  const std::optional<TimePoint>& fed = inverter.order.fed;
  const bool watched = fed && timeout(index) > Duration{ 0 } && inverter.words.run_answered && !inverter.stop.active &&
                       observed_.online(index);
  if (watched && now - *fed > timeout(index) + observed_.longestWait(now))
  {
    fail(now, "the command watchdog stops the inverter",
         observed_.scene.title(index) + " has no command since " + decimal(toSeconds(now - *fed)) + " s and no stop");
  }
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

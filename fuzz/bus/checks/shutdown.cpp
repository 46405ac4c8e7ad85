// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/shutdown.h"

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
constexpr double SHORTEST_S = 2.0;
constexpr double LONGEST_S = 10.0;
}  // namespace

Shutdown::Shutdown(const Observed& observed, const Plant& plant) : observed_(observed), plant_(plant)
{
}

void Shutdown::checkDuration(TimePoint now, TimePoint begun) const
{
  const double exchange = toSeconds(observed_.scene.longestExchange());
  const double two_each = 2.0 * exchange * static_cast<double>(observed_.inverters.size());
  const double bound = std::min(LONGEST_S, std::max(SHORTEST_S, two_each)) + exchange;
  if (now - begun > seconds(bound) + observed_.babble(now))
  {
    fail(now, "shutdown", "takes " + decimal(toSeconds(now - begun)) + " s");
  }
}

void Shutdown::checkDrives(TimePoint now, TimePoint begun, const std::vector<std::string>& unconfirmed) const
{
  for (std::size_t index = 0; index < observed_.inverters.size(); ++index)
  {
    const std::string prefix = observed_.scene.inverters[index].name + ":";
    const bool named = std::any_of(unconfirmed.begin(), unconfirmed.end(), [&](const std::string& text) {
      return text.compare(0, prefix.size(), prefix) == 0;
    });
    const InverterRecord& inverter = observed_.inverters[index];
    const bool commanded = inverter.order.accepted_at != TimePoint();
    if (commanded && !named && plant_.runLatched(index))
    {
      fail(now, "shutdown", observed_.scene.title(index) + " still has RUN on and is not named");
    }
    if (commanded && plant_.runLatched(index) && observed_.online(index) && inverter.stop.sent < begun)
    {
      fail(now, "shutdown", observed_.scene.title(index) + " still has RUN on and was sent no stop");
    }
  }
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

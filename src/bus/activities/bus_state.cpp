// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/bus_state.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
Scheduler::Settings schedulerSettings(const BusConfig& bus)
{
  Scheduler::Settings settings;
  settings.inverters = bus.inverters.size();
  settings.interval = seconds(bus.interval);
  settings.idle_divisor = static_cast<unsigned>(bus.idle_divisor);
  return settings;
}

Duration longestResponseTimeout(const BusConfig& bus)
{
  double longest = bus.response_timeout;
  for (const InverterConfig& inverter : bus.inverters)
  {
    longest = std::max(longest, inverter.response_timeout);
  }
  return seconds(longest);
}
}  // namespace

BusState::BusState(const Configuration& the_configuration, const wire::Line& line)
  : configuration(the_configuration)
  , budget(Budget(configuration, line).figures())
  , scheduler(schedulerSettings(configuration.bus))
  , slow_share(budget.slow)
  , outbox(configuration.bus.inverters.size())
  , refusals(configuration.bus.inverters.size())
  , gateway({ configuration.bus.modbus_tcp, seconds(configuration.bus.gateway_timeout),
              longestResponseTimeout(configuration.bus) })
  , link(longestResponseTimeout(configuration.bus))
{
  for (std::size_t index = 0; index < configuration.bus.inverters.size(); ++index)
  {
    inverters.push_back(std::make_unique<Inverter>(index, configuration.bus.inverters[index],
                                                   configuration.drives[index], configuration.bus.offline_after,
                                                   configuration.bus.retries));
  }
}

bool untested(const Inverter& inverter)
{
  return inverter.config.ownPort() && !inverter.link.everKnown();
}

std::string refusalText(const Inverter& inverter, std::uint16_t error_id)
{
  const std::string text = inverter.drive.exceptionText(error_id);
  return text.empty() ? errorText(error_id) : text;
}

ServiceBounds serviceBounds(const BusState& bus)
{
  ServiceBounds bounds;
  const double exchange = toSeconds(bus.budget.longest_exchange);
  const double inverters = static_cast<double>(bus.inverters.size());
  bounds.stop = std::max(bounds.stop, 3.0 * exchange * inverters);
  bounds.reset = std::max(bounds.reset, 40.0 * exchange);
  for (const auto& inverter : bus.inverters)
  {
    bounds.reset = std::max(bounds.reset, 2.0 * inverter->drive.profile().deaf_after_reset + 2.0);
  }
  bounds.read_faults = std::max(bounds.read_faults, 80.0 * exchange);
  bounds.read_parameter = std::max(bounds.read_parameter, 2.0 * exchange * (inverters + 2.0));
  bounds.write_parameter = std::max(bounds.write_parameter, 20.0 * exchange);
  if (bus.gateway.active())
  {
    // A lost request of another inverter may block the gateway before the first frame, and one of its own behind it.
    for (double* bound :
         { &bounds.stop, &bounds.reset, &bounds.read_faults, &bounds.read_parameter, &bounds.write_parameter })
    {
      *bound += 2.0 * bus.configuration.bus.gateway_timeout;
    }
  }
  return bounds;
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/driver.h"

#include <algorithm>

namespace inverter_bus
{
namespace fuzz
{
WatchedPort::WatchedPort(simulation::SimulatedBus& bus, AppointedClock& clock, LineWatch& watch)
  : VirtualPort(bus, clock), clock_(clock), watch_(watch)
{
}

wire::OpenResult WatchedPort::open(std::string& error)
{
  const wire::OpenResult result = VirtualPort::open(error);
  if (result == wire::OpenResult::Opened)
  {
    watch_.opened(clock_.now());
  }
  return result;
}

bool WatchedPort::send(const wire::Bytes& frame)
{
  watch_.sending(clock_.now(), frame);
  on_the_way(frame);
  const bool sent = VirtualPort::send(frame);
  if (!sent)
  {
    watch_.lost(clock_.now());
  }
  return sent;
}

wire::ReceiveResult WatchedPort::receive(wire::Bytes& buffer, TimePoint deadline)
{
  const wire::ReceiveResult result = VirtualPort::receive(buffer, deadline);
  if (result == wire::ReceiveResult::Data)
  {
    watch_.heard(clock_.now());
  }
  if (result == wire::ReceiveResult::Gone)
  {
    watch_.lost(clock_.now());
  }
  return result;
}

Driver::Driver(const bus::Configuration& configuration, simulation::SimulatedBus& bus, AppointedClock& clock,
               LineWatch& watch)
  : port(bus, clock, watch)
  , protocol(bus::makeProtocol(configuration.bus))
  , line(port, *protocol, clock, bus::makeTiming(configuration.bus))
  , coordinator(configuration, line)
  , loop(coordinator, line, clock, mutex)
{
  line.setGatewayTimeout(seconds(configuration.bus.gateway_timeout));
}

std::vector<bool> Driver::locked(TimePoint now, const bus::VelocityCommand& command) const
{
  const bus::Report report = coordinator.report(now);
  std::vector<bool> locked;
  for (const auto& target : command.targets)
  {
    locked.push_back(report.inverters[target.first].status.locked);
  }
  return locked;
}

bool Driver::budgetWarns(TimePoint now, std::size_t index) const
{
  const bus::Report report = coordinator.report(now);
  const auto warns = [](const bus::Finding& finding) {
    return finding.text.find("can't be kept with certainty") != std::string::npos;
  };
  const auto& findings = report.inverters[index].findings;
  return std::any_of(findings.begin(), findings.end(), warns) ||
         std::any_of(report.findings.begin(), report.findings.end(), warns);
}
}  // namespace fuzz
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_REPORTS_H
#define INVERTER_BUS_BUS_REPORTS_H

#include <cstdint>
#include <optional>

#include "bus/activities/port_watch.h"
#include "bus/activities/waits.h"
#include "bus/link/adapter_watch.h"

namespace inverter_bus
{
namespace bus
{
/// What the bus reports of itself: its status at the rates of the contract (section 2), and /diagnostics.
class Reports
{
public:
  Reports(BusState& bus, const GatewayTraffic& traffic, const Stops& stops, const Waits& waits, const PortWatch& port);

  void publishSlowly(TimePoint now);
  Report report(TimePoint now) const;
  /// What the open port reports of its adapter; nothing: its driver does not say.
  void noteAdapter(const std::optional<wire::AdapterLatency>& latency);

private:
  BusStatus busStatus(TimePoint now) const;
  void addFindings(TimePoint now, Report& report) const;
  void addValues(Report& report) const;

  BusState& bus_;
  const GatewayTraffic& traffic_;
  const Stops& stops_;
  const Waits& waits_;
  const PortWatch& port_;
  AdapterWatch adapter_;
  TimePoint last_bus_status_;
  std::uint64_t published_cycle_ = 0;
  bool published_connected_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_REPORTS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_GATEWAY_TRAFFIC_H
#define INVERTER_BUS_BUS_GATEWAY_TRAFFIC_H

#include <optional>
#include <string>
#include <vector>

#include "bus/activities/turns.h"

namespace inverter_bus
{
namespace bus
{
/// What may go while a Modbus TCP gateway still works on earlier requests (contract, 8.8), and what is reported of it.
/// Without a gateway everything may go.
class GatewayTraffic
{
public:
  GatewayTraffic(BusState& bus, const Turns& turns);

  /// After each exchange: what it leaves in the gateway.
  void note(const InFlight& current, const wire::Reply& reply);
  void othersFirst(TimePoint free_at, Inverter& inverter);
  /// What the scheduler may choose now.
  Gate gate(TimePoint now);
  std::vector<InverterView> views(TimePoint now) const;
  /// When the next frame of a stop may go; TimePoint::max(): not yet.
  TimePoint stopNotBefore(TimePoint now, const Inverter& inverter) const;
  /// A velocity of 0 can't be confirmed now.
  bool zeroNeedsStop(TimePoint now, const Inverter& inverter) const;
  void tellOfCostlyStop(Inverter& inverter);

  /// Acceptance of a stop to its first byte, or behind a gateway to its answer, at worst.
  Duration worstStop() const;
  std::string returnText() const;
  std::optional<Finding> finding() const;
  std::optional<Finding> quirkFinding() const;

private:
  static GatewayRisk riskOf(const InFlight& current);
  void tell();
  const Inverter* endangered() const;
  Duration block() const;

  BusState& bus_;
  const Turns& turns_;
  bool told_of_gateway_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_GATEWAY_TRAFFIC_H

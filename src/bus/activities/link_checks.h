// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_LINK_CHECKS_H
#define INVERTER_BUS_BUS_LINK_CHECKS_H

#include <optional>

#include "bus/activities/gateway_traffic.h"

namespace inverter_bus
{
namespace bus
{
/// Does any drive answer? The reads that follow a reopening (contract, 8.9), and links that have gone mute (8.10).
class LinkChecks
{
public:
  LinkChecks(BusState& bus, const GatewayTraffic& traffic);

  /// After a reopening: what goes before anything else; nothing: no check is due.
  std::optional<Pick> pick(TimePoint now, Gate& gate);
  void note(const wire::Reply& reply);
  /// The link is mute and is to be reopened.
  bool renewalDue(TimePoint now) const;

private:
  BusState& bus_;
  const GatewayTraffic& traffic_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_LINK_CHECKS_H

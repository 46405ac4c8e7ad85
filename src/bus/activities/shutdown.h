// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_SHUTDOWN_H
#define INVERTER_BUS_BUS_SHUTDOWN_H

#include <string>
#include <vector>

#include "bus/activities/services.h"

namespace inverter_bus
{
namespace bus
{
/// The last stops: each tried, live inverters first, all reported (contract, 4.4).
class Shutdown
{
public:
  Shutdown(BusState& bus, const GatewayTraffic& traffic, Stops& stops, Services& services);

  void begin(TimePoint now);
  Pick pick(TimePoint now);
  /// The frame that leaves the drive to its panel (release_on_exit).
  InFlight composeRelease(const Pick& pick);
  /// All motors confirmed, or the time is up.
  bool done(TimePoint now);
  /// Answers callers that still wait with 0xB003; names what could not be confirmed.
  std::vector<std::string> end();

private:
  TimePoint nextStop(TimePoint now) const;
  bool releaseDue(const Inverter& inverter) const;

  BusState& bus_;
  const GatewayTraffic& traffic_;
  Stops& stops_;
  Services& services_;
  TimePoint deadline_;
  std::vector<bool> tried_;
  std::vector<bool> released_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_SHUTDOWN_H

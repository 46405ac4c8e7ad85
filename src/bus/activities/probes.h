// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_PROBES_H
#define INVERTER_BUS_BUS_PROBES_H

#include "bus/activities/stops.h"
#include "bus/line_view.h"

namespace inverter_bus
{
namespace bus
{
/// Is an offline inverter back, and at what cost (contract, 3.7)?
class Probes
{
public:
  Probes(BusState& bus, Turns& turns, GatewayTraffic& traffic, Stops& stops);

  InFlight compose(const Pick& pick, const LineView& line);
  void ended(const InFlight& current, const wire::Reply& reply);
  /// How long a probe of this inverter may wait for the reply.
  Duration timeout(const Inverter& inverter, const LineView& line) const;
  /// A reply that came after its time-out: its station is alive.
  void lateReply(TimePoint now, const wire::LateReply& late);

private:
  /// The next one is a loop-back, if the drive's profile has one.
  bool byLoopback(const Inverter& inverter) const;
  /// The question that shows whether an offline drive is back.
  wire::Request request(const Inverter& inverter, std::uint16_t number, Duration response_timeout) const;

  BusState& bus_;
  Turns& turns_;
  GatewayTraffic& traffic_;
  Stops& stops_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_PROBES_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_PROBES_H
#define INVERTER_BUS_BUS_PROBES_H

#include <vector>

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

  /// How long a probe waits for its reply, and how much of what that costs the next probe waits for.
  struct Wait
  {
    Duration timeout{ 0 };
    Duration in_turn = Duration::max();
  };

  InFlight compose(TimePoint now, const Pick& pick, const LineView& line);
  /// The frame of a stop waits no longer than a probe if it is one.
  InFlight limit(TimePoint now, InFlight stop, const LineView& line) const;
  void ended(const InFlight& current, const wire::Reply& reply);
  Wait wait(TimePoint now, const Inverter& inverter, const LineView& line) const;
  /// The time-out of one that doesn't wait for a drive that has become slow.
  Duration shortTimeout(const Inverter& inverter, const LineView& line) const;
  /// A reply that came after its time-out: its station is alive.
  void lateReply(TimePoint now, const wire::LateReply& late);

private:
  std::vector<std::size_t> silentInverters() const;
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

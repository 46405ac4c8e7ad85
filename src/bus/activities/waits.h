// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_WAITS_H
#define INVERTER_BUS_BUS_WAITS_H

#include <optional>

#include "bus/activities/probes.h"
#include "bus/activities/velocities.h"

namespace inverter_bus
{
namespace bus
{
/// How long an exchange is waited for, and when a stop ends that (contract, 8.4). Never behind a gateway (8.8).
class Waits
{
public:
  Waits(BusState& bus, Stops& stops, const Velocities& velocities, const Probes& probes);

  /// How long the adapter may hold a byte back; 0 where that is unknown.
  void noteAdapter(Duration latency);
  /// The end of an exchange: how long its drive has taken.
  void note(const InFlight& current, const wire::Reply& reply);

  /// From the acceptance of a stop to the last bit of its frame, where no gateway has the requests: behind an exchange that
  /// it may cut.
  Duration worstStop() const;
  /// Takes from its time-out what an exchange that is about to go need not wait for.
  void shorten(InFlight& current, const LineView& line) const;
  /// Silence after which a stop ends the wait for it; nothing: that takes its full time.
  std::optional<Duration> cutAfter(const InFlight& current) const;
  /// A stop waits that ends the wait for \p current, or (nothing in flight) that goes next.
  bool stopWaits(TimePoint now, const std::optional<InFlight>& current);

private:
  bool stopIsNext(const Inverter& inverter) const;
  bool ends(const Inverter& inverter, const InFlight& current) const;

  BusState& bus_;
  Stops& stops_;
  const Velocities& velocities_;
  const Probes& probes_;
  Duration adapter_{ 0 };
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_WAITS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_TELNET_STOPS_H
#define INVERTER_BUS_BUS_TELNET_STOPS_H

#include <vector>

#include "bus/activities/absences.h"

namespace inverter_bus
{
namespace bus
{
/// What may go to a server that may speak telnet, or does (contract, 8.11): reads and pending stops.
class TelnetStops
{
public:
  TelnetStops(BusState& bus, Absences& absences);

  /// The port was opened.
  void opened();
  /// It leads to a telnet server, and everything that may be sent to one has been sent: close it.
  bool over(TimePoint now);
  Pick pick(TimePoint now) const;
  /// Nothing but reads and stops goes before the first valid reply; what waits has been put off.
  bool mustWait(TimePoint now, const InFlight& current);

private:
  bool tried(const Inverter& inverter) const;

  BusState& bus_;
  Absences& absences_;
  /// All inverters were given up because of it.
  bool found_ = false;
  /// Attempts at each pending stop when the connection was opened.
  std::vector<unsigned> attempts_at_open_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_TELNET_STOPS_H

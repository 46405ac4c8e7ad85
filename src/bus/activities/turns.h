// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_TURNS_H
#define INVERTER_BUS_BUS_TURNS_H

#include "bus/activities/bus_state.h"
#include "bus/exchange.h"

namespace inverter_bus
{
namespace bus
{
/// The accounts of exchanges: what one has cost and from whose share that is paid.
class Turns
{
public:
  explicit Turns(BusState& bus);

  /// The end of an exchange. \p more: its inverter or command needs another one (see Scheduler::done()).
  void finish(const InFlight& current, const wire::Reply& reply, bool more);
  /// The time that a probe takes from all others, with its silences; a refusal takes it too.
  Duration price(const InFlight& current, const wire::Reply& reply) const;
  /// The read that a refresh of \p inverter goes on with, or begins with: through the drive's register map where that is
  /// in use (contract, 8.17), and with a slow value where their share has room.
  const drive::ReadBlock& nextRead(TimePoint now, Inverter& inverter) const;
  /// Including the waits that the drives themselves have reported.
  Duration longestExchange() const;
  /// The longest wait of a drive's own (C078) as read from it, beyond what its profile says.
  Duration longestReplyDelay() const;

private:
  SlowLeave slowLeave(TimePoint now, const Inverter& inverter) const;
  TimePoint countedFrom(const wire::Reply& reply) const;

  BusState& bus_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_TURNS_H

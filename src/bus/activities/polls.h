// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_POLLS_H
#define INVERTER_BUS_BUS_POLLS_H

#include <vector>

#include "bus/activities/absences.h"
#include "bus/activities/reply_guard.h"

namespace inverter_bus
{
namespace bus
{
/// The status of each inverter: which read is next, and what follows from its answer (contract, 3.6, 4.1, 4.7 and 4.8).
class Polls
{
public:
  Polls(BusState& bus, Turns& turns, const ReplyGuard& guard, Stops& stops, Absences& absences);

  InFlight compose(TimePoint now, const Pick& pick, const LineView& line);
  void ended(const InFlight& current, const wire::Reply& reply);
  /// A write of a velocity has ended; what came with it is the answer to the read of the refresh, if it was asked for.
  void cameWithWrite(const InFlight& current, const wire::Reply& reply);
  /// The end of a read whose answer is not used.
  void keptAlive(const InFlight& current, const wire::Reply& reply);

private:
  void keepAlive(TimePoint now, Inverter& inverter, InFlight& current, const LineView& line) const;
  void took(const wire::Reply& reply, Inverter& inverter, bool more);
  void refusedStatus(const wire::Reply& reply, Inverter& inverter);
  void judge(TimePoint now, Inverter& inverter);
  void actOn(TimePoint now, Inverter& inverter, const Judgement& judgement);

  BusState& bus_;
  Turns& turns_;
  const ReplyGuard& guard_;
  Stops& stops_;
  Absences& absences_;
  /// Of the current read, by inverter.
  std::vector<Repeats> repeats_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_POLLS_H

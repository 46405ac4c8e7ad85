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
/// The status of each inverter: which read is next, and what follows from what it tells (contract, 3.6, 4.1, 4.7 and 4.8).
class Polls
{
public:
  Polls(BusState& bus, Turns& turns, const ReplyGuard& guard, Stops& stops, Absences& absences);

  InFlight compose(TimePoint now, const Pick& pick, const LineView& line);
  void ended(const InFlight& current, const wire::Reply& reply);
  /// The end of a read whose answer is not used.
  void keptAlive(const InFlight& current, const wire::Reply& reply);

private:
  SlowLeave slowLeave(TimePoint now, const Inverter& inverter) const;
  void refusedStatus(const wire::Reply& reply, Inverter& inverter);
  void judge(TimePoint now, Inverter& inverter);
  void actOn(TimePoint now, Inverter& inverter, const Judgement& judgement);

  BusState& bus_;
  Turns& turns_;
  const ReplyGuard& guard_;
  Stops& stops_;
  Absences& absences_;
  /// Of the read at hand, by inverter.
  std::vector<Repeats> repeats_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_POLLS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_TRIAL_H
#define INVERTER_BUS_BUS_TRIAL_H

#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace bus
{
/// The trial of an offline inverter that has answered (contract, 8.15): its settings and its status are read, and only a
/// complete status brings it back. A trial that leads to nothing is paid for by the probes. Not thread safe; the bus guards
/// it.
class Trial
{
public:
  /// An exchange with the inverter has ended. \p probe: it asked whether the inverter is back.
  void exchangeEnded(bool probe, wire::Outcome outcome, Duration cost);
  /// A reply came. What its exchange has cost is the first part of the trial's price.
  void begin();
  /// A reply to a probe came late: true if that was worth a trial. What that probe has cost is paid already.
  bool beginLate();
  /// It has led to nothing. Returns its price: in full what was lost or refused, and what brought something only as far as
  /// the next probe is not delayed for long.
  Duration end();
  /// The inverter went offline, or it is back: there is nothing to try, and no reply to wait for.
  void drop();
  bool underWay() const;

private:
  bool under_way_ = false;
  /// Since the last trial, and it has not been answered yet.
  bool probed_ = false;
  /// Since the probe that began it, and how much of that was lost or refused.
  Duration cost_{ 0 };
  Duration waste_{ 0 };
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_TRIAL_H

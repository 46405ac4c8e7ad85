// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_FREEZE_WATCH_H
#define INVERTER_BUS_BUS_FREEZE_WATCH_H

#include <optional>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace bus
{
/// Time in which the bus thread itself did not run: the process was stopped (SIGSTOP, a debugger), or its machine was
/// (the pause of a virtual one). It shows as a jump: the thread is back long after it wanted to be. No drive is to blame
/// for what was not heard from it meanwhile. Pure; bus thread only.
class FreezeWatch
{
public:
  /// The thread is busy, or sleeps, and is back at \p time at the latest.
  void backBy(TimePoint time);
  /// It is back: for how long it did not run; 0: it was in time, or as late as on a busy machine. From now on it is
  /// expected at once, unless backBy() says otherwise.
  Duration back(TimePoint now);

private:
  std::optional<TimePoint> back_by_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_FREEZE_WATCH_H

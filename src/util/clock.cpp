// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/util/clock.h"

#include <cerrno>
#include <ctime>

#include "util/timespec.h"

namespace inverter_bus
{
namespace util
{
TimePoint SteadyClock::now() const
{
  return std::chrono::steady_clock::now();
}

void SteadyClock::sleepUntil(TimePoint time)
{
  const timespec end = monotonicTime(time);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &end, nullptr) == EINTR)
  {
    // A signal woke it.
  }
}
}  // namespace util
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/util/clock.h"

#include <thread>

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
  std::this_thread::sleep_until(time);
}
}  // namespace util
}  // namespace inverter_bus

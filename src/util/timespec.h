// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_UTIL_TIMESPEC_H
#define INVERTER_BUS_UTIL_TIMESPEC_H

#include <ctime>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace util
{
/// \p time for system calls that take CLOCK_MONOTONIC, which is what std::chrono::steady_clock reads. A time before its
/// start becomes the start: system calls refuse negative times.
timespec monotonicTime(TimePoint time);
}  // namespace util
}  // namespace inverter_bus

#endif  // INVERTER_BUS_UTIL_TIMESPEC_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_TIME_H
#define INVERTER_BUS_SIMULATION_TIME_H

#include <chrono>

namespace inverter_bus
{
namespace simulation
{
/// The simulator never reads a clock: every time comes in as an argument. A test counts its own time up, the program
/// passes the steady clock's.
using Clock = std::chrono::steady_clock;
using TimePoint = Clock::time_point;
using Duration = Clock::duration;

/// \p value [s], also negative.
inline Duration seconds(double value)
{
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(value));
}

/// [s]
inline double toSeconds(Duration value)
{
  return std::chrono::duration<double>(value).count();
}
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_TIME_H

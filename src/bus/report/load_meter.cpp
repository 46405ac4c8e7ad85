// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/report/load_meter.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double WINDOW_S = 1.0;
}  // namespace

void LoadMeter::exchange(TimePoint start, TimePoint end, Duration refresh_cost)
{
  if (!started_)
  {
    started_ = true;
    window_start_ = start;
  }
  used_ += end - start;
  cycle_cost_ += refresh_cost;
  const Duration window = end - window_start_;
  if (window >= seconds(WINDOW_S))
  {
    last_share_ = std::min(1.0, toSeconds(used_) / toSeconds(window));
    window_start_ = end;
    used_ = Duration{ 0 };
  }
}

void LoadMeter::cycle(Duration duration)
{
  efficiency_ = duration > Duration::zero() ? std::min(1.0, toSeconds(cycle_cost_) / toSeconds(duration)) : 0.0;
  cycle_cost_ = Duration{ 0 };
}

double LoadMeter::utilization(TimePoint now) const
{
  // A dead line makes no exchanges that could close the window.
  return started_ && now - window_start_ < seconds(3 * WINDOW_S) ? last_share_ : 0.0;
}

double LoadMeter::efficiency() const
{
  return efficiency_;
}
}  // namespace bus
}  // namespace inverter_bus

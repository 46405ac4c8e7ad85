// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/report/load_meter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
/// Exchanges of \p length every \p period ms, from 0 ms on, until \p end.
LoadMeter metered(int length, int period, int end)
{
  LoadMeter meter;
  for (int time = 0; time <= end; time += period)
  {
    meter.exchange(at(time), at(time + length), Duration{ 0 });
  }
  return meter;
}

TEST(LoadMeter, unusedLineHasNoLoad)
{
  const LoadMeter meter;
  EXPECT_EQ(meter.utilization(at(5000)), 0.0);
  EXPECT_EQ(meter.efficiency(), 0.0);
}

TEST(LoadMeter, loadIsTheShareOfTimeInExchanges)
{
  EXPECT_NEAR(metered(25, 100, 3000).utilization(at(3025)), 0.25, 0.03);
  EXPECT_NEAR(metered(90, 100, 3000).utilization(at(3090)), 0.9, 0.03);
}

TEST(LoadMeter, fullLineIsOneAndNotMore)
{
  EXPECT_DOUBLE_EQ(metered(100, 100, 3000).utilization(at(3100)), 1.0);
}

TEST(LoadMeter, lineThatFellSilentHasNoLoadAnyMore)
{
  EXPECT_EQ(metered(90, 100, 3000).utilization(at(10000)), 0.0);
}

TEST(LoadMeter, efficiencyIsTheComputedCostOfTheCycleInItsRealTime)
{
  LoadMeter meter;
  meter.exchange(at(0), at(40), Ms(20));
  meter.exchange(at(40), at(80), Ms(20));
  meter.cycle(Ms(80));
  EXPECT_DOUBLE_EQ(meter.efficiency(), 0.5);
}

TEST(LoadMeter, efficiencyCountsEachCycleForItself)
{
  LoadMeter meter;
  meter.exchange(at(0), at(40), Ms(40));
  meter.cycle(Ms(40));
  meter.exchange(at(40), at(80), Ms(10));
  meter.cycle(Ms(40));
  EXPECT_DOUBLE_EQ(meter.efficiency(), 0.25);
}

TEST(LoadMeter, cycleWithoutDurationHasNoEfficiency)
{
  LoadMeter meter;
  meter.exchange(at(0), at(10), Ms(10));
  meter.cycle(Duration{ 0 });
  EXPECT_EQ(meter.efficiency(), 0.0);
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The share of the wire that slow values have together (contract, 8.3).

#include "bus/rules/slow_share.h"

#include <algorithm>
#include <deque>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
SlowShare::Settings settings(double interval, double longest, double cycle)
{
  return { seconds(interval), seconds(longest), seconds(cycle) };
}

/// The most that 10 s of a minute hold if whoever may read does, every \p step s, for \p cost s each.
double mostInTenSeconds(SlowShare share, double cost, double step)
{
  std::deque<std::pair<double, double>> spent;
  double sum = 0.0;
  double most = 0.0;
  for (double time = 0.0; time < 60.0; time += step)
  {
    if (!share.open(at(0) + seconds(time)))
    {
      continue;
    }
    share.spent(at(0) + seconds(time + cost), seconds(cost));
    spent.emplace_back(time + cost, cost);
    sum += cost;
    while (time + cost - spent.front().first > 10.0 - cost)
    {
      sum -= spent.front().second;
      spent.pop_front();
    }
    most = std::max(most, sum);
    time += cost;
  }
  return most;
}

TEST(SlowShare, noTenSecondsHoldMoreThanTheShare)
{
  for (const double cost : { 0.005, 0.015, 0.03 })
  {
    for (const double cycle : { 0.03, 0.2, 1.0, 3.0, 60.0 })
    {
      const double most = mostInTenSeconds(SlowShare(settings(1.0, 0.03, cycle)), cost, 0.01);
      EXPECT_LE(most, 0.7501) << cost << " " << cycle;
      EXPECT_GE(most, 0.4) << cost << " " << cycle << ": what may be used is used";
    }
  }
}

TEST(SlowShare, whatOneCycleDoesNotUseTheNextOneMay)
{
  // A cycle of 4 s: 7.5 % of 10 s in 14 s are 5.36 %, so that 0.214 s may be saved up: seven of 0.03 s.
  SlowShare share(settings(1.0, 0.03, 4.0));
  unsigned count = 0;
  while (share.open(at(0)) && count < 100)
  {
    share.spent(at(0), seconds(0.03));
    ++count;
  }
  EXPECT_EQ(count, 7U);
  EXPECT_NEAR(share.rate(), 0.0536, 0.0001);
  EXPECT_FALSE(share.open(at(400)));
  EXPECT_TRUE(share.open(at(600)));
}

TEST(SlowShare, oneThatTookLongerIsPaidForBeforeTheNext)
{
  SlowShare share(settings(1.0, 0.03, 0.1));
  share.spent(at(300), seconds(0.3));
  // 0.3 s at 7.0 % are 4.28 s from its beginning; a little of it may be owed.
  EXPECT_FALSE(share.open(at(3900)));
  EXPECT_TRUE(share.open(at(4300)));
}

TEST(SlowShare, periodIsAsLongAsTheNeedsAskForAndNoShorterThanTheInterval)
{
  const SlowShare share(settings(1.0, 0.02, 0.1));
  EXPECT_EQ(share.period(Duration{ 0 }), Ms(1000));
  EXPECT_EQ(share.period(Ms(70)), Ms(1000));
  // 7.5 % of 10 s in 10.7 s are 7.01 %.
  EXPECT_NEAR(toSeconds(share.period(Ms(701))), 10.0, 0.01);
}

TEST(SlowShare, intervalOfZeroReadsNothing)
{
  EXPECT_TRUE(SlowShare(settings(0.1, 0.02, 0.1)).reads());
  EXPECT_FALSE(SlowShare(settings(0.0, 0.02, 0.1)).reads());
}

TEST(SlowShare, whatNothingDependsOnIsSlowed)
{
  drive::ReadBlock block;
  block.fields = { "torque", "output_voltage", "temperature", "dc_voltage", "warning_code", "overload_warning" };
  EXPECT_TRUE(isSlowed(block));
  for (const char* field : { "run_seen", "restarted", "direction", "output_frequency", "operation", "faulted" })
  {
    drive::ReadBlock with = block;
    with.fields.emplace_back(field);
    EXPECT_FALSE(isSlowed(with)) << field;
  }
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

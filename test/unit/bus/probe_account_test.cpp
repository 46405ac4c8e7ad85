// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// What probes of offline inverters have cost, and when the next one may go (contract, 3.7).

#include "bus/rules/probe_account.h"

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace bus
{
namespace
{
using Ms = std::chrono::milliseconds;

TimePoint at(int milliseconds)
{
  return TimePoint(std::chrono::seconds(100)) + Ms(milliseconds);
}

double msFrom(TimePoint from, TimePoint until)
{
  return toSeconds(until - from) * 1e3;
}

TEST(ProbeAccount, aProbeIsPaidOffWhenItIsATwentiethOfTheTime)
{
  ProbeAccount account(1, 0.05);
  account.charge(at(0), Ms(20));
  EXPECT_NEAR(msFrom(at(0), account.opensAt()), 380.0, 0.01) << "20 ms of 400";
}

TEST(ProbeAccount, ofTwoPricesTheHigherOneCounts)
{
  ProbeAccount account(1, 0.05);
  account.charge(at(0), Ms(20));
  account.charge(at(0), Ms(10));
  EXPECT_NEAR(msFrom(at(0), account.opensAt()), 380.0, 0.01);
}

TEST(ProbeAccount, aLongWaitHoldsTheNextProbeBackByATenthOnly)
{
  ProbeAccount account(1, 0.05);
  account.ended(at(0), 0, Ms(108), Ms(18));
  EXPECT_NEAR(msFrom(at(0), account.opensAt()), 382.0, 0.01) << "18 ms of 400 are 4.5 %";
}

TEST(ProbeAccount, aLongWaitIsPaidOffWithWhatTheTurnsLeave)
{
  ProbeAccount account(1, 0.05);
  ASSERT_TRUE(account.mayWaitLong(at(0), 0, { 0 }));
  account.ended(at(0), 0, Ms(108), Ms(18));
  // 0.5 % of 18 s.
  EXPECT_FALSE(account.mayWaitLong(at(17999), 0, { 0 }));
  EXPECT_TRUE(account.mayWaitLong(at(18001), 0, { 0 }));
  account.charge(at(18001), Ms(20));
  EXPECT_NEAR(msFrom(at(18001), account.opensAt()), 380.0, 0.01) << "the turns have the whole share again";
}

TEST(ProbeAccount, longWaitsGoRoundAmongThoseThatWantOne)
{
  ProbeAccount account(3, 0.05);
  account.ended(at(0), 1, Ms(20), Ms(10));
  EXPECT_TRUE(account.mayWaitLong(at(3000), 0, { 0, 1, 2 }));
  EXPECT_FALSE(account.mayWaitLong(at(3000), 1, { 0, 1, 2 }));
  EXPECT_TRUE(account.mayWaitLong(at(3000), 1, { 1 })) << "nobody else wants one";
  account.ended(at(3000), 0, Ms(20), Ms(10));
  account.ended(at(6000), 2, Ms(20), Ms(10));
  EXPECT_TRUE(account.mayWaitLong(at(9000), 1, { 0, 1, 2 }));
}

TEST(ProbeAccount, aRestartForgetsWhatTurnsHaveCost)
{
  ProbeAccount account(1, 0.05);
  account.ended(at(0), 0, Ms(100), Duration::max());
  EXPECT_NEAR(msFrom(at(0), account.opensAt(0)), 500.0, 0.01) << "each one at most twice a second";
  account.restart(at(10));
  EXPECT_EQ(account.opensAt(), at(10));
  EXPECT_LE(account.opensAt(0), at(10));
}

TEST(LeastProbeTimeout, isWhatTheDriveHasEverNeededAndMore)
{
  EXPECT_EQ(leastProbeTimeout(Ms(40), Ms(0)), Ms(60));
  EXPECT_EQ(leastProbeTimeout(Ms(40), Ms(5)), Ms(55)) << "its own delay is waited out anyway";
  EXPECT_EQ(leastProbeTimeout(Ms(5), Ms(5)), Ms(7)) << "12 ms in all";
  EXPECT_EQ(leastProbeTimeout(Ms(20), Ms(40)), Ms(5)) << "never less than 5 ms beyond its delay";
}

TEST(LeastProbeTimeout, isLongerForOneThatWasNeverHeard)
{
  EXPECT_EQ(leastProbeTimeout(Ms(0), Ms(0)), Ms(15));
  EXPECT_EQ(leastProbeTimeout(Ms(0), Ms(40)), Ms(10));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "bus/rules/reply_times.h"

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace bus
{
namespace
{
using Ms = std::chrono::milliseconds;

TEST(ReplyTimes, ofADriveThatWasNeverHeardAreZero)
{
  const ReplyTimes times;
  EXPECT_EQ(times.longest(), Ms(0));
  EXPECT_EQ(times.cutAfter(Ms(0), Ms(0)), Ms(15));
  EXPECT_TRUE(times.answers()) << "who was not asked has not been silent";
}

TEST(ReplyTimes, theLongestOfTheLast256Counts)
{
  ReplyTimes times;
  times.replied(Ms(30), Ms(30));
  for (int reply = 0; reply < 255; ++reply)
  {
    times.replied(Ms(6), Ms(6));
  }
  EXPECT_EQ(times.longest(), Ms(30));
  times.replied(Ms(7), Ms(7));
  EXPECT_EQ(times.longest(), Ms(7));
}

TEST(ReplyTimes, aStopWaitsForThreeTimesTheLongestForTheOwnDelayAndForTheAdapter)
{
  ReplyTimes times;
  times.replied(Ms(4), Ms(4));
  EXPECT_EQ(times.cutAfter(Ms(0), Ms(0)), Ms(15));
  EXPECT_EQ(times.cutAfter(Ms(0), Ms(16)), Ms(31));
  EXPECT_EQ(times.cutAfter(Ms(200), Ms(16)), Ms(200));
  times.replied(Ms(80), Ms(80));
  EXPECT_EQ(times.cutAfter(Ms(200), Ms(16)), Ms(240));
}

TEST(ReplyTimes, whatIsCollectedOnTheWayHasBegun)
{
  ReplyTimes times;
  times.replied(Ms(4), Ms(17));
  EXPECT_EQ(times.cutAfter(Ms(0), Ms(0)), Ms(19));
}

TEST(ReplyTimes, aDriveAnswersAgainWithItsNextReply)
{
  ReplyTimes times;
  times.missed();
  EXPECT_FALSE(times.answers());
  times.replied(Ms(5), Ms(5));
  EXPECT_TRUE(times.answers());
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

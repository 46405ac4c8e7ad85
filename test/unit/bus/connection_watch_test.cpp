// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Contract, 8.9: an orderly close is not a lost port. Times by hand.

#include "bus/link/connection_watch.h"

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace bus
{
namespace
{
using Verdict = ConnectionWatch::Verdict;

class AConnectionWatch : public ::testing::Test
{
protected:
  TimePoint at(double time) const
  {
    return start_ + seconds(time);
  }

  void open(double time, const std::vector<std::size_t>& online = { 0, 1 })
  {
    watch_.opened(at(time), online);
  }

  const TimePoint start_ = TimePoint() + std::chrono::hours(1);
  ConnectionWatch watch_;
};

TEST_F(AConnectionWatch, resumesAfterAnIdleClose)
{
  open(0.0, {});
  watch_.answered(at(0.1), 0);
  EXPECT_EQ(watch_.closed(at(5.0), std::nullopt), Verdict::Resume);
  EXPECT_TRUE(watch_.resuming());
  EXPECT_LE(watch_.openNotBefore(), at(5.0)) << "at once";
}

TEST_F(AConnectionWatch, readsEachOnlineInverterOnceAfterTheReopening)
{
  open(0.0, {});
  watch_.answered(at(0.1), 0);
  EXPECT_FALSE(watch_.toRead()) << "not after the first opening";
  watch_.closed(at(5.0), std::nullopt);
  open(5.1);
  EXPECT_EQ(watch_.toRead(), 0U);
  watch_.answered(at(5.2), 0);
  EXPECT_EQ(watch_.toRead(), 1U);
  watch_.unanswered(1);
  EXPECT_FALSE(watch_.toRead());
  EXPECT_FALSE(watch_.nobodyAnswered());
}

TEST_F(AConnectionWatch, isLostWhenNobodyAnswersAfterTheReopening)
{
  open(0.0, {});
  watch_.answered(at(0.1), 0);
  watch_.closed(at(5.0), std::nullopt);
  open(5.1);
  watch_.unanswered(0);
  EXPECT_FALSE(watch_.nobodyAnswered());
  watch_.unanswered(1);
  EXPECT_TRUE(watch_.nobodyAnswered());
}

TEST_F(AConnectionWatch, isLostWhenItIsNotOpenWithinHalfASecond)
{
  open(0.0, {});
  watch_.answered(at(0.1), 0);
  watch_.closed(at(5.0), std::nullopt);
  EXPECT_EQ(watch_.notOpen(at(5.4)), Verdict::Resume);
  EXPECT_EQ(watch_.notOpen(at(5.5)), Verdict::Lost);
  EXPECT_FALSE(watch_.resuming());
}

TEST_F(AConnectionWatch, isLostWhenItIsClosedBeforeAnybodyAnswered)
{
  open(0.0, {});
  EXPECT_EQ(watch_.closed(at(0.01), std::nullopt), Verdict::Lost);
  EXPECT_EQ(watch_.openNotBefore(), at(2.0)) << "at most one connection in two seconds";
}

TEST_F(AConnectionWatch, takesThreeQuickClosesInTenSecondsForAnotherClient)
{
  open(0.0, {});
  for (int close = 0; close < 2; ++close)
  {
    watch_.answered(at(close + 0.1), 0);
    EXPECT_EQ(watch_.closed(at(close + 0.5), std::nullopt), Verdict::Resume);
    open(close + 0.6);
  }
  watch_.answered(at(2.7), 0);
  EXPECT_EQ(watch_.closed(at(2.9), std::nullopt), Verdict::TakenByAnother);
  EXPECT_LE(watch_.openNotBefore(), at(2.9)) << "there are motors to be stopped";
}

TEST_F(AConnectionWatch, keepsItsDistanceWhileItIsTakenAgainAndAgain)
{
  open(0.0, {});
  double now = 0.0;
  for (int close = 0; close < 3; ++close, now += 1.0)
  {
    watch_.answered(at(now + 0.1), 0);
    watch_.closed(at(now + 0.5), std::nullopt);
    open(now + 0.6);
  }
  watch_.answered(at(now + 0.1), 0);
  EXPECT_EQ(watch_.closed(at(now + 0.2), std::nullopt), Verdict::TakenByAnother);
  EXPECT_EQ(watch_.openNotBefore(), at(now - 1.0 + 0.6 + 2.0));
}

TEST_F(AConnectionWatch, threeClosesWithinAMinuteAreNoMatter)
{
  open(0.0, {});
  for (int close = 0; close < 5; ++close)
  {
    watch_.answered(at(6.0 * close + 0.1), 0);
    EXPECT_EQ(watch_.closed(at(6.0 * close + 0.5), std::nullopt), Verdict::Resume);
    open(6.0 * close + 0.6);
  }
}

TEST_F(AConnectionWatch, goesOnWhereTheGatewayClosesInPlaceOfTheAnswerOfOneSilentStation)
{
  open(0.0, {});
  for (int close = 0; close < 20; ++close)
  {
    watch_.answered(at(close + 0.1), 0);
    EXPECT_EQ(watch_.closed(at(close + 0.5), 1U), Verdict::Resume) << close;
    open(close + 0.6);
  }
}

TEST_F(AConnectionWatch, goesOnWhereSeveralStationsAreSilent)
{
  open(0.0, {});
  for (int close = 0; close < 20; ++close)
  {
    watch_.answered(at(close + 0.1), 0);
    EXPECT_EQ(watch_.closed(at(close + 0.5), close % 2 == 0 ? 1U : 2U), Verdict::Resume) << close;
    open(close + 0.6);
  }
}

TEST_F(AConnectionWatch, aStationThatAnswersInBetweenIsNotSilent)
{
  open(0.0, {});
  Verdict last = Verdict::Resume;
  for (int close = 0; close < 3; ++close)
  {
    watch_.answered(at(close + 0.1), 0);
    watch_.answered(at(close + 0.2), 1);
    last = watch_.closed(at(close + 0.5), 1U);
    open(close + 0.6);
  }
  EXPECT_EQ(last, Verdict::TakenByAnother);
}

TEST_F(AConnectionWatch, asksTheSilentStationLast)
{
  open(0.0, {});
  watch_.answered(at(0.1), 1);
  EXPECT_EQ(watch_.closed(at(0.5), 0U), Verdict::Resume);
  open(0.6, { 0, 1, 2 });
  EXPECT_EQ(watch_.toRead(), 1U);
  EXPECT_EQ(watch_.closed(at(0.8), 1U), Verdict::Resume) << "2 may still answer";
  open(0.9, { 0, 1, 2 });
  EXPECT_EQ(watch_.toRead(), 2U);
  EXPECT_EQ(watch_.closed(at(1.1), 2U), Verdict::Lost) << "everybody was asked in vain";
}

TEST_F(AConnectionWatch, slowsDownWhereTheNextConnectionWillFailToo)
{
  open(1.0, {});
  watch_.slowDown();
  EXPECT_EQ(watch_.openNotBefore(), at(3.0));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Contract, 8.10: a link that is up but mute is opened anew. Times by hand.

#include "bus/link/link_watch.h"

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace bus
{
namespace
{
class ALinkWatch : public ::testing::Test
{
protected:
  TimePoint at(double time) const
  {
    return start_ + seconds(time);
  }

  const TimePoint start_ = TimePoint() + std::chrono::hours(1);
  LinkWatch watch_{ std::chrono::milliseconds(100) };
};

TEST_F(ALinkWatch, isMuteAfterFiveSecondsWhereSomebodyAnsweredBefore)
{
  watch_.opened(at(0.0));
  watch_.answered();
  watch_.lost(at(1.0));
  watch_.lost(at(3.0));
  EXPECT_FALSE(watch_.mute(at(5.9)));
  EXPECT_TRUE(watch_.mute(at(6.0)));
}

TEST_F(ALinkWatch, waitsForTenTimeOutsWhereTheyAreLong)
{
  LinkWatch patient(std::chrono::seconds(2));
  patient.opened(at(0.0));
  patient.answered();
  patient.lost(at(1.0));
  EXPECT_FALSE(patient.mute(at(20.9)));
  EXPECT_TRUE(patient.mute(at(21.0)));
}

TEST_F(ALinkWatch, isMuteTenSecondsAfterTheOpeningWhereNobodyEverAnswered)
{
  watch_.opened(at(0.0));
  watch_.lost(at(0.1));
  EXPECT_FALSE(watch_.mute(at(9.9)));
  EXPECT_TRUE(watch_.mute(at(10.0)));
}

TEST_F(ALinkWatch, nobodyIsMuteWhoWasNotAsked)
{
  watch_.opened(at(0.0));
  EXPECT_FALSE(watch_.mute(at(1000.0)));
  watch_.answered();
  EXPECT_FALSE(watch_.mute(at(2000.0)));
}

TEST_F(ALinkWatch, timeInWhichNobodyAskedMakesItNotMute)
{
  watch_.opened(at(0.0));
  watch_.answered();
  watch_.lost(at(1.0));
  watch_.notWatching(std::chrono::seconds(60));
  EXPECT_FALSE(watch_.mute(at(65.9)));
  EXPECT_FALSE(watch_.wasSilent(at(65.9)));
  EXPECT_TRUE(watch_.mute(at(66.0)));
}

TEST_F(ALinkWatch, knowsThatItWasTheLinkThatWasSilentHoweverOftenItWasOpenedAnew)
{
  watch_.opened(at(0.0));
  watch_.answered();
  watch_.lost(at(1.0));
  EXPECT_FALSE(watch_.wasSilent(at(5.9)));
  EXPECT_TRUE(watch_.wasSilent(at(6.0)));
  watch_.opened(at(6.0));
  EXPECT_TRUE(watch_.wasSilent(at(6.1)));
  watch_.answered();
  EXPECT_FALSE(watch_.wasSilent(at(6.2)));
}

TEST_F(ALinkWatch, anAnswerEndsIt)
{
  watch_.opened(at(0.0));
  watch_.answered();
  watch_.lost(at(1.0));
  watch_.answered();
  watch_.lost(at(5.5));
  EXPECT_FALSE(watch_.mute(at(6.5)));
}

TEST_F(ALinkWatch, isRenewedEveryTenSecondsDoublingToAMinute)
{
  watch_.opened(at(0.0));
  watch_.answered();
  watch_.lost(at(0.0));
  double now = 5.0;
  EXPECT_TRUE(watch_.renewing(at(now))) << "said once";
  for (const double period : { 10.0, 20.0, 40.0, 60.0, 60.0 })
  {
    watch_.opened(at(now));
    watch_.lost(at(now + 0.1));
    EXPECT_FALSE(watch_.mute(at(now + period - 0.1))) << period;
    now += period;
    EXPECT_TRUE(watch_.mute(at(now))) << period;
    EXPECT_FALSE(watch_.renewing(at(now)));
  }
  watch_.opened(at(now));
  watch_.answered();
  EXPECT_FALSE(watch_.inVain());
  watch_.lost(at(now + 1.0));
  EXPECT_TRUE(watch_.mute(at(now + 6.0)));
  EXPECT_TRUE(watch_.renewing(at(now + 6.0))) << "the next time is said again";
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

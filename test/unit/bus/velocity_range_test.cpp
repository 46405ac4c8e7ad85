// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Which velocities are stops, which are clamped, which are refused (contract, 8.5).

#include "bus/rules/velocity_range.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Kind = RangedVelocity::Kind;

constexpr double INFINITE = std::numeric_limits<double>::infinity();
constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();

/// An MX2 (0.01 Hz steps), 1 Hz per unit, up to 50 units.
class Range : public testing::Test
{
protected:
  RangedVelocity judge(double velocity, double factor = 1.0) const
  {
    return range_.judge(velocity, factor);
  }

  InverterConfig config_ = inverterConfig();
  const drive::Drive mx2_ = shipped("omron_mx2");
  VelocityRange range_{ mx2_, config_ };
};

TEST_F(Range, whatRoundsToZeroHertzIsAStop)
{
  for (const double velocity : { 0.004, -0.004, 5.185908126537075e-14, std::numeric_limits<double>::denorm_min() })
  {
    EXPECT_EQ(judge(velocity).kind, Kind::NearZero) << velocity;
    EXPECT_TRUE(range_.stops(velocity)) << velocity;
  }
  EXPECT_EQ(judge(0.006).kind, Kind::Motion);
  EXPECT_FALSE(range_.stops(0.006));
}

TEST_F(Range, onlyAnExactZeroIsZero)
{
  EXPECT_EQ(judge(0.0).kind, Kind::Zero);
  EXPECT_EQ(judge(-0.0).kind, Kind::Zero);
  EXPECT_TRUE(range_.stops(-0.0));
}

TEST_F(Range, whatIsBelowTheMinimumIsAStop)
{
  config_.min_velocity = 5.0;
  EXPECT_EQ(judge(4.999).kind, Kind::NearZero);
  EXPECT_EQ(judge(-4.999).kind, Kind::NearZero);
  EXPECT_EQ(judge(5.0).kind, Kind::Motion);
}

TEST_F(Range, theLimitsOfAPublisherThatComputesInFloatsAreTheLimits)
{
  for (const float limit : { 0.3F, 0.1F, 0.7F, 1.2F, 1.1F })
  {
    // The decimal number that the float stands for.
    config_.max_velocity = std::round(static_cast<double>(limit) * 10.0) / 10.0;
    config_.min_velocity = config_.max_velocity;
    EXPECT_EQ(judge(static_cast<double>(limit)).kind, Kind::Motion) << limit;
    EXPECT_EQ(judge(static_cast<double>(-limit)).kind, Kind::Motion) << limit;
    EXPECT_LE(judge(static_cast<double>(limit)).velocity, config_.max_velocity);
  }
}

TEST_F(Range, aMillionthBeyondTheMaximumIsTheMaximum)
{
  EXPECT_EQ(judge(50.0 * (1.0 + 0.9e-6)).velocity, 50.0);
  EXPECT_EQ(judge(-50.0 * (1.0 + 0.9e-6)).velocity, -50.0);
  EXPECT_EQ(judge(50.0 * (1.0 + 1.1e-6)).kind, Kind::Refused);
  EXPECT_EQ(judge(-1e300).kind, Kind::Refused);
  EXPECT_THAT(judge(50.001).why, AllOf(HasSubstr("velocity 50.001"), HasSubstr("0, or up to 50 in either direction")));
}

TEST_F(Range, whatIsALittleTooMuchDoesNotLookLikeTheMaximum)
{
  config_.max_velocity = 0.3;
  EXPECT_THAT(judge(0.3000006).why, HasSubstr("velocity 0.3000006 is"));
}

TEST_F(Range, noNumbersAreRefusedWhateverTheLimit)
{
  for (const Limit limit : { Limit::Refuse, Limit::Saturate })
  {
    config_.limit = limit;
    for (const double velocity : { NOT_A_NUMBER, INFINITE, -INFINITE })
    {
      EXPECT_EQ(judge(velocity).kind, Kind::Refused);
      EXPECT_FALSE(range_.stops(velocity));
      EXPECT_EQ(range_.factorFor(velocity), 1.0);
    }
  }
}

TEST_F(Range, saturateClampsAndNeverEnlarges)
{
  config_.limit = Limit::Saturate;
  config_.min_velocity = 5.0;
  EXPECT_EQ(judge(80.0, range_.factorFor(80.0)).velocity, 50.0);
  EXPECT_EQ(judge(-1e300, range_.factorFor(-1e300)).velocity, -50.0);
  EXPECT_EQ(judge(20.0, range_.factorFor(20.0)).velocity, 20.0);
  EXPECT_EQ(judge(4.0, range_.factorFor(4.0)).kind, Kind::NearZero);
}

TEST_F(Range, theFactorOfTheGroupReducesOneThatIsInRange)
{
  EXPECT_EQ(judge(20.0, 0.5).velocity, 10.0);
  EXPECT_EQ(judge(-20.0, 0.5).velocity, -10.0);
  EXPECT_EQ(judge(0.0, 0.5).kind, Kind::Zero);
}

TEST_F(Range, oneThatRefusesIsJudgedBeforeTheFactor)
{
  EXPECT_EQ(range_.factorFor(80.0), 1.0);
  EXPECT_EQ(judge(80.0, 0.5).kind, Kind::Refused);
}

TEST_F(Range, oneThatTheFactorBringsNearZeroIsRefusedButNotOneThatWasThere)
{
  config_.min_velocity = 5.0;
  EXPECT_EQ(judge(8.0, 0.5).kind, Kind::Refused);
  EXPECT_THAT(judge(8.0, 0.5).why, HasSubstr("50 %"));
  EXPECT_EQ(judge(4.0, 0.5).kind, Kind::NearZero);
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What a drive is told at every connect.

#include "bus/inverter/connect_steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{

TEST(ConnectSteps, driveWithoutTheSequenceIsToldNothing)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  const ConnectSteps steps(mx2);
  EXPECT_EQ(steps.next(), nullptr);
  EXPECT_TRUE(steps.complete());
}

class WithSequence : public testing::Test
{
protected:
  static drive::Drive make()
  {
    drive::Profile profile = drive::loadProfile("omron_mx2", drive::profileDirectory());
    drive::Step first;
    first.point = "frequency";
    first.value = 1;
    drive::Step second;
    second.point = "frequency";
    second.value = 2;
    profile.sequences["connect"].steps = { first, second };
    return drive::Drive(profile);
  }

  const drive::Drive drive_ = make();
  ConnectSteps steps_{ drive_ };
};

TEST_F(WithSequence, goesStepByStep)
{
  ASSERT_NE(steps_.next(), nullptr);
  EXPECT_EQ(steps_.next()->value, 1U);
  steps_.done(reply("10 00 00 00 02"));
  EXPECT_FALSE(steps_.complete());
  EXPECT_EQ(steps_.next()->value, 2U);
  steps_.done(reply("10 00 00 00 02"));
  EXPECT_TRUE(steps_.complete());
  EXPECT_EQ(steps_.next(), nullptr);
}

TEST_F(WithSequence, lostStepIsToldAgain)
{
  steps_.done(lost());
  ASSERT_NE(steps_.next(), nullptr);
  EXPECT_EQ(steps_.next()->value, 1U);
}

TEST_F(WithSequence, refusalEndsIt)
{
  steps_.done(exception(0x90, 0x02));
  EXPECT_EQ(steps_.next(), nullptr);
  EXPECT_FALSE(steps_.complete());
  EXPECT_EQ(steps_.refusedWith(), 0x9002);
}

TEST_F(WithSequence, allOfItGoesAgainAfterARestart)
{
  steps_.done(reply("10 00 00 00 02"));
  steps_.done(exception(0x90, 0x02));
  steps_.restart();
  ASSERT_NE(steps_.next(), nullptr);
  EXPECT_EQ(steps_.next()->value, 1U);
  EXPECT_EQ(steps_.refusedWith(), 0);
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

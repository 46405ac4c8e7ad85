// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "bus/inverter/repeats.h"

#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
TEST(Repeats, sendsALostRequestAgainAsOftenAsConfigured)
{
  Repeats repeats(2);
  for (int request = 0; request < 2; ++request)
  {
    EXPECT_TRUE(repeats.again(lost()));
    EXPECT_TRUE(repeats.again(lost()));
    EXPECT_FALSE(repeats.again(lost())) << "the next request has its own";
  }
}

TEST(Repeats, withoutRetriesNothingIsRepeated)
{
  Repeats repeats(0);
  EXPECT_FALSE(repeats.again(lost()));
  EXPECT_FALSE(repeats.again(lost()));
}

TEST(Repeats, anAnswerEndsThemARefusalToo)
{
  Repeats repeats(1);
  for (const wire::Reply& answer : { reply("03 02 00 00"), exception(0x83, 2) })
  {
    EXPECT_TRUE(repeats.again(lost()));
    EXPECT_FALSE(repeats.again(answer));
    EXPECT_TRUE(repeats.again(lost()));
    repeats.restart();
  }
}

TEST(Repeats, aGatewayThatSaysThatTheDriveIsSilentHasTriedItself)
{
  Repeats repeats(1);
  wire::Reply by_gateway = lost();
  by_gateway.gateway_code = 0x0B;
  EXPECT_FALSE(repeats.again(by_gateway));
}

TEST(Repeats, beginAnewForAnotherRequest)
{
  Repeats repeats(1);
  EXPECT_TRUE(repeats.again(lost()));
  repeats.restart();
  EXPECT_TRUE(repeats.again(lost()));
  EXPECT_FALSE(repeats.again(lost()));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

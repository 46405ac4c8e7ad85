// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "bus/inverter/link.h"

#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using wire::Outcome;

constexpr bool PROBE = true;

wire::Reply answer(int time, int turnaround = 5)
{
  wire::Reply answer = reply("", at(time));
  answer.turnaround = Ms(turnaround);
  return answer;
}

/// An inverter that was online.
class LostLink : public testing::Test
{
protected:
  LostLink()
  {
    link_.answered(answer(0));
    link_.statusComplete();
    link_.goOffline(wire::ERROR_TIMEOUT);
  }

  Link link_{ 3 };
};

TEST(Link, isNeitherOfflineNorKnownAtFirst)
{
  Link link(3);
  EXPECT_FALSE(link.offline());
  EXPECT_FALSE(link.silent());
  EXPECT_FALSE(link.known());
  EXPECT_FALSE(link.everKnown());
  EXPECT_FALSE(link.lastAnswer());
  EXPECT_FALSE(link.statusComplete()) << "the first status is no return";
  EXPECT_TRUE(link.known());
  EXPECT_TRUE(link.everKnown());
  EXPECT_EQ(0U, link.returns());
}

TEST(Link, showsAnErrorUntilAnotherExchangeIsAnswered)
{
  Link link(3);
  link.failed(wire::ERROR_DAMAGED);
  EXPECT_EQ(wire::ERROR_DAMAGED, link.error());
  link.answered(answer(10));
  EXPECT_EQ(0, link.error());
}

TEST(Link, keepsTheSlowestAndTheLastAnswer)
{
  Link link(3);
  link.answered(answer(10, 8));
  link.answered(answer(20, 6));
  ASSERT_TRUE(link.lastAnswer());
  EXPECT_EQ(at(20), *link.lastAnswer());
  EXPECT_EQ(Ms(8), link.slowestReply());
  link.cameLate(Ms(90));
  link.cameLate(Ms(70));
  EXPECT_EQ(Ms(90), link.latestReply());
  EXPECT_EQ(Ms(8), link.slowestReply()) << "it was not waited for";
}

TEST(Link, aDriveSendsDataUntilSoManyExchangesBroughtNone)
{
  Link link(2);
  EXPECT_FALSE(link.sendsData()) << "it has never sent any";
  link.dataRead();
  link.exchangeEnded(lost());
  EXPECT_TRUE(link.sendsData());
  link.exchangeEnded(exception(0x83, 4));
  EXPECT_FALSE(link.sendsData());
}

TEST(Link, knowsWhatTheGatewaySaidOfTheLastExchange)
{
  Link link(3);
  wire::Reply by_gateway = lost();
  by_gateway.gateway_code = 0x0B;
  link.exchangeEnded(by_gateway);
  EXPECT_EQ(0x0B, link.gatewayCode());
  link.exchangeEnded(lost());
  EXPECT_EQ(0, link.gatewayCode());
}

TEST_F(LostLink, isBackWithACompleteStatusOnly)
{
  EXPECT_TRUE(link_.offline());
  EXPECT_FALSE(link_.known());
  EXPECT_TRUE(link_.everKnown());
  link_.answered(answer(10));
  EXPECT_TRUE(link_.offline());
  EXPECT_TRUE(link_.onTrial());
  EXPECT_FALSE(link_.silent());
  EXPECT_EQ(wire::ERROR_TIMEOUT, link_.error()) << "why it is offline still holds";
  EXPECT_TRUE(link_.statusComplete());
  EXPECT_FALSE(link_.offline());
  EXPECT_FALSE(link_.onTrial());
  EXPECT_TRUE(link_.known());
  EXPECT_EQ(0, link_.error());
  EXPECT_EQ(1U, link_.returns());
}

TEST_F(LostLink, aTrialThatLeadsToNothingLeavesItSilent)
{
  link_.noteCost(PROBE, Outcome::Ok, Ms(20));
  link_.answered(answer(10));
  EXPECT_EQ(Ms(20), link_.endTrial());
  EXPECT_TRUE(link_.silent());
}

TEST_F(LostLink, aLateReplyToAProbeIsWorthATrialAndTellsHowSlowTheDriveIs)
{
  link_.beginTrial(Ms(60));
  EXPECT_FALSE(link_.onTrial()) << "no probe was sent";
  EXPECT_EQ(Ms(5), link_.slowestReply());
  link_.noteCost(PROBE, Outcome::Timeout, Ms(40));
  link_.beginTrial(Ms(60));
  EXPECT_TRUE(link_.onTrial());
  EXPECT_EQ(Ms(60), link_.slowestReply());
}

TEST(Link, aLateReplyOfAnInverterThatIsOnlineBeginsNothing)
{
  Link link(3);
  link.noteCost(PROBE, Outcome::Timeout, Ms(40));
  link.beginTrial(Ms(60));
  EXPECT_FALSE(link.onTrial());
}

TEST_F(LostLink, tellsHowTheLastProbeEndedUnlessItWasAnswered)
{
  link_.probed(exception(0x83, 2));
  EXPECT_EQ(0x8302, link_.error());
  link_.probed(answer(10));
  EXPECT_EQ(0x8302, link_.error()) << "a loop-back is no status";
}

TEST_F(LostLink, aPortThatIsBackIsNoReasonAnyMore)
{
  link_.goOffline(wire::ERROR_PORT_LOST);
  link_.probed(answer(10));
  EXPECT_EQ(wire::ERROR_TIMEOUT, link_.error()) << "its status is what is missing now";
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// An offline inverter that answers is tried, at the probes' cost if that leads to nothing (contract, 8.15).

#include "bus/inverter/trial.h"

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
constexpr bool NO_PROBE = false;

TEST(Trial, beginsWithAnAnswer)
{
  Trial trial;
  EXPECT_FALSE(trial.underWay());
  trial.begin();
  EXPECT_TRUE(trial.underWay());
}

TEST(Trial, costsInFullWhatWasLostOrRefused)
{
  Trial trial;
  trial.exchangeEnded(PROBE, Outcome::Exception, Ms(20));
  trial.begin();
  trial.exchangeEnded(NO_PROBE, Outcome::Timeout, Ms(300));
  EXPECT_EQ(Ms(320), trial.end());
  EXPECT_FALSE(trial.underWay());
}

TEST(Trial, whatBroughtDataDelaysTheNextProbeOnlyALittle)
{
  Trial cheap;
  cheap.exchangeEnded(PROBE, Outcome::Ok, Ms(20));
  cheap.begin();
  cheap.exchangeEnded(NO_PROBE, Outcome::Ok, Ms(30));
  EXPECT_EQ(Ms(50), cheap.end());
  Trial dear;
  dear.begin();
  dear.exchangeEnded(NO_PROBE, Outcome::Ok, Ms(900));
  dear.exchangeEnded(NO_PROBE, Outcome::Timeout, Ms(100));
  EXPECT_EQ(Ms(135), dear.end());
}

TEST(Trial, whatWasBeforeItIsNotItsCost)
{
  Trial trial;
  trial.exchangeEnded(PROBE, Outcome::Timeout, Ms(500));
  trial.exchangeEnded(PROBE, Outcome::Ok, Ms(20));
  trial.begin();
  EXPECT_EQ(Ms(20), trial.end());
}

TEST(Trial, beginsWithALateReplyToAProbeWhichIsPaidForAlready)
{
  Trial trial;
  EXPECT_FALSE(trial.beginLate()) << "it was not asked";
  trial.exchangeEnded(PROBE, Outcome::Timeout, Ms(100));
  EXPECT_TRUE(trial.beginLate());
  EXPECT_TRUE(trial.underWay());
  trial.exchangeEnded(NO_PROBE, Outcome::Timeout, Ms(40));
  EXPECT_EQ(Ms(40), trial.end());
}

TEST(Trial, oneLateReplyBeginsOneTrial)
{
  Trial trial;
  trial.exchangeEnded(PROBE, Outcome::Timeout, Ms(100));
  ASSERT_TRUE(trial.beginLate());
  EXPECT_FALSE(trial.beginLate());
  trial.end();
  EXPECT_FALSE(trial.beginLate()) << "not before the next probe";
}

TEST(Trial, isOverWhenTheInverterGoesOfflineAgain)
{
  Trial trial;
  trial.exchangeEnded(PROBE, Outcome::Timeout, Ms(100));
  trial.begin();
  trial.drop();
  EXPECT_FALSE(trial.underWay());
  EXPECT_FALSE(trial.beginLate());
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

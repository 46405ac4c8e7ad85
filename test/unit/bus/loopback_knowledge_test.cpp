// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "bus/inverter/loopback_knowledge.h"

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr bool ON_A_LINE = false;
constexpr bool OVER_TCP = true;

TEST(LoopbackKnowledge, oneMissIsEnoughOverTcp)
{
  LoopbackKnowledge loopback(OVER_TCP);
  EXPECT_TRUE(loopback.usable());
  loopback.note(wire::Outcome::Timeout);
  EXPECT_FALSE(loopback.usable());
}

TEST(LoopbackKnowledge, aDriveThatAnswersNothingAtAllIsNotTakenForOneWithoutIt)
{
  LoopbackKnowledge loopback(ON_A_LINE);
  for (int tries = 0; tries < 10; ++tries)
  {
    loopback.note(wire::Outcome::Timeout);
  }
  EXPECT_TRUE(loopback.usable());
}

TEST(LoopbackKnowledge, aDriveThatIsSilentOnItAloneIsNotAskedAgainAndAgain)
{
  LoopbackKnowledge loopback(ON_A_LINE);
  for (int tries = 0; tries < 3; ++tries)
  {
    EXPECT_TRUE(loopback.usable());
    loopback.note(wire::Outcome::Timeout);
    loopback.otherAnswered();
  }
  EXPECT_FALSE(loopback.usable());
  EXPECT_TRUE(loopback.worthATry()) << "a probe costs the same either way";
  loopback.tryAgain();
  EXPECT_TRUE(loopback.usable()) << "another drive may be there after a return";
}

TEST(LoopbackKnowledge, oneThatHasWorkedIsTrusted)
{
  LoopbackKnowledge loopback(ON_A_LINE);
  EXPECT_FALSE(loopback.proven());
  loopback.note(wire::Outcome::Ok);
  EXPECT_TRUE(loopback.proven());
  for (int tries = 0; tries < 10; ++tries)
  {
    loopback.note(wire::Outcome::Timeout);
    loopback.otherAnswered();
  }
  EXPECT_TRUE(loopback.usable());
}

TEST(LoopbackKnowledge, aRefusedOneIsNotSentAgainNotEvenAfterAReturn)
{
  LoopbackKnowledge loopback(ON_A_LINE);
  loopback.note(wire::Outcome::Exception);
  EXPECT_FALSE(loopback.usable());
  EXPECT_FALSE(loopback.worthATry());
  loopback.tryAgain();
  EXPECT_FALSE(loopback.usable());
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "bus/inverter/liveness.h"

#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr Duration SHORT = Ms(10);
constexpr Duration LONG = Ms(14);

wire::Reply reply(wire::Outcome outcome, std::uint16_t error_id)
{
  wire::Reply reply;
  reply.outcome = outcome;
  reply.error_id = error_id;
  return reply;
}

wire::Reply good()
{
  return reply(wire::Outcome::Ok, 0);
}

wire::Reply silence()
{
  return reply(wire::Outcome::Timeout, wire::ERROR_TIMEOUT);
}

wire::Reply damage()
{
  return reply(wire::Outcome::Damaged, wire::ERROR_DAMAGED);
}

TEST(Liveness, soManyLostExchangesInARowMakeAnInverterOffline)
{
  Liveness liveness(3);
  EXPECT_FALSE(liveness.lost(false));
  EXPECT_FALSE(liveness.lost(false));
  EXPECT_TRUE(liveness.lost(false));
}

TEST(Liveness, shortWaitsTakeNobodyOfflineSoonerThanFullOnes)
{
  Liveness liveness(2, Ms(400));
  liveness.waitedBriefly(at(100));
  EXPECT_FALSE(liveness.lost(false));
  liveness.waitedBriefly(at(150));
  EXPECT_TRUE(liveness.lost(false));
  EXPECT_TRUE(liveness.tooSoon(at(499)));
  EXPECT_FALSE(liveness.tooSoon(at(500)));
  liveness.dataRead();
  EXPECT_FALSE(liveness.tooSoon(at(110))) << "no wait of this row was short";
}

TEST(Liveness, refusedRunWordsCountLikeLostExchanges)
{
  Liveness liveness(2);
  EXPECT_FALSE(liveness.lost(false));
  EXPECT_TRUE(liveness.refused());
}

TEST(Liveness, dataEndsTheRow)
{
  Liveness liveness(2);
  liveness.lost(false);
  liveness.dataRead();
  EXPECT_FALSE(liveness.lost(false));
}

TEST(Liveness, lostWritesAloneTakeNobodyOfflineButWantARead)
{
  Liveness liveness(2);
  EXPECT_FALSE(liveness.lost(true));
  EXPECT_FALSE(liveness.needsRead());
  EXPECT_FALSE(liveness.lost(true));
  EXPECT_TRUE(liveness.needsRead());
  EXPECT_TRUE(liveness.lost(false));
  EXPECT_FALSE(liveness.needsRead());
}

TEST(Liveness, withoutAStatusItIsOverdueAfterTwoSeconds)
{
  Liveness liveness(3);
  liveness.complete(at(1000));
  liveness.noteRead(LONG, silence());
  liveness.noteRead(LONG, silence());
  EXPECT_FALSE(liveness.overdue(at(3000), Ms(100)));
  EXPECT_TRUE(liveness.overdue(at(3001), Ms(100)));
}

TEST(Liveness, oneThatIsReadSeldomHasThreeOfItsPeriods)
{
  Liveness liveness(3);
  liveness.complete(at(1000));
  liveness.noteRead(LONG, silence());
  liveness.noteRead(LONG, silence());
  EXPECT_FALSE(liveness.overdue(at(31000), Ms(10000)));
  EXPECT_TRUE(liveness.overdue(at(31001), Ms(10000)));
}

TEST(Liveness, oneThatWasNotAskedIsNotOverdue)
{
  Liveness liveness(3);
  liveness.complete(at(0));
  liveness.noteRead(LONG, good());
  EXPECT_FALSE(liveness.overdue(at(60000), Ms(100)));
}

TEST(Liveness, oneThatLostASingleExchangeAndWasNotAskedSinceIsNotOverdue)
{
  Liveness liveness(3);
  liveness.complete(at(0));
  liveness.noteRead(LONG, damage());
  EXPECT_FALSE(liveness.overdue(at(60000), Ms(100)));
  liveness.noteRead(LONG, damage());
  EXPECT_TRUE(liveness.overdue(at(60000), Ms(100)));
}

TEST(Liveness, aMissingStatusIsItsOwnOnceItHasLostAnything)
{
  Liveness liveness(3);
  liveness.complete(at(0));
  liveness.missed(wire::ERROR_TIMEOUT);
  liveness.missed(wire::ERROR_TIMEOUT);
  EXPECT_TRUE(liveness.overdue(at(2001), Ms(100)));
  EXPECT_EQ(liveness.lastError(), wire::ERROR_TIMEOUT);
}

TEST(Liveness, aCompleteStatusForgivesEverything)
{
  Liveness liveness(2);
  liveness.lost(false);
  liveness.noteRead(LONG, damage());
  liveness.complete(at(5000));
  EXPECT_FALSE(liveness.overdue(at(9000), Ms(100)));
  EXPECT_FALSE(liveness.lost(false));
  EXPECT_EQ(liveness.reason(), "");
  EXPECT_EQ(liveness.lastError(), 0);
}

TEST(Liveness, timeInWhichNobodyLookedIsNotCounted)
{
  Liveness liveness(3);
  liveness.complete(at(1000));
  liveness.noteRead(LONG, silence());
  liveness.noteRead(LONG, silence());
  liveness.notWatching(at(61500), Ms(60000));
  EXPECT_FALSE(liveness.overdue(at(63000), Ms(100)));
  EXPECT_TRUE(liveness.overdue(at(63001), Ms(100))) << "what was counted before goes on";
}

TEST(Liveness, timeInWhichNobodyLookedIsNoCreditForLater)
{
  Liveness liveness(3);
  liveness.complete(at(1000));
  liveness.notWatching(at(1100), Ms(60000));
  liveness.noteRead(LONG, silence());
  liveness.noteRead(LONG, silence());
  EXPECT_TRUE(liveness.overdue(at(3101), Ms(100)));
}

TEST(Liveness, aDriveMayBeDeafUntilItIsHeardOrTheTimeHasPassed)
{
  Liveness liveness(3);
  EXPECT_FALSE(liveness.mayBeDeaf(at(0)));
  liveness.deafUntil(at(1000));
  EXPECT_TRUE(liveness.mayBeDeaf(at(999)));
  EXPECT_FALSE(liveness.mayBeDeaf(at(1000)));
  liveness.heard();
  EXPECT_FALSE(liveness.mayBeDeaf(at(500)));
  liveness.deafUntil(at(2000));
  liveness.complete(at(1500));
  EXPECT_FALSE(liveness.mayBeDeaf(at(1500)));
}

TEST(Liveness, theDeafTimeOfAResetIsNotCounted)
{
  Liveness liveness(3);
  liveness.complete(at(0));
  liveness.deafUntil(at(6000));
  liveness.noteRead(LONG, silence());
  liveness.noteRead(LONG, silence());
  EXPECT_FALSE(liveness.overdue(at(6000), Ms(100)));
  EXPECT_TRUE(liveness.overdue(at(6001), Ms(100)));
}

TEST(Liveness, startUpHasItsOwnTime)
{
  Liveness liveness(3);
  liveness.watchFrom(at(6000));
  liveness.noteRead(LONG, silence());
  liveness.noteRead(LONG, silence());
  EXPECT_FALSE(liveness.overdue(at(8000), Ms(100)));
  EXPECT_TRUE(liveness.overdue(at(8001), Ms(100)));
}

TEST(Liveness, namesTheException)
{
  Liveness liveness(3);
  liveness.noteRead(SHORT, reply(wire::Outcome::Exception, 0x8102));
  EXPECT_EQ(liveness.reason(), "answers exception 02 to the status");
  EXPECT_EQ(liveness.lastError(), 0x8102);
}

TEST(Liveness, namesTheResponseCodeOfCompoway)
{
  Liveness liveness(3);
  liveness.noteRead(SHORT, reply(wire::Outcome::Exception, 0x1103));
  EXPECT_EQ(liveness.reason(), "answers 1103 to the status");
}

TEST(Liveness, countsDamagedLongReplies)
{
  Liveness liveness(3);
  for (int read = 0; read < 5; ++read)
  {
    liveness.noteRead(SHORT, good());
    liveness.noteRead(LONG, read == 2 ? good() : damage());
  }
  EXPECT_EQ(liveness.reason(), "damaged long replies: 4 of 5");
}

TEST(Liveness, countsLongRepliesThatDoNotCome)
{
  Liveness liveness(3);
  for (int read = 0; read < 2; ++read)
  {
    liveness.noteRead(SHORT, good());
    liveness.noteRead(LONG, silence());
  }
  EXPECT_EQ(liveness.reason(), "no long replies: 2 of 2");
}

TEST(Liveness, damageOfAnyLengthIsNotCalledLong)
{
  Liveness liveness(3);
  liveness.noteRead(SHORT, damage());
  liveness.noteRead(LONG, damage());
  liveness.noteRead(LONG, good());
  EXPECT_EQ(liveness.reason(), "damaged replies to the status: 2 of 3");
}

TEST(Liveness, hasNothingToAddToPlainSilence)
{
  Liveness liveness(3);
  liveness.noteRead(SHORT, good());
  liveness.noteRead(LONG, silence());
  liveness.noteRead(SHORT, silence());
  EXPECT_EQ(liveness.reason(), "") << "what was answered before it fell silent says nothing";
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "bus/inverter/lost_writes.h"

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace bus
{
namespace
{
TEST(LostWrites, givesAVelocityItsRetriesAndNoMore)
{
  LostWrites writes(2, 100);
  EXPECT_TRUE(writes.tryAgain());
  EXPECT_TRUE(writes.tryAgain());
  EXPECT_FALSE(writes.tryAgain());
}

TEST(LostWrites, withoutRetriesTheFirstLostOneEndsTheVelocity)
{
  LostWrites writes(0, 100);
  EXPECT_FALSE(writes.tryAgain());
}

TEST(LostWrites, anAcknowledgedWriteGivesNewTries)
{
  LostWrites writes(1, 100);
  EXPECT_TRUE(writes.tryAgain());
  writes.acknowledged();
  EXPECT_TRUE(writes.tryAgain());
  EXPECT_FALSE(writes.tryAgain());
}

TEST(LostWrites, aReadGivesNoNewTries)
{
  LostWrites writes(1, 100);
  EXPECT_TRUE(writes.tryAgain());
  writes.readAnswered();
  EXPECT_FALSE(writes.tryAgain());
}

TEST(LostWrites, theVelocityAfterOneThatHasFailedHasItsOwnTries)
{
  LostWrites writes(1, 100);
  writes.tryAgain();
  writes.tryAgain();
  writes.velocityEnded();
  EXPECT_TRUE(writes.tryAgain());
}

TEST(LostWrites, soManyInARowAreTooMany)
{
  LostWrites writes(9, 3);
  EXPECT_FALSE(writes.lost());
  EXPECT_FALSE(writes.lost());
  EXPECT_TRUE(writes.lost());
  EXPECT_EQ(writes.inARow(), 3);
}

TEST(LostWrites, theEndOfAVelocityAndAnsweredReadsDoNotClearThem)
{
  LostWrites writes(0, 2);
  EXPECT_FALSE(writes.lost());
  writes.velocityEnded();
  writes.readAnswered();
  EXPECT_TRUE(writes.lost());
}

TEST(LostWrites, anAcknowledgedWriteClearsThem)
{
  LostWrites writes(0, 2);
  writes.lost();
  writes.raise();
  writes.acknowledged();
  EXPECT_FALSE(writes.raised());
  EXPECT_FALSE(writes.lost());
  EXPECT_EQ(writes.inARow(), 1);
}

TEST(LostWrites, saysThatReadsAreAnsweredOnlyWhenOneWasAnsweredMeanwhile)
{
  LostWrites writes(0, 2);
  writes.readAnswered();
  writes.lost();
  EXPECT_EQ(writes.text(), "writes are lost");
  writes.raise();
  EXPECT_TRUE(writes.readAnswered());
  EXPECT_FALSE(writes.readAnswered());
  EXPECT_EQ(writes.text(), "reads are answered, writes are lost");
  writes.lost();
  EXPECT_EQ(writes.text(), "reads are answered, writes are lost");
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The text of a refused velocity is true when it is read, not only when it was refused.

#include "bus/inverter/command_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const Obstacles NONE;

Obstacles locked(bool tripped = false)
{
  Obstacles obstacles;
  obstacles.locked = true;
  obstacles.tripped = tripped;
  return obstacles;
}

Obstacles offline()
{
  Obstacles obstacles;
  obstacles.locked = true;
  obstacles.offline = true;
  return obstacles;
}

TEST(CommandError, aLockOfATripWantsAResetFirst)
{
  CommandError error;
  error.set(ERROR_LOCKED, lockedText(true), locked(true));
  EXPECT_THAT(error.text(locked(true), ""), AllOf(HasSubstr("tripped"), HasSubstr("call reset, then send 0")));
  EXPECT_EQ(error.text(locked(), ""), lockedText(false)) << "it was reset";
  EXPECT_THAT(error.text(NONE, ""), AllOf(HasSubstr("was locked"), HasSubstr("unlocked now")));
}

TEST(CommandError, aTripAfterTheRefusalOfALockIsTold)
{
  CommandError error;
  error.set(ERROR_LOCKED, lockedText(false), locked());
  EXPECT_EQ(error.text(locked(), ""), lockedText(false));
  EXPECT_EQ(error.text(locked(true), ""), lockedText(true));
}

TEST(CommandError, theLockOfOnePublisherIsToldAsItIs)
{
  CommandError error;
  error.set(ERROR_LOCKED, "locked for /user", NONE);
  EXPECT_EQ(error.text(NONE, ""), "locked for /user");
}

TEST(CommandError, whatWasAnotherMembersIsNotToldAsItsOwn)
{
  CommandError error;
  error.setForOther(ERROR_OFFLINE, "feed: velocity 3: the inverter is offline", 0, "", NONE);
  EXPECT_EQ(error.id(), ERROR_OFFLINE);
  EXPECT_EQ(error.text(NONE, ""), "the group was refused: one of its inverters was offline");
}

TEST(CommandError, anOwnReasonThatCountsLessIsToldWhileItLasts)
{
  CommandError error;
  error.setForOther(ERROR_OFFLINE, "feed: velocity 3: the inverter is offline", ERROR_LOCKED, lockedText(false),
                    locked());
  EXPECT_EQ(error.id(), ERROR_OFFLINE) << "the group's id is shown in every member";
  EXPECT_EQ(error.text(locked(), ""),
            "the group was refused: one of its inverters was offline; this inverter itself: " + lockedText(false));
  EXPECT_EQ(error.text(NONE, ""), "the group was refused: one of its inverters was offline");
}

TEST(CommandError, anOfflineMemberIsToldWhyAsLongAsItIs)
{
  CommandError error;
  error.setForOther(ERROR_OUT_OF_RANGE, "feed: velocity 300 is above 50", ERROR_OFFLINE, errorText(ERROR_OFFLINE),
                    offline());
  EXPECT_EQ(error.text(offline(), "no reply in time"),
            "the group was refused: feed: velocity 300 is above 50; this inverter itself: the inverter is offline: no "
            "reply in "
            "time");
  EXPECT_THAT(error.text(NONE, ""), Not(HasSubstr("offline")));
}

TEST(CommandError, aNewRefusalHasNothingOfAnOlderOne)
{
  CommandError error;
  error.setForOther(ERROR_OFFLINE, "", ERROR_LOCKED, lockedText(false), locked());
  error.set(ERROR_OUT_OF_RANGE, "300 is above 50", NONE);
  EXPECT_EQ(error.text(NONE, ""), "300 is above 50");
  error.setForOther(ERROR_LOCKED, "", 0, "", NONE);
  EXPECT_EQ(error.text(NONE, ""), "the group was refused: one of its inverters was locked");
  error.clear();
  EXPECT_EQ(error.id(), 0);
}

TEST(CommandError, aFailureAtTheDriveIsShownThroughAcceptedCommandsUntilOneIsConfirmed)
{
  CommandError error;
  error.failed(0x0205, "writes are lost");
  EXPECT_EQ(error.id(), 0x0205);
  EXPECT_EQ(error.text(NONE, ""), "the last velocity was not carried out: writes are lost");
  error.clear();
  EXPECT_EQ(error.id(), 0x0205) << "a stream of accepted ones would hide it";
  error.confirmed();
  EXPECT_EQ(error.id(), 0);
  EXPECT_EQ(error.text(NONE, ""), "");
}

TEST(CommandError, aRefusalIsShownBeforeAFailureAtTheDrive)
{
  CommandError error;
  error.failed(0x0205, "writes are lost");
  error.set(ERROR_LOCKED, lockedText(false), locked());
  EXPECT_EQ(error.id(), ERROR_LOCKED);
  EXPECT_EQ(error.text(locked(), ""), lockedText(false));
  error.clear();
  EXPECT_EQ(error.id(), 0x0205);
}

TEST(CommandError, whatFailedBeforeTheInverterWentOfflineIsOver)
{
  CommandError error;
  error.failed(0x0205, "writes are lost");
  error.wentOffline();
  EXPECT_EQ(error.id(), 0);
  EXPECT_FALSE(error.countsWhileOffline());
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Return to neutral and command watchdog: sections 4.2 and 4.3 of the contract, in virtual time.

#include "bus/rules/interlock.h"

#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
Publisher publisher(const std::string& name = "/planner", const std::string& topic = "/bus/belt/command")
{
  Publisher result;
  result.name = name;
  result.topic = topic;
  return result;
}

/// The first message on a new connection of a latched publisher.
Publisher latched(const std::string& name, bool before_start = false, const std::string& topic = "/bus/belt/command")
{
  Publisher result = publisher(name, topic);
  result.latched = true;
  result.first_on_connection = true;
  result.before_start = before_start;
  return result;
}

/// An interlock with publishers that command it as the bus does: judged, then booked.
class Guarded
{
public:
  explicit Guarded(double command_timeout = 0.5) : interlock(command_timeout)
  {
  }

  /// What would become of a velocity other than 0 at \p time [ms].
  Permission judge(int time, const Publisher& from = publisher()) const
  {
    return interlock.judge(at(time), from, holds).permission;
  }

  LockReason reason(int time, const Publisher& from = publisher()) const
  {
    return interlock.judge(at(time), from, holds).reason;
  }

  bool locked(int time) const
  {
    return interlock.locked(at(time), holds);
  }

  /// A velocity other than 0 at \p time [ms].
  Permission command(int time, const Publisher& from = publisher())
  {
    const Permission permission = judge(time, from);
    if (permission != Permission::Repeat)
    {
      interlock.commanded(at(time), from, permission == Permission::Granted, holds);
    }
    return permission;
  }

  void zero(int time, const Publisher& from = publisher())
  {
    interlock.zeroed(at(time), from);
  }

  void nearZero(int time, const Publisher& from = publisher())
  {
    interlock.nearlyZeroed(at(time), from);
  }

  /// Near zero every \p spacing ms from \p from until before \p end.
  void nearZeros(int from, int end, int spacing, const Publisher& who = publisher())
  {
    for (int time = from; time < end; time += spacing)
    {
      nearZero(time, who);
    }
  }

  /// Commands every \p spacing ms from \p from until before \p end; returns how many were granted.
  int stream(int from, int end, int spacing, const Publisher& who = publisher())
  {
    int granted = 0;
    for (int time = from; time < end; time += spacing)
    {
      granted += command(time, who) == Permission::Granted ? 1 : 0;
    }
    return granted;
  }

  void stopAndConfirm(int confirmed)
  {
    interlock.stopRequested();
    interlock.stopConfirmed(at(confirmed));
  }

  Interlock interlock;
  Holds holds;
};

/// Online since 0 ms and free for "/planner", whose first command came at 1000 ms.
class Running : public Guarded
{
public:
  explicit Running(double command_timeout = 0.5) : Guarded(command_timeout)
  {
    interlock.online(at(0));
    zero(900);
    EXPECT_EQ(command(1000), Permission::Granted);
  }
};

// --- all reasons in one place ----------------------------------------------------------------------------------------

/// What locks, with the reason that is told for it and with what ends it.
struct Cause
{
  const char* name;
  LockReason reason;
  void (*begin)(Guarded& belt);
  void (*end)(Guarded& belt, int time);
};

std::ostream& operator<<(std::ostream& out, const Cause& cause)
{
  return out << cause.name;
}

const Cause HOLDS[] = {
  { "unidentified", LockReason::Unidentified, [](Guarded& belt) { belt.holds.unidentified = true; },
    [](Guarded& belt, int) { belt.holds.unidentified = false; } },
  { "resetting", LockReason::Resetting, [](Guarded& belt) { belt.holds.resetting = true; },
    [](Guarded& belt, int) { belt.holds.resetting = false; } },
  { "in setup", LockReason::InSetup, [](Guarded& belt) { belt.holds.in_setup = true; },
    [](Guarded& belt, int) { belt.holds.in_setup = false; } },
};

class InterlockHold : public testing::TestWithParam<Cause>
{
};

INSTANTIATE_TEST_SUITE_P(Interlock, InterlockHold, testing::ValuesIn(HOLDS));

TEST_P(InterlockHold, locksAndRefusesEverybodyForOneReason)
{
  Running belt;
  EXPECT_FALSE(belt.locked(2000));
  GetParam().begin(belt);
  EXPECT_TRUE(belt.locked(2000));
  EXPECT_EQ(belt.reason(2000), GetParam().reason) << "who was let in";
  belt.zero(2000, publisher("/neutral"));
  EXPECT_TRUE(belt.locked(2000));
  EXPECT_EQ(belt.reason(2000, publisher("/neutral")), GetParam().reason);
  EXPECT_EQ(belt.reason(60000, publisher("/silent")), GetParam().reason);
  EXPECT_TRUE(belt.locked(60000));
}

TEST_P(InterlockHold, whoWasRefusedMustReturnToNeutral)
{
  Running belt;
  GetParam().begin(belt);
  EXPECT_EQ(belt.command(2000), Permission::Locked);
  GetParam().end(belt, 2100);
  EXPECT_EQ(belt.command(2100), Permission::Locked) << "the motor must not start when the hold happens to end";
  EXPECT_EQ(belt.reason(2100), LockReason::Neutral);
  EXPECT_TRUE(belt.locked(2100)) << "nobody is free";
  belt.zero(2200);
  EXPECT_FALSE(belt.locked(2200));
  EXPECT_EQ(belt.command(2210), Permission::Granted);
}

TEST_P(InterlockHold, whoWasRefusedMayAlsoBeSilent)
{
  Running belt;
  GetParam().begin(belt);
  EXPECT_EQ(belt.stream(2000, 2400, 100), 0);
  GetParam().end(belt, 2400);
  EXPECT_TRUE(belt.locked(2799));
  EXPECT_EQ(belt.judge(2800), Permission::Granted);
  EXPECT_FALSE(belt.locked(2800));
}

TEST_P(InterlockHold, whoHasSentNothingMeanwhileGoesOn)
{
  Running belt;
  GetParam().begin(belt);
  EXPECT_EQ(belt.command(2000, publisher("/other")), Permission::Locked);
  GetParam().end(belt, 2100);
  EXPECT_FALSE(belt.locked(2100));
  EXPECT_EQ(belt.command(2110), Permission::Granted);
  EXPECT_EQ(belt.command(2120, publisher("/other")), Permission::Locked) << "the lock counts per publisher";
}

TEST_P(InterlockHold, doesNotDisturbTheSilenceOfALockBehindIt)
{
  Running belt;
  belt.stopAndConfirm(2000);
  GetParam().begin(belt);
  GetParam().end(belt, 2400);
  EXPECT_TRUE(belt.locked(2499));
  EXPECT_FALSE(belt.locked(2500));
}

TEST_P(InterlockHold, whatCountsMoreIsTheAnswer)
{
  Running belt;
  GetParam().begin(belt);
  belt.interlock.stopRequested();
  EXPECT_EQ(belt.judge(2000), Permission::StopPending);
  EXPECT_TRUE(belt.locked(2000));
  belt.interlock.offline();
  EXPECT_EQ(belt.judge(2000), Permission::Offline);
  EXPECT_TRUE(belt.locked(2000));
}

TEST(Interlock, aStopThatLocksNobodyIsNoLock)
{
  Running belt;
  belt.holds.stop = true;
  EXPECT_EQ(belt.command(2000), Permission::StopPending);
  EXPECT_FALSE(belt.locked(2000));
  belt.holds.stop = false;
  EXPECT_EQ(belt.command(2100), Permission::Granted);
}

TEST(Interlock, aStopThatIsConfirmedBeforeTheFirstStatusOpensNothing)
{
  Guarded belt;
  belt.stopAndConfirm(0);
  belt.zero(10);
  EXPECT_TRUE(belt.locked(60000));
  EXPECT_EQ(belt.reason(60000), LockReason::Unread);
  EXPECT_EQ(belt.reason(60000, publisher("/other")), LockReason::Unread);
  belt.interlock.online(at(60000));
  EXPECT_EQ(belt.judge(60000), Permission::Granted) << "it has sent 0 since the stop";
  EXPECT_FALSE(belt.locked(60000));
}

TEST(Interlock, saysWhichReasonItIs)
{
  Guarded belt;
  EXPECT_EQ(belt.reason(0), LockReason::Unread);
  belt.interlock.online(at(0));
  EXPECT_EQ(belt.reason(100), LockReason::Neutral);
  belt.interlock.faulted(true);
  EXPECT_EQ(belt.reason(10000), LockReason::Tripped);
  belt.holds.resetting = true;
  EXPECT_EQ(belt.reason(10000), LockReason::Resetting);
  belt.holds.unidentified = true;
  EXPECT_EQ(belt.reason(10000), LockReason::Unidentified);
}

// --- start-up --------------------------------------------------------------------------------------------------------

TEST(Interlock, isLockedBeforeTheFirstStatus)
{
  Guarded belt;
  EXPECT_TRUE(belt.locked(0));
  EXPECT_EQ(belt.command(0), Permission::Locked);
  EXPECT_EQ(belt.command(100000, publisher("/other")), Permission::Locked);
}

TEST(Interlock, streamThatGoesOnAcrossTheStartIsRefusedForEver)
{
  Guarded belt;
  EXPECT_EQ(belt.stream(0, 1000, 100), 0);
  belt.interlock.online(at(1000));
  EXPECT_EQ(belt.stream(1000, 60000, 100), 0);
  EXPECT_TRUE(belt.locked(60000));
}

TEST(Interlock, silenceAtStartCountsFromTheFirstStatusAlsoAfterAStop)
{
  Guarded guarded;
  guarded.interlock.stopRequested();
  guarded.interlock.stopConfirmed(at(100));
  guarded.interlock.online(at(1000));
  EXPECT_EQ(guarded.judge(1499), Permission::Locked);
  EXPECT_EQ(guarded.judge(1500), Permission::Granted);
}

TEST(Interlock, zeroUnlocksAtStart)
{
  Guarded belt;
  belt.interlock.online(at(0));
  belt.zero(10);
  EXPECT_EQ(belt.command(20), Permission::Granted);
  EXPECT_FALSE(belt.locked(20));
}

TEST(Interlock, silenceFromTheFirstStatusOnUnlocks)
{
  Guarded belt;
  belt.interlock.online(at(0));
  EXPECT_EQ(belt.judge(499), Permission::Locked);
  EXPECT_TRUE(belt.locked(499));
  EXPECT_EQ(belt.judge(500), Permission::Granted);
  EXPECT_FALSE(belt.locked(500));
}

TEST(Interlock, silenceBeforeTheFirstStatusDoesNotCount)
{
  Guarded belt;
  belt.command(0);
  belt.interlock.online(at(60000));
  EXPECT_EQ(belt.judge(60100), Permission::Locked);
}

TEST(Interlock, laterStatusesDoNotStartTheSilenceAgain)
{
  Guarded belt;
  for (int time = 0; time <= 500; time += 50)
  {
    belt.interlock.online(at(time));
  }
  EXPECT_EQ(belt.command(500), Permission::Granted);
}

// --- silence windows -------------------------------------------------------------------------------------------------

TEST(Interlock, silenceLastsAtLeastHalfASecond)
{
  Running belt(0.1);
  belt.stopAndConfirm(1200);
  EXPECT_EQ(belt.judge(1699), Permission::Locked);
  EXPECT_EQ(belt.judge(1700), Permission::Granted);
}

TEST(Interlock, silenceLastsAtLeastTheCommandTimeout)
{
  Running belt(2.0);
  belt.stopAndConfirm(1200);
  EXPECT_EQ(belt.judge(3199), Permission::Locked);
  EXPECT_EQ(belt.judge(3200), Permission::Granted);
}

TEST(Interlock, silenceLastsTwiceTheSpacingOfTheLastCommands)
{
  Running belt(0.0);
  belt.command(2500);
  belt.stopAndConfirm(2700);
  EXPECT_EQ(belt.judge(5699), Permission::Locked);
  EXPECT_EQ(belt.judge(5700), Permission::Granted);
}

TEST(Interlock, silenceForASlowStreamLastsFiveSecondsAtMost)
{
  Running belt(0.0);
  belt.command(21000);
  belt.stopAndConfirm(21200);
  EXPECT_EQ(belt.judge(26199), Permission::Locked);
  EXPECT_EQ(belt.judge(26200), Permission::Granted);
}

TEST(Interlock, streamOfOneCommandInTwoSecondsStaysRefused)
{
  Running belt(0.0);
  belt.stream(3000, 10000, 2000);
  belt.stopAndConfirm(9200);
  EXPECT_EQ(belt.stream(11000, 120000, 2000), 0);
}

TEST(Interlock, silenceCountsFromTheConfirmationAndNotFromTheRequest)
{
  Running belt;
  belt.interlock.stopRequested();
  EXPECT_EQ(belt.judge(60000), Permission::StopPending);
  belt.interlock.stopConfirmed(at(60000));
  EXPECT_EQ(belt.judge(60499), Permission::Locked);
  EXPECT_EQ(belt.judge(60500), Permission::Granted);
}

TEST(Interlock, everyRefusedCommandStartsTheSilenceAgain)
{
  Running belt;
  belt.stopAndConfirm(1200);
  EXPECT_EQ(belt.command(1600), Permission::Locked);
  EXPECT_EQ(belt.judge(1700), Permission::Locked);
}

// --- return to neutral -----------------------------------------------------------------------------------------------

TEST(Interlock, streamThatGoesOnAfterAStopIsRefused)
{
  Running belt;
  belt.stream(1100, 2000, 100);
  belt.stopAndConfirm(2050);
  EXPECT_EQ(belt.stream(2100, 60000, 100), 0);
}

TEST(Interlock, streamIsGrantedAgainAfterItsZero)
{
  Running belt;
  belt.stopAndConfirm(1200);
  EXPECT_EQ(belt.command(1300), Permission::Locked);
  belt.zero(1400);
  EXPECT_EQ(belt.stream(1500, 3000, 100), 15);
}

TEST(Interlock, zeroFromBeforeTheStopDoesNotUnlock)
{
  Running belt;
  belt.zero(1050);
  belt.stopAndConfirm(1200);
  EXPECT_EQ(belt.command(1300), Permission::Locked);
}

TEST(Interlock, zeroUnlocksOnlyThePublisherThatSentIt)
{
  Running belt;
  const Publisher other = publisher("/joystick");
  belt.command(1010, other);
  belt.stopAndConfirm(1200);
  belt.zero(1250, other);
  EXPECT_EQ(belt.command(1300), Permission::Locked);
  EXPECT_EQ(belt.command(1310, other), Permission::Granted);
  EXPECT_EQ(belt.stream(1400, 10000, 100), 0);
}

TEST(Interlock, acceptedCommandOfOnePublisherDoesNotAdmitAnother)
{
  Running belt;
  const Publisher other = publisher("/joystick");
  belt.stopAndConfirm(1200);
  belt.zero(1250, other);
  for (int time = 1300; time < 10000; time += 100)
  {
    EXPECT_EQ(belt.command(time, other), Permission::Granted);
    EXPECT_EQ(belt.command(time + 50), Permission::Locked);
  }
}

TEST(Interlock, zeroOnOneTopicUnlocksItsPublisherOnBoth)
{
  Running belt;
  belt.stopAndConfirm(1200);
  belt.zero(1250, publisher("/planner", "/bus/command"));
  EXPECT_EQ(belt.command(1300, publisher("/planner", "/bus/belt/command")), Permission::Granted);
}

TEST(Interlock, refusedStreamEndsItsNeutral)
{
  Running belt;
  belt.interlock.stopRequested();
  belt.zero(1100);
  EXPECT_EQ(belt.command(1150), Permission::StopPending);
  belt.interlock.stopConfirmed(at(1200));
  EXPECT_EQ(belt.stream(1250, 10000, 100), 0);
}

TEST(Interlock, commandsDuringAPendingStopAreRefusedAsCancelled)
{
  Running belt;
  belt.interlock.stopRequested();
  EXPECT_TRUE(belt.interlock.stopPending());
  EXPECT_EQ(belt.command(1100), Permission::StopPending);
  EXPECT_EQ(belt.command(1110, publisher("/joystick")), Permission::StopPending);
  EXPECT_TRUE(belt.locked(1110));
}

TEST(Interlock, secondStopLocksAgain)
{
  Running belt;
  belt.stopAndConfirm(1200);
  belt.zero(1300);
  belt.stopAndConfirm(1450);
  EXPECT_EQ(belt.command(1500), Permission::Locked);
}

TEST(Interlock, isShownFreeOnceSomebodyHasReturnedToNeutral)
{
  Running belt;
  EXPECT_FALSE(belt.locked(1000));
  belt.stopAndConfirm(1200);
  EXPECT_TRUE(belt.locked(1300));
  belt.zero(1310);
  EXPECT_FALSE(belt.locked(1310));
}

TEST(Interlock, isShownLockedWhileARefusedStreamGoesOn)
{
  Running belt;
  belt.stopAndConfirm(1200);
  belt.stream(1300, 5000, 100);
  EXPECT_TRUE(belt.locked(5000));
  EXPECT_FALSE(belt.locked(5500));
}

// --- latched publishers ----------------------------------------------------------------------------------------------

TEST(Interlock, oldMessageOfAPublisherThatWasForgottenAmongManyIsNoCommand)
{
  Running belt;
  for (int number = 0; number < 100; ++number)
  {
    belt.command(5000 + number, publisher("/anonymous_" + std::to_string(number)));
  }
  EXPECT_EQ(belt.command(60000, latched("/planner")), Permission::Repeat);
}

TEST(Interlock, firstMessageOfALatchedPublisherThatWasHeardBeforeIsARepeat)
{
  Running belt;
  EXPECT_EQ(belt.command(5000, latched("/planner")), Permission::Repeat);
}

TEST(Interlock, repeatIsNeitherGrantedAfterAStopNorLong)
{
  Running belt;
  belt.stopAndConfirm(1200);
  EXPECT_EQ(belt.command(60000, latched("/planner")), Permission::Repeat);
  EXPECT_EQ(belt.command(60010, latched("/planner")), Permission::Repeat);
}

TEST(Interlock, publisherWhoseOnlyMessageWasRefusedIsHeardToo)
{
  Guarded belt;
  belt.interlock.online(at(0));
  EXPECT_EQ(belt.command(100, latched("/once")), Permission::Locked);
  EXPECT_EQ(belt.command(60000, latched("/once")), Permission::Repeat);
}

TEST(Interlock, secondMessageOfALatchedConnectionIsACommand)
{
  Running belt;
  Publisher second = latched("/planner");
  second.first_on_connection = false;
  EXPECT_EQ(belt.command(1100, second), Permission::Granted);
}

TEST(Interlock, newLatchedPublisherThatWasNeverHeardIsACommand)
{
  Running belt;
  EXPECT_EQ(belt.command(5000, latched("/new")), Permission::Granted);
}

TEST(Interlock, latchedMessageOnATopicNotHeardBeforeIsNoRepeat)
{
  Running belt;
  EXPECT_EQ(belt.command(1100, latched("/planner", false, "/bus/command")), Permission::Granted);
}

TEST(Interlock, latchedMessageFromBeforeTheStartIsRefusedHoweverLongTheSilence)
{
  Guarded belt;
  belt.interlock.online(at(0));
  EXPECT_EQ(belt.command(600000, latched("/old", true)), Permission::Locked);
}

TEST(Interlock, publisherFromBeforeTheStartCommandsWithItsNextMessageAfterAZero)
{
  Guarded belt;
  belt.interlock.online(at(0));
  ASSERT_EQ(belt.command(10000, latched("/old", true)), Permission::Locked);
  Publisher next = latched("/old", true);
  next.first_on_connection = false;
  belt.zero(10100, next);
  EXPECT_EQ(belt.command(10200, next), Permission::Granted);
}

// --- fault and offline -----------------------------------------------------------------------------------------------

TEST(Interlock, faultKeepsTheLock)
{
  Running belt;
  belt.interlock.faulted(true);
  belt.stopAndConfirm(1200);
  belt.zero(1300);
  EXPECT_EQ(belt.command(60000), Permission::Locked);
  EXPECT_TRUE(belt.locked(60000));
  EXPECT_TRUE(belt.interlock.isFaulted());
}

TEST(Interlock, streamThatGoesOnThroughAFaultAndItsResetIsRefused)
{
  Running belt;
  belt.interlock.faulted(true);
  belt.stopAndConfirm(1200);
  EXPECT_EQ(belt.stream(1300, 5000, 100), 0);
  belt.interlock.faulted(false);
  belt.interlock.online(at(5000));
  EXPECT_EQ(belt.stream(5000, 60000, 100), 0);
}

TEST(Interlock, zeroAfterTheFaultUnlocks)
{
  Running belt;
  belt.interlock.faulted(true);
  belt.stopAndConfirm(1200);
  belt.interlock.faulted(false);
  belt.zero(1300);
  EXPECT_EQ(belt.command(1400), Permission::Granted);
}

TEST(Interlock, faultEndsThePermissionWithoutAnyStop)
{
  Running belt;
  belt.interlock.faulted(true);
  belt.interlock.faulted(false);
  EXPECT_EQ(belt.command(1100), Permission::Locked);
}

TEST(Interlock, offlineRefusesEveryCommand)
{
  Running belt;
  belt.interlock.offline();
  EXPECT_TRUE(belt.interlock.isOffline());
  belt.zero(1100);
  EXPECT_EQ(belt.command(1200), Permission::Offline);
  EXPECT_TRUE(belt.locked(1200));
}

TEST(Interlock, streamThatGoesOnAcrossAReturnIsRefused)
{
  Running belt;
  belt.interlock.offline();
  belt.stream(1100, 5000, 100);
  belt.interlock.online(at(5000));
  EXPECT_EQ(belt.stream(5000, 60000, 100), 0);
}

TEST(Interlock, silenceCountsFromTheReturnWhenNoStopIsPending)
{
  Running belt;
  belt.interlock.offline();
  belt.interlock.online(at(60000));
  EXPECT_EQ(belt.judge(60499), Permission::Locked);
  EXPECT_EQ(belt.judge(60500), Permission::Granted);
}

TEST(Interlock, returnDoesNotEndAPendingStop)
{
  Running belt;
  belt.interlock.offline();
  belt.interlock.stopRequested();
  belt.interlock.online(at(5000));
  EXPECT_EQ(belt.command(60000), Permission::StopPending);
  belt.interlock.stopConfirmed(at(61000));
  EXPECT_EQ(belt.judge(61100), Permission::Locked);
}

// --- command watchdog --------------------------------------------------------------------------------------------------------

TEST(Interlock, watchdogIsDueAfterTheCommandTimeoutWithoutACommand)
{
  Running belt(0.5);
  EXPECT_FALSE(belt.interlock.watchdogDue(at(1499)));
  EXPECT_TRUE(belt.interlock.watchdogDue(at(1500)));
  ASSERT_TRUE(belt.interlock.watchdogAt());
  EXPECT_EQ(*belt.interlock.watchdogAt(), at(1500));
}

TEST(Interlock, acceptedCommandsOfAnyPublisherFeedTheWatchdog)
{
  Running belt(0.5);
  belt.zero(1050, publisher("/joystick"));
  EXPECT_EQ(belt.command(1400, publisher("/joystick")), Permission::Granted);
  EXPECT_FALSE(belt.interlock.watchdogDue(at(1899)));
  EXPECT_TRUE(belt.interlock.watchdogDue(at(1900)));
}

TEST(Interlock, refusedCommandsDoNotFeedTheWatchdog)
{
  Running belt(0.5);
  for (int time = 1100; time < 1500; time += 50)
  {
    belt.interlock.commanded(at(time), publisher(), false, belt.holds);
  }
  EXPECT_TRUE(belt.interlock.watchdogDue(at(1500)));
}

TEST(Interlock, repeatsDoNotFeedTheWatchdog)
{
  Running belt(0.5);
  EXPECT_EQ(belt.command(1400, latched("/planner")), Permission::Repeat);
  EXPECT_TRUE(belt.interlock.watchdogDue(at(1500)));
}

TEST(Interlock, watchdogWatchesNothingBeforeTheFirstCommand)
{
  Guarded belt(0.5);
  belt.interlock.online(at(0));
  belt.zero(100);
  EXPECT_FALSE(belt.interlock.watchdogAt());
  EXPECT_FALSE(belt.interlock.watchdogDue(at(1000000)));
}

TEST(Interlock, watchdogWatchesNothingAtRest)
{
  Running belt(0.5);
  belt.interlock.resting();
  EXPECT_FALSE(belt.interlock.watchdogDue(at(1000000)));
}

TEST(Interlock, watchdogIsFedByTheNextCommandAfterARest)
{
  Running belt(0.5);
  belt.interlock.resting();
  EXPECT_EQ(belt.command(5000), Permission::Granted);
  EXPECT_TRUE(belt.interlock.watchdogDue(at(5500)));
}

TEST(Interlock, commandTimeoutZeroMeansNever)
{
  Running belt(0.0);
  EXPECT_FALSE(belt.interlock.watchdogAt());
  EXPECT_FALSE(belt.interlock.watchdogDue(at(100000000)));
}

TEST(Interlock, commandTimeoutZeroLocksAllTheSame)
{
  Running belt(0.0);
  belt.stopAndConfirm(1200);
  EXPECT_EQ(belt.stream(1250, 10000, 100), 0);
  // Its last message came at 9950 ms.
  EXPECT_EQ(belt.judge(10449), Permission::Locked);
  EXPECT_EQ(belt.judge(10450), Permission::Granted);
}

TEST(Interlock, watchdogLocksLikeAnyStop)
{
  Running belt(0.5);
  ASSERT_TRUE(belt.interlock.watchdogDue(at(1500)));
  belt.stopAndConfirm(1600);
  EXPECT_FALSE(belt.interlock.watchdogDue(at(3000)));
  EXPECT_EQ(belt.command(1700), Permission::Locked);
}

// --- many publishers -------------------------------------------------------------------------------------------------

TEST(Interlock, countsPublishersWithCommandsInTheLastTwoSeconds)
{
  Running belt;
  belt.command(1500, publisher("/joystick"));
  EXPECT_EQ(belt.interlock.activePublishers(at(1600)), 2U);
  EXPECT_EQ(belt.interlock.activePublishers(at(3100)), 1U);
  EXPECT_EQ(belt.interlock.activePublishers(at(3500)), 0U);
}

TEST(Interlock, publisherThatOnlySendsZeroIsNotCountedAsSecond)
{
  Running belt;
  belt.zero(1500, publisher("/estop"));
  EXPECT_EQ(belt.interlock.activePublishers(at(1600)), 1U);
}

TEST(Interlock, numberOfPublishersItRemembersIsBounded)
{
  Running belt;
  for (int count = 0; count < 10000; ++count)
  {
    belt.command(2000 + count, publisher("/anonymous_" + std::to_string(count)));
  }
  EXPECT_LE(belt.interlock.activePublishers(at(12000)), 64U);
}

TEST(Interlock, refusedStreamIsNotForgottenAmongManyPublishers)
{
  Running belt;
  belt.stopAndConfirm(1200);
  for (int time = 1300; time < 20000; time += 100)
  {
    EXPECT_EQ(belt.command(time), Permission::Locked) << time;
    belt.command(time + 50, publisher("/anonymous_" + std::to_string(time)));
  }
}

TEST(Interlock, streamsThatGoOnStayRefusedHoweverManyTheyAre)
{
  Running belt;
  belt.stopAndConfirm(1200);
  for (int time = 1300; time < 5000; ++time)
  {
    EXPECT_EQ(belt.command(time, publisher("/one_of_many_" + std::to_string(time % 100))), Permission::Locked) << time;
  }
  EXPECT_EQ(belt.command(5100, publisher("/new")), Permission::Locked);
  EXPECT_EQ(belt.command(5600, publisher("/newer")), Permission::Granted);
}

// --- near zero (rule 8.5) --------------------------------------------------------------------------------------------

TEST(Interlock, aVelocityNearZeroDoesNotUnlock)
{
  Guarded belt;
  belt.interlock.online(at(0));
  belt.command(10);
  belt.nearZero(20);
  EXPECT_EQ(belt.command(30), Permission::Locked);
}

TEST(Interlock, nearZeroForAsLongAsSilenceUnlocks)
{
  Running belt;
  belt.stream(1100, 2000, 100);
  belt.stopAndConfirm(2000);
  EXPECT_EQ(belt.command(2050), Permission::Locked);
  belt.nearZeros(2100, 2550, 50);
  EXPECT_TRUE(belt.locked(2549));
  EXPECT_EQ(belt.judge(2549), Permission::Locked);
  EXPECT_FALSE(belt.locked(2550));
  EXPECT_EQ(belt.command(2550), Permission::Granted);
}

TEST(Interlock, nearZeroFromTheStartIsSilence)
{
  Guarded belt;
  belt.nearZeros(-1000, 500, 50);
  belt.interlock.online(at(0));
  EXPECT_EQ(belt.judge(499), Permission::Locked);
  EXPECT_EQ(belt.command(500), Permission::Granted);
}

TEST(Interlock, nearZeroBetweenCommandsMakesNoFastPublisherOfASlowOne)
{
  Running belt;
  belt.stream(2000, 5000, 1000);
  belt.stopAndConfirm(4500);
  // A command every second, and twenty a second that are near zero: twice the spacing of the commands is never silent.
  for (int second = 5; second < 60; ++second)
  {
    EXPECT_EQ(belt.command(second * 1000), Permission::Locked) << second;
    belt.nearZeros(second * 1000 + 50, second * 1000 + 1000, 50);
  }
}

TEST(Interlock, aStreamThatGoesThroughZeroStaysLocked)
{
  Running belt;
  belt.stopAndConfirm(1500);
  for (int time = 1600; time < 20000; time += 400)
  {
    EXPECT_EQ(belt.stream(time, time + 100, 50), 0) << time;
    belt.nearZeros(time + 100, time + 400, 50);
  }
}

TEST(Interlock, nearZeroTakesNoNeutralAway)
{
  Running belt;
  belt.stopAndConfirm(1500);
  belt.zero(1600);
  belt.nearZero(1650);
  EXPECT_EQ(belt.command(1700), Permission::Granted);
}

TEST(Interlock, nearZeroLocksNobodyOut)
{
  Running belt;
  belt.nearZeros(1100, 1200, 50);
  EXPECT_FALSE(belt.locked(1200));
  EXPECT_EQ(belt.command(1200), Permission::Granted);
}

TEST(Interlock, nearZeroLeavesNothingToTheWatchdog)
{
  Running belt;
  belt.nearZero(1100);
  EXPECT_FALSE(belt.interlock.watchdogDue(at(60000)));
  EXPECT_EQ(belt.interlock.activePublishers(at(1200)), 0U);
}

TEST(Interlock, aPublisherThatOnlySentNearZeroNeedsNoLongerSilence)
{
  Guarded belt(1.0);
  belt.interlock.online(at(0));
  belt.nearZeros(0, 1000, 100);
  EXPECT_EQ(belt.command(1000), Permission::Granted);
  belt.stopAndConfirm(2000);
  // One command is no spacing: the longest of command_timeout and 0.5 s, not the 5 s of a publisher that is rarely heard.
  EXPECT_EQ(belt.judge(3000), Permission::Granted);
}

TEST(Interlock, aLatchedVelocityOfOneThatWasHeardNearZeroIsARepeat)
{
  Guarded belt;
  belt.interlock.online(at(0));
  belt.nearZero(100, publisher("/latch"));
  EXPECT_EQ(belt.command(5000, latched("/latch")), Permission::Repeat);
}

TEST(Interlock, manyNamesThatAreNearZeroForgetNoStreamThatGoesOn)
{
  Running belt;
  belt.stopAndConfirm(1500);
  EXPECT_EQ(belt.command(1550), Permission::Locked);
  for (int number = 0; number < 100; ++number)
  {
    belt.nearZero(1600 + number, publisher("/n" + std::to_string(number)));
  }
  // It was forgotten among them, so that whoever is new may be this one.
  EXPECT_EQ(belt.command(2040), Permission::Locked);
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What a drive does is compared with what it was told (contract, 4.1, 4.7 and 4.8).

#include "bus/inverter/motion_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

drive::Monitor words(bool run_seen, bool running, double frequency = 0.0)
{
  drive::Monitor words;
  words.run_seen = run_seen;
  words.operation = running;
  words.running = running;
  words.faulted = false;
  words.direction = 1;
  words.output_frequency = frequency;
  return words;
}

const drive::Monitor AT_REST = words(false, false);
const drive::Monitor TURNS = words(true, true, 20.0);
const drive::Monitor TURNS_BY_SOMEBODY_ELSE = words(false, true, 20.0);

drive::Monitor tripped(drive::Monitor words)
{
  words.faulted = true;
  words.fault_code = 12;
  return words;
}

class Mx2Motion : public testing::Test
{
protected:
  explicit Mx2Motion(bool stop_unexpected_motion = false) : config_(inverterConfig())
  {
    config_.stop_unexpected_motion = stop_unexpected_motion;
  }

  void command(double velocity, int time)
  {
    movement_.aim(movement_.judge(velocity).target);
    for (auto write = movement_.next(); write; write = movement_.next())
    {
      movement_.sent(*write);
      movement_.confirmed(*write, at(time));
    }
  }

  Observation seen(const drive::Monitor& words, int time, bool complete = true) const
  {
    return { words, at(time - 10), at(time), complete, movement_, stop_pending_, faulted_ };
  }

  MotionVerdict status(const drive::Monitor& words, int time)
  {
    return watch_.judge(seen(words, time));
  }

  std::string reason(const drive::Monitor& words, int time)
  {
    return status(words, time).judgement.stop_reason;
  }

  std::string reasonOfSomeWords(const drive::Monitor& words, int time)
  {
    return watch_.judge(seen(words, time, false)).judgement.stop_reason;
  }

  InverterConfig config_;
  const drive::Drive mx2_ = shipped("omron_mx2");
  Movement movement_{ mx2_, config_ };
  MotionWatch watch_{ mx2_, config_ };
  bool stop_pending_ = false;
  bool faulted_ = false;
};

class Mx2MotionThatIsStopped : public Mx2Motion
{
protected:
  Mx2MotionThatIsStopped() : Mx2Motion(true)
  {
  }
};

// --- trips -----------------------------------------------------------------------------------------------------------

TEST_F(Mx2Motion, aNewTripIsToldOnceWithItsCode)
{
  status(AT_REST, 0);
  const MotionVerdict verdict = status(tripped(AT_REST), 100);
  EXPECT_TRUE(verdict.judgement.tripped);
  EXPECT_EQ(true, verdict.faulted);
  EXPECT_THAT(verdict.judgement.stop_reason, HasSubstr("E12"));
  faulted_ = true;
  EXPECT_FALSE(status(tripped(AT_REST), 200).judgement.tripped);
}

TEST_F(Mx2Motion, aTripIsActedOnBeforeItsCodeIsKnownAndToldWithIt)
{
  status(AT_REST, 0);
  const MotionVerdict early = watch_.judge(seen(tripped(AT_REST), 100, false));
  EXPECT_EQ("the drive has tripped", early.judgement.stop_reason);
  EXPECT_FALSE(early.judgement.tripped);
  EXPECT_EQ(true, early.faulted);
  faulted_ = true;
  EXPECT_FALSE(watch_.judge(seen(tripped(AT_REST), 110, false)).faulted);
  const MotionVerdict complete = status(tripped(AT_REST), 120);
  EXPECT_TRUE(complete.judgement.tripped);
  EXPECT_THAT(complete.judgement.trip_text, HasSubstr("E12"));
  EXPECT_EQ("", complete.judgement.stop_reason) << "it was stopped already";
}

TEST_F(Mx2Motion, aStatusThatCannotTellOfATripEndsNone)
{
  drive::Monitor busy;
  faulted_ = true;
  EXPECT_EQ(true, status(busy, 0).faulted);
  faulted_ = false;
  EXPECT_EQ(false, status(busy, 100).faulted);
  faulted_ = true;
  EXPECT_EQ(false, status(AT_REST, 200).faulted) << "it was reset";
}

// --- RUN -------------------------------------------------------------------------------------------------------------

TEST_F(Mx2Motion, aLeftoverRunOnTheBusIsClearedAtTheFirstStatusOnly)
{
  EXPECT_THAT(reason(TURNS, 0), HasSubstr("leftover"));
  EXPECT_EQ("", reason(TURNS, 100)) << "what comes later is no leftover";
  watch_.forget();
  EXPECT_THAT(reason(TURNS, 200), HasSubstr("leftover")) << "the drive has come back";
}

TEST_F(Mx2Motion, aDriveAtRestGivesNoReason)
{
  EXPECT_EQ("", reason(AT_REST, 0));
  EXPECT_EQ("", reason(AT_REST, 100));
  EXPECT_THAT(watch_.warnings(at(100)), IsEmpty());
}

TEST_F(Mx2Motion, aRunThatTheDriveHasLostIsAReasonUnlessItWasAskedForBefore)
{
  status(AT_REST, 0);
  command(20.0, 100);
  EXPECT_EQ("", reasonOfSomeWords(AT_REST, 105)) << "the request left before RUN was confirmed";
  EXPECT_THAT(reasonOfSomeWords(AT_REST, 120), HasSubstr("lost its RUN"));
  stop_pending_ = true;
  EXPECT_EQ("", reasonOfSomeWords(AT_REST, 130)) << "a stop goes already";
}

TEST_F(Mx2Motion, aCommandOfZeroIsOverWhenRunIsSeenOffAndFailsWhenItIsNot)
{
  status(AT_REST, 0);
  command(20.0, 100);
  status(TURNS, 200);
  command(0.0, 300);
  const MotionVerdict insists = status(TURNS, 400);
  EXPECT_TRUE(insists.judgement.zero_failed);
  EXPECT_FALSE(insists.came_to_rest);
  const MotionVerdict over = status(words(false, true, 15.0), 500);
  EXPECT_TRUE(over.came_to_rest) << "RUN is off; the motor ramps down";
  EXPECT_FALSE(over.judgement.zero_failed);
  EXPECT_EQ("", over.judgement.stop_reason);
}

TEST_F(Mx2Motion, itChangesNothingButItsOwnMemory)
{
  status(AT_REST, 0);
  command(20.0, 100);
  status(TURNS, 200);
  command(0.0, 300);
  ASSERT_TRUE(status(AT_REST, 400).came_to_rest);
  EXPECT_TRUE(movement_.runPossible());
  EXPECT_TRUE(status(AT_REST, 500).came_to_rest) << "who asks has not acted on it";
}

TEST(JeMotion, aDriveThatCannotTellOfALeftoverRunIsStoppedFirst)
{
  const InverterConfig config = inverterConfig();
  const drive::Drive drive = shipped("omron_3g3je");
  ASSERT_FALSE(drive.reports("run_seen"));
  Movement movement(drive, config);
  MotionWatch watch(drive, config);
  const drive::Monitor words;
  const auto reason = [&](bool complete) {
    return watch.judge({ words, at(0), at(10), complete, movement, false, false }).judgement.stop_reason;
  };
  EXPECT_THAT(reason(false), HasSubstr("can't tell"));
  EXPECT_THAT(reason(true), HasSubstr("can't tell"));
  EXPECT_EQ("", reason(true)) << "once";
}

// --- a motor that runs or stops by itself ----------------------------------------------------------------------------

TEST_F(Mx2Motion, aMotorThatStartsFromRestWithoutUsIsAWarningUntilItRests)
{
  status(AT_REST, 0);
  EXPECT_EQ("", reason(TURNS_BY_SOMEBODY_ELSE, 100));
  EXPECT_THAT(watch_.warnings(at(100)), ElementsAre(HasSubstr("runs without a command of this node")));
  status(AT_REST, 200);
  EXPECT_THAT(watch_.warnings(at(200)), IsEmpty());
}

TEST_F(Mx2MotionThatIsStopped, onceWhereTheUserWantsThat)
{
  status(AT_REST, 0);
  EXPECT_EQ("the motor runs without a command of this node", reason(TURNS_BY_SOMEBODY_ELSE, 100));
  EXPECT_EQ("", reason(TURNS_BY_SOMEBODY_ELSE, 200));
  status(AT_REST, 300);
  EXPECT_EQ("RUN is on without a command of this node", reason(TURNS, 400));
}

TEST_F(Mx2MotionThatIsStopped, aMotorThatRunsOutAfterOurStopIsNoSurprise)
{
  status(AT_REST, 0);
  command(20.0, 100);
  status(TURNS, 200);
  movement_.drop();
  movement_.stopped(at(300));
  EXPECT_EQ("", reason(words(false, true, 10.0), 400));
  EXPECT_THAT(watch_.warnings(at(400)), IsEmpty());
  status(AT_REST, 500);
  EXPECT_NE("", reason(TURNS_BY_SOMEBODY_ELSE, 600)) << "it had come to rest";
}

TEST_F(Mx2Motion, unexpectedMotionIsForgottenWithTheInverterOffline)
{
  status(AT_REST, 0);
  status(TURNS_BY_SOMEBODY_ELSE, 100);
  watch_.wentOffline();
  EXPECT_THAT(watch_.warnings(at(100)), IsEmpty());
}

TEST_F(Mx2Motion, aMotorThatStopsByItselfForHalfASecondHasLostItsRun)
{
  const drive::Monitor stands = words(true, false);
  status(AT_REST, 0);
  command(20.0, 100);
  EXPECT_EQ("", reason(stands, 200)) << "it has not begun yet";
  status(TURNS, 300);
  EXPECT_EQ("", reason(stands, 400)) << "a reversal shows that for a moment";
  EXPECT_EQ("", reason(stands, 899));
  EXPECT_THAT(reason(stands, 900), HasSubstr("STOP key"));
}

TEST_F(Mx2Motion, aReversalThatShowsRestForAMomentIsNone)
{
  const drive::Monitor stands = words(true, false);
  status(AT_REST, 0);
  command(20.0, 100);
  status(TURNS, 300);
  status(stands, 400);
  status(TURNS, 600);
  EXPECT_EQ("", reason(stands, 1000));
}

TEST(Vfs15Motion, afterALostFrameOfAReversalTheMotorMustBeSeenRunning)
{
  const InverterConfig config = inverterConfig();
  const drive::Drive vfs15 = shipped("toshiba_vfs15");
  Movement movement(vfs15, config);
  MotionWatch watch(vfs15, config);
  const auto status = [&](const drive::Monitor& words, int time) {
    return watch.judge({ words, at(time - 10), at(time), true, movement, false, false });
  };
  status(AT_REST, 0);
  movement.aim(movement.judge(20.0).target);
  for (auto write = movement.next(); write; write = movement.next())
  {
    movement.sent(*write);
    movement.confirmed(*write, at(100));
  }
  status(TURNS, 200);
  movement.aim(movement.judge(-20.0).target);
  const auto turn = movement.next();
  ASSERT_TRUE(turn && turn->starts);
  movement.sent(*turn);
  movement.doubtful(*turn, at(310));
  EXPECT_FALSE(status(TURNS, 315).told_after_turn) << "asked for before it got lost";
  EXPECT_TRUE(status(TURNS, 330).told_after_turn);
  EXPECT_THAT(status(words(true, false), 340).judgement.stop_reason, HasSubstr("to reverse"));
}

// --- commanded against actual ----------------------------------------------------------------------------------------

TEST_F(Mx2Motion, aMotorThatDoesNotMoveForThreeSecondsIsAWarning)
{
  const drive::Monitor stands = words(true, true, 0.0);
  status(AT_REST, 0);
  command(20.0, 100);
  status(stands, 200);
  EXPECT_THAT(watch_.warnings(at(3199)), IsEmpty());
  EXPECT_THAT(watch_.warnings(at(3200)), ElementsAre(HasSubstr("does not move")));
  status(TURNS, 3300);
  EXPECT_THAT(watch_.warnings(at(3300)), IsEmpty());
}

TEST_F(Mx2Motion, theWrongDirectionIsAWarningUnlessItSlowsDown)
{
  drive::Monitor backwards = TURNS;
  backwards.direction = -1;
  status(AT_REST, 0);
  command(20.0, 100);
  status(backwards, 200);
  status(backwards, 3300);
  EXPECT_THAT(watch_.warnings(at(3300)), ElementsAre(HasSubstr("wrong direction")));
  backwards.output_frequency = 10.0;
  status(backwards, 3400);
  EXPECT_THAT(watch_.warnings(at(3400)), IsEmpty()) << "it is on its way to turn round";
}

TEST_F(Mx2Motion, anotherSpeedThanCommandedIsAWarningOnceTheDriveSaysThatItIsThere)
{
  drive::Monitor slow = words(true, true, 15.0);
  status(AT_REST, 0);
  command(20.0, 100);
  status(slow, 200);
  status(slow, 5000);
  EXPECT_THAT(watch_.warnings(at(5000)), IsEmpty()) << "it accelerates";
  slow.at_speed = true;
  status(slow, 5100);
  EXPECT_THAT(watch_.warnings(at(7100)), ElementsAre(HasSubstr("a speed other than commanded")));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Confirmed words are repeated only while the last exchange has shown our RUN in force (contract, 4.1).

#include "bus/inverter/run_evidence.h"

#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
/// A VF-S15 that was told to run with 20 Hz, the last word confirmed at 100 ms.
class Vfs15Evidence : public testing::Test
{
protected:
  Vfs15Evidence()
  {
    run(20.0, 100);
  }

  void run(double velocity, int time)
  {
    movement_.aim(movement_.judge(velocity).target);
    for (auto write = movement_.next(); write; write = movement_.next())
    {
      movement_.sent(*write);
      movement_.confirmed(*write, at(time));
    }
  }

  static drive::Monitor words(double frequency, bool run_seen = true, bool running = true)
  {
    drive::Monitor words;
    words.run_seen = run_seen;
    words.running = running;
    words.output_frequency = frequency;
    return words;
  }

  /// A read of the status that left 10 ms before its end.
  void read(const drive::Monitor& words, int time)
  {
    evidence_.exchangeEnded(wire::Outcome::Ok);
    evidence_.statusRead(words, reply("", at(time), at(time - 10)), movement_);
  }

  bool shows(int time) const
  {
    return evidence_.shows(at(time), movement_);
  }

  const drive::Drive vfs15_ = shipped("toshiba_vfs15");
  const InverterConfig config_ = inverterConfig();
  Movement movement_{ vfs15_, config_ };
  RunEvidence evidence_{ vfs15_ };
};

TEST_F(Vfs15Evidence, isThereForHalfASecondAfterAReadThatShowsTheMotorOnItsWay)
{
  EXPECT_FALSE(shows(150));
  read(words(5.0), 200);
  EXPECT_TRUE(shows(200));
  EXPECT_TRUE(shows(699));
  EXPECT_FALSE(shows(700)) << "a drive that was switched off and on may be back by then";
}

TEST_F(Vfs15Evidence, endsWithTheNextExchangeWhateverItBrings)
{
  for (const wire::Outcome outcome :
       { wire::Outcome::Ok, wire::Outcome::Exception, wire::Outcome::Damaged, wire::Outcome::Timeout })
  {
    read(words(20.0), 200);
    ASSERT_TRUE(shows(210));
    evidence_.exchangeEnded(outcome);
    EXPECT_FALSE(shows(210));
  }
}

TEST_F(Vfs15Evidence, readsThatDoNotTellOfOurRunGoOnWithWhatWasProvenBefore)
{
  drive::Monitor silent_on_run = words(20.0);
  silent_on_run.run_seen.reset();
  read(silent_on_run, 200);
  EXPECT_FALSE(shows(200)) << "it may turn by somebody else's command";
  read(words(20.0), 300);
  read(silent_on_run, 400);
  EXPECT_TRUE(shows(400));
  evidence_.exchangeEnded(wire::Outcome::Timeout);
  read(silent_on_run, 500);
  EXPECT_FALSE(shows(500)) << "a short power cut may be behind the lost exchange";
}

TEST_F(Vfs15Evidence, needsAMotorThatTurnsAsItShould)
{
  read(words(20.0, true, false), 200);
  EXPECT_FALSE(shows(200)) << "at rest";
  read(words(20.0, false), 300);
  EXPECT_FALSE(shows(300)) << "not by our RUN";
  drive::Monitor backwards = words(20.0);
  backwards.direction = -1;
  read(backwards, 400);
  EXPECT_FALSE(shows(400));
}

TEST_F(Vfs15Evidence, aMotorThatSlowsDownMayHaveLostItsRun)
{
  read(words(15.0), 200);
  ASSERT_TRUE(shows(200));
  read(words(12.0), 300);
  EXPECT_FALSE(shows(300));
  read(words(14.0), 400);
  EXPECT_TRUE(shows(400)) << "it comes nearer again";
}

TEST_F(Vfs15Evidence, aReadThatWasAskedForBeforeTheLastChangeOfRunShowsNothing)
{
  evidence_.exchangeEnded(wire::Outcome::Ok);
  evidence_.statusRead(words(20.0), reply("", at(110), at(90)), movement_);
  EXPECT_FALSE(shows(110));
}

TEST_F(Vfs15Evidence, isOverWithTheRunItself)
{
  read(words(20.0), 200);
  ASSERT_TRUE(shows(200));
  movement_.forgetWords();
  EXPECT_FALSE(shows(200));
}

TEST_F(Vfs15Evidence, isForgottenWithTheDrive)
{
  read(words(20.0), 200);
  evidence_.forget();
  EXPECT_FALSE(shows(200));
}

TEST_F(Vfs15Evidence, aRestartBeforeOurRunLeavesItInDoubtAndOneBehindItEndsIt)
{
  EXPECT_EQ(Restart::PerhapsBeforeRun, evidence_.restartRead(true, at(200), movement_, false));
  EXPECT_EQ(Restart::Restarted, evidence_.restartRead(true, at(200), movement_, true)) << "a stop goes anyway";
  EXPECT_EQ(Restart::None, evidence_.restartRead(false, at(300), movement_, false));
  EXPECT_EQ(Restart::Restarted, evidence_.restartRead(true, at(400), movement_, false))
      << "it had not restarted when RUN was in force already";
}

TEST_F(Vfs15Evidence, aRestartEndsWhatWasProven)
{
  read(words(20.0), 200);
  evidence_.restartRead(true, at(210), movement_, false);
  drive::Monitor silent_on_run = words(20.0);
  silent_on_run.run_seen.reset();
  read(silent_on_run, 300);
  EXPECT_FALSE(shows(300));
}

TEST_F(Vfs15Evidence, whoCommandsIsAskedEveryFiveSecondsWhileOurRunIsInForce)
{
  EXPECT_TRUE(evidence_.takeSourceDue(at(200), movement_, Ms(1000)));
  EXPECT_FALSE(evidence_.takeSourceDue(at(5199), movement_, Ms(1000)));
  EXPECT_TRUE(evidence_.takeSourceDue(at(5200), movement_, Ms(1000)));
  EXPECT_FALSE(evidence_.takeSourceDue(at(12199), movement_, Ms(7000))) << "within the share of the slow values";
  EXPECT_TRUE(evidence_.takeSourceDue(at(12200), movement_, Ms(7000)));
  movement_.stopped(at(6000));
  EXPECT_FALSE(evidence_.takeSourceDue(at(60000), movement_, Ms(1000)));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

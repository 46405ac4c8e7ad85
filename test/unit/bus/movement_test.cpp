// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The frames of velocity commands on an MX2, compared with the bytes that manuals print and traces of real drives show
// (without CRC).

#include "bus/inverter/movement.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Frames = std::vector<std::string>;

const std::string FREQUENCY_50_HZ = "01 10 00 00 00 02 04 00 00 13 88";
const std::string FREQUENCY_10_HZ = "01 10 00 00 00 02 04 00 00 03 E8";
const std::string FORWARD = "01 05 00 01 00 00";
const std::string REVERSE = "01 05 00 01 FF 00";
const std::string RUN_ON = "01 05 00 00 FF 00";
const std::string RUN_OFF = "01 05 00 00 00 00";

class Mx2Movement : public testing::Test
{
protected:
  /// Accepts a velocity.
  void aim(double velocity)
  {
    const JudgedVelocity judged = movement_.judge(velocity);
    ASSERT_EQ(judged.error_id, 0) << judged.text;
    movement_.aim(judged.target);
  }

  /// One frame, sent and confirmed by the drive; empty: there is none.
  std::string confirmOne(int time = 0)
  {
    const auto write = movement_.next();
    if (!write)
    {
      return "";
    }
    movement_.sent(*write);
    movement_.confirmed(*write, at(time));
    return printed(write->request);
  }

  /// All frames, each confirmed by the drive.
  Frames confirmAll(int time = 0)
  {
    Frames frames;
    for (std::string frame = confirmOne(time); !frame.empty() && frames.size() < 10; frame = confirmOne(time))
    {
      frames.push_back(frame);
    }
    return frames;
  }

  Frames command(double velocity, int time = 0)
  {
    aim(velocity);
    return confirmAll(time);
  }

  std::string nextFrame() const
  {
    const auto write = movement_.next();
    return write ? printed(write->request) : "";
  }

  InverterConfig config_ = inverterConfig();
  const drive::Drive mx2_ = shipped("omron_mx2");
  Movement movement_{ mx2_, config_ };
};

// --- frames ----------------------------------------------------------------------------------------------------------

TEST_F(Mx2Movement, startWritesFrequencyThenDirectionThenRun)
{
  EXPECT_THAT(command(50.0), ElementsAre(FREQUENCY_50_HZ, FORWARD, RUN_ON));
}

TEST_F(Mx2Movement, startInReverseWritesTheReverseCoil)
{
  EXPECT_THAT(command(-50.0), ElementsAre(FREQUENCY_50_HZ, REVERSE, RUN_ON));
}

TEST_F(Mx2Movement, negativeScaleTurnsTheSenseOfTheCommand)
{
  config_.hz_per_unit = -5.0;
  EXPECT_THAT(command(10.0), ElementsAre(FREQUENCY_50_HZ, REVERSE, RUN_ON));
  EXPECT_THAT(command(-10.0), ElementsAre(FORWARD));
}

TEST_F(Mx2Movement, framesGoToTheStationOfTheInverter)
{
  config_.node = 8;
  EXPECT_THAT(command(50.0), ElementsAre("08 10 00 00 00 02 04 00 00 13 88", "08 05 00 01 00 00", "08 05 00 00 FF 00"));
}

TEST_F(Mx2Movement, changeOfSpeedWritesTheFrequencyOnly)
{
  command(50.0);
  EXPECT_THAT(command(10.0), ElementsAre(FREQUENCY_10_HZ));
}

TEST_F(Mx2Movement, changeOfDirectionIsLeftToTheDrivesRamps)
{
  command(50.0);
  EXPECT_THAT(command(-50.0), ElementsAre(REVERSE));
  EXPECT_THAT(command(10.0), ElementsAre(FREQUENCY_10_HZ, FORWARD));
}

TEST_F(Mx2Movement, zeroTakesRunOffAndNothingElse)
{
  command(50.0);
  EXPECT_THAT(command(0.0), ElementsAre(RUN_OFF));
  EXPECT_FALSE(movement_.active());
}

TEST_F(Mx2Movement, equalCommandSendsNothing)
{
  command(50.0);
  EXPECT_THAT(command(50.0), IsEmpty());
  EXPECT_FALSE(movement_.active());
}

TEST_F(Mx2Movement, commandThatIsEqualAfterRoundingSendsNothing)
{
  command(50.0);
  EXPECT_THAT(command(49.998), IsEmpty());
}

TEST_F(Mx2Movement, newerTargetReplacesTheOlderBetweenTwoFrames)
{
  aim(50.0);
  ASSERT_EQ(confirmOne(), FREQUENCY_50_HZ);
  aim(-10.0);
  EXPECT_THAT(confirmAll(), ElementsAre(FREQUENCY_10_HZ, REVERSE, RUN_ON));
}

TEST_F(Mx2Movement, zeroBetweenTheFramesOfAStartSendsNoRun)
{
  aim(50.0);
  ASSERT_EQ(confirmOne(), FREQUENCY_50_HZ);
  EXPECT_THAT(command(0.0), ElementsAre(RUN_OFF));
}

TEST_F(Mx2Movement, runIsTheOnlyFrameThatStarts)
{
  aim(50.0);
  std::vector<bool> starts;
  while (const auto write = movement_.next())
  {
    starts.push_back(write->starts);
    movement_.sent(*write);
    movement_.confirmed(*write, at(0));
  }
  EXPECT_THAT(starts, ElementsAre(false, false, true));
}

TEST_F(Mx2Movement, restartAfterAConfirmedStopWritesEverythingAnew)
{
  command(50.0);
  command(0.0);
  movement_.stopped(at(100));
  EXPECT_THAT(command(50.0), ElementsAre(FREQUENCY_50_HZ, FORWARD, RUN_ON));
}

TEST_F(Mx2Movement, wordsOfAnInverterThatWasOfflineAreWrittenAnew)
{
  command(50.0);
  movement_.drop();
  movement_.forgetWords();
  EXPECT_THAT(command(50.0), ElementsAre(FREQUENCY_50_HZ, FORWARD, RUN_ON));
}

// --- lost frames -----------------------------------------------------------------------------------------------------

TEST_F(Mx2Movement, doubtfulWordIsWrittenAgain)
{
  aim(50.0);
  const auto write = movement_.next();
  movement_.sent(*write);
  movement_.doubtful(*write);
  EXPECT_THAT(confirmAll(), ElementsAre(FREQUENCY_50_HZ, FORWARD, RUN_ON));
}

TEST_F(Mx2Movement, onlyTheDoubtfulWordIsWrittenAgain)
{
  command(50.0);
  aim(-10.0);
  ASSERT_EQ(confirmOne(), FREQUENCY_10_HZ);
  const auto write = movement_.next();
  movement_.sent(*write);
  movement_.doubtful(*write);
  EXPECT_THAT(confirmAll(), ElementsAre(REVERSE));
}

TEST_F(Mx2Movement, doubtfulWordIsWrittenEvenIfTheTargetGoesBackToTheOldValue)
{
  command(50.0);
  aim(10.0);
  const auto write = movement_.next();
  movement_.sent(*write);
  movement_.doubtful(*write);
  EXPECT_THAT(command(50.0), ElementsAre(FREQUENCY_50_HZ));
}

TEST_F(Mx2Movement, commandThatFailedSendsNothingMoreByItself)
{
  aim(50.0);
  const auto write = movement_.next();
  movement_.sent(*write);
  movement_.doubtful(*write);
  movement_.giveUp();
  EXPECT_EQ(nextFrame(), "");
  EXPECT_FALSE(movement_.active());
}

TEST_F(Mx2Movement, sameCommandAfterAFailedOneIsSentAgain)
{
  command(50.0);
  aim(10.0);
  const auto write = movement_.next();
  movement_.sent(*write);
  movement_.doubtful(*write);
  movement_.giveUp();
  EXPECT_THAT(command(10.0), ElementsAre(FREQUENCY_10_HZ));
}

// --- what is known of RUN --------------------------------------------------------------------------------------------

TEST_F(Mx2Movement, runCountsAsOnFromTheFirstByteOfItsFrame)
{
  aim(50.0);
  confirmOne();
  confirmOne();
  ASSERT_FALSE(movement_.runPossible());
  const auto run = movement_.next();
  ASSERT_EQ(printed(run->request), RUN_ON);
  movement_.sent(*run);
  EXPECT_TRUE(movement_.runPossible());
  EXPECT_TRUE(movement_.runCommand());
  EXPECT_FALSE(movement_.runConfirmed());
  movement_.confirmed(*run, at(70));
  EXPECT_TRUE(movement_.runConfirmed());
  EXPECT_EQ(movement_.runChangedAt(), at(70));
}

TEST_F(Mx2Movement, lostRunFrameCountsAsOnUntilAStopIsConfirmed)
{
  aim(50.0);
  confirmOne();
  confirmOne();
  const auto run = movement_.next();
  movement_.sent(*run);
  movement_.doubtful(*run);
  movement_.giveUp();
  movement_.drop();
  movement_.forgetWords();
  EXPECT_TRUE(movement_.runPossible());
  movement_.stopped(at(200));
  EXPECT_FALSE(movement_.runPossible());
  EXPECT_FALSE(movement_.runCommand());
}

TEST_F(Mx2Movement, acknowledgedZeroCountsAsOnUntilItIsSeenOff)
{
  command(50.0);
  command(0.0, 300);
  EXPECT_TRUE(movement_.runPossible());
  EXPECT_FALSE(movement_.runCommand());
  EXPECT_FALSE(movement_.runConfirmed());
  EXPECT_TRUE(movement_.zeroUnverified());
  EXPECT_EQ(movement_.runChangedAt(), at(300));
}

TEST_F(Mx2Movement, secondZeroBeforeTheNextStatusKeepsTheFirstUnverified)
{
  command(50.0);
  command(0.0, 300);
  const Frames second = command(0.0, 320);
  // Either it is written again, or the first one still waits to be seen: else nobody insists on a RUN that stays on.
  EXPECT_TRUE(!second.empty() || movement_.zeroUnverified());
}

TEST_F(Mx2Movement, newCommandAfterAnUnverifiedZeroPutsRunOnAgain)
{
  command(50.0);
  command(0.0);
  EXPECT_THAT(command(50.0), testing::Contains(RUN_ON));
  EXPECT_FALSE(movement_.zeroUnverified());
  EXPECT_TRUE(movement_.runConfirmed());
}

TEST_F(Mx2Movement, isActiveFromTheAcceptanceUntilTheLastFrameIsConfirmed)
{
  EXPECT_FALSE(movement_.active());
  aim(50.0);
  EXPECT_TRUE(movement_.active());
  confirmOne();
  confirmOne();
  EXPECT_TRUE(movement_.active());
  confirmOne();
  EXPECT_FALSE(movement_.active());
}

TEST_F(Mx2Movement, changeOfSpeedLeavesRunConfirmed)
{
  command(50.0, 10);
  command(10.0, 500);
  EXPECT_TRUE(movement_.runConfirmed());
  EXPECT_EQ(movement_.runChangedAt(), at(10));
}

TEST_F(Mx2Movement, droppedTargetSendsNothing)
{
  aim(50.0);
  movement_.drop();
  EXPECT_EQ(nextFrame(), "");
  EXPECT_FALSE(movement_.target());
  EXPECT_FALSE(movement_.active());
}

// --- refusals --------------------------------------------------------------------------------------------------------

TEST_F(Mx2Movement, refusesWhatIsNoFiniteNumber)
{
  for (const double velocity : { std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity() })
  {
    EXPECT_EQ(movement_.judge(velocity).error_id, 0xA000) << velocity;
  }
}

TEST_F(Mx2Movement, refusesVelocitiesBeyondTheMaximumInBothDirections)
{
  EXPECT_EQ(movement_.judge(50.0).error_id, 0);
  EXPECT_EQ(movement_.judge(-50.0).error_id, 0);
  EXPECT_EQ(movement_.judge(50.001).error_id, 0xA000);
  EXPECT_EQ(movement_.judge(-50.001).error_id, 0xA000);
  EXPECT_EQ(movement_.judge(1e300).error_id, 0xA000);
}

TEST_F(Mx2Movement, zeroOfEitherSignTakesRunOff)
{
  EXPECT_TRUE(movement_.judge(0.0).target.zero);
  EXPECT_TRUE(movement_.judge(-0.0).target.zero);
  EXPECT_FALSE(movement_.judge(1.0).target.zero);
}

TEST_F(Mx2Movement, whatRoundsToZeroHertzTakesRunOff)
{
  command(50.0);
  EXPECT_THAT(command(5.185908126537075e-14), ElementsAre(RUN_OFF));
  EXPECT_TRUE(movement_.judge(0.004).target.near_zero);
  EXPECT_FALSE(movement_.judge(0.0).target.near_zero);
}

TEST_F(Mx2Movement, takesTheClampedVelocityForItsTarget)
{
  config_.limit = Limit::Saturate;
  EXPECT_THAT(command(80.0), ElementsAre(FREQUENCY_50_HZ, FORWARD, RUN_ON));
  EXPECT_EQ(movement_.target()->velocity, 50.0);
  // Another value beyond the maximum is the same command.
  EXPECT_THAT(command(1e300), IsEmpty());
  EXPECT_FALSE(movement_.active());
}

TEST_F(Mx2Movement, roundsTheSetPointToTheNearestCount)
{
  EXPECT_EQ(movement_.judge(9.996).target.counts, 1000U);
  EXPECT_EQ(movement_.judge(9.994).target.counts, 999U);
  EXPECT_EQ(movement_.judge(0.29).target.counts, 29U);
}

TEST_F(Mx2Movement, scalesTheUsersUnitToHertz)
{
  config_.hz_per_unit = 2.5;
  EXPECT_EQ(movement_.judge(4.0).target.counts, 1000U);
  EXPECT_FALSE(movement_.judge(4.0).target.reverse);
  EXPECT_TRUE(movement_.judge(-4.0).target.reverse);
  EXPECT_EQ(movement_.judge(-4.0).target.velocity, -4.0);
}

TEST_F(Mx2Movement, refusalNamesTheRange)
{
  config_.min_velocity = 2.0;
  EXPECT_THAT(movement_.judge(70.0).text, AllOf(HasSubstr("70"), HasSubstr("2 to 50")));
}

TEST_F(Mx2Movement, judgingChangesNothing)
{
  command(50.0);
  movement_.judge(10.0);
  movement_.judge(70.0);
  movement_.judge(0.0);
  EXPECT_EQ(nextFrame(), "");
  EXPECT_EQ(movement_.target()->velocity, 50.0);
}

drive::Profile mx2Profile()
{
  return drive::loadProfile("omron_mx2", drive::profileDirectory());
}

TEST(Movement, isNotArmedWithoutAConfirmedStop)
{
  drive::Profile profile = mx2Profile();
  profile.sequences.at("stop").unconfirmed = "stop_command";
  const drive::Drive drive(profile);
  const InverterConfig config = inverterConfig();
  const Movement movement(drive, config);
  EXPECT_EQ(movement.judge(10.0).error_id, 0xB006);
  EXPECT_THAT(movement.judge(10.0).text, HasSubstr("stop_command"));
}

TEST(Movement, isNotArmedWithAnUnconfirmedDirectionPoint)
{
  drive::Profile profile = mx2Profile();
  profile.points.at("direction").item.unconfirmed = "reverse_word";
  const drive::Drive drive(profile);
  const InverterConfig config = inverterConfig();
  const Movement movement(drive, config);
  EXPECT_EQ(movement.judge(-10.0).error_id, 0xB006);
  EXPECT_THAT(movement.judge(-10.0).text, HasSubstr("reverse_word"));
}

TEST(Movement, directionThatTheDriveLacksIsNotOffered)
{
  drive::Profile profile = mx2Profile();
  profile.sequences.erase("reverse");
  const drive::Drive drive(profile);
  const InverterConfig config = inverterConfig();
  const Movement movement(drive, config);
  EXPECT_EQ(movement.judge(-10.0).error_id, 0xB004);
  EXPECT_EQ(movement.judge(10.0).error_id, 0);
}

TEST(Movement, rangeCountsBeforeArming)
{
  drive::Profile profile = mx2Profile();
  profile.sequences.at("stop").unconfirmed = "stop_command";
  const drive::Drive drive(profile);
  const InverterConfig config = inverterConfig();
  EXPECT_EQ(Movement(drive, config).judge(70.0).error_id, 0xA000);
}

TEST(Movement, zeroIsAcceptedByADriveThatIsNotArmed)
{
  drive::Profile profile = mx2Profile();
  profile.sequences.at("stop").unconfirmed = "stop_command";
  const drive::Drive drive(profile);
  const InverterConfig config = inverterConfig();
  EXPECT_EQ(Movement(drive, config).judge(0.0).error_id, 0);
}

TEST(Movement, rxStartsWithTheSameFrames)
{
  const drive::Drive rx = shipped("omron_rx");
  const InverterConfig config = inverterConfig();
  Movement movement(rx, config);
  movement.aim(movement.judge(-50.0).target);
  Frames frames;
  while (const auto write = movement.next())
  {
    frames.push_back(printed(write->request));
    movement.sent(*write);
    movement.confirmed(*write, at(0));
  }
  EXPECT_THAT(frames, ElementsAre(FREQUENCY_50_HZ, REVERSE, RUN_ON));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

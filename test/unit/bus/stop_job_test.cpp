// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Frames of a stop and what confirms it (contract, rules 3.1 to 3.3).

#include "bus/inverter/stop_job.h"

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
using Progress = StopJob::Progress;

const std::string RUN_OFF = "01 05 00 00 00 00";
const std::string READ_RUN = "01 01 00 00 00 01";
const std::string FREE_RUN = "01 05 00 08 FF 00";

const wire::Reply ACKNOWLEDGED = reply("05 00 00 00 00");
const wire::Reply RUN_IS_OFF = reply("01 01 00");
const wire::Reply RUN_IS_ON = reply("01 01 01");

/// The stop's next frame leaves and ends with \p end.
Progress exchange(StopJob& stop, const wire::Reply& end)
{
  stop.sent(at(1));
  return stop.done(end);
}

class Mx2Stop : public testing::Test
{
protected:
  void SetUp() override
  {
    stop_.request(at(0), StopMode::Decelerate);
  }

  std::string nextFrame() const
  {
    return printed(stop_.next());
  }

  const drive::Drive mx2_ = shipped("omron_mx2");
  StopJob stop_{ mx2_, 1 };
};

/// The MX2 with the coast that its profile describes in a comment: free run by input S3.
drive::Drive mx2WithCoast()
{
  drive::ProfileChanges changes;
  changes.overrides =
      drive::overridesOf("{points: {free_run: {coil: 0x0009}}, sequences: {coast: [{free_run: 1}, {run: 0}]}}");
  return shipped("omron_mx2", changes);
}

/// The same drive without a read that tells RUN.
drive::Drive thatCannotTellRun(const drive::Drive& drive)
{
  drive::Profile profile = drive.profile();
  profile.status.erase("run_seen");
  profile.status.erase("running");
  return drive::Drive(profile);
}

TEST(StopModeOf, knowsTheModesOfTheServiceAndNoOtherNumber)
{
  EXPECT_EQ(stopModeOf(0), StopMode::Decelerate);
  EXPECT_EQ(stopModeOf(1), StopMode::Coast);
  EXPECT_EQ(stopModeOf(2), StopMode::Quick);
  for (int number = 3; number <= 255; ++number)
  {
    EXPECT_EQ(stopModeOf(static_cast<std::uint8_t>(number)), std::nullopt) << number;
  }
}

TEST_F(Mx2Stop, writesRunOffAndThenReadsItBack)
{
  EXPECT_TRUE(stop_.pending());
  EXPECT_EQ(nextFrame(), RUN_OFF);
  EXPECT_EQ(exchange(stop_, ACKNOWLEDGED), Progress::GoesOn);
  EXPECT_TRUE(stop_.written());
  EXPECT_EQ(nextFrame(), READ_RUN);
  EXPECT_EQ(exchange(stop_, RUN_IS_OFF), Progress::Confirmed);
  EXPECT_FALSE(stop_.pending());
}

TEST_F(Mx2Stop, isNotConfirmedByTheAcknowledgementAlone)
{
  exchange(stop_, ACKNOWLEDGED);
  EXPECT_TRUE(stop_.pending());
}

TEST_F(Mx2Stop, beginsAgainWhenRunIsStillOn)
{
  exchange(stop_, ACKNOWLEDGED);
  EXPECT_EQ(exchange(stop_, RUN_IS_ON), Progress::Failed);
  EXPECT_TRUE(stop_.pending());
  EXPECT_EQ(stop_.attempts(), 1U);
  EXPECT_EQ(nextFrame(), RUN_OFF);
}

TEST_F(Mx2Stop, beginsAgainWhenTheReadBackIsLost)
{
  exchange(stop_, ACKNOWLEDGED);
  EXPECT_EQ(exchange(stop_, lost()), Progress::Failed);
  EXPECT_FALSE(stop_.written());
  EXPECT_EQ(nextFrame(), RUN_OFF);
}

TEST_F(Mx2Stop, goesOnForEver)
{
  for (unsigned attempt = 0; attempt < 10000; ++attempt)
  {
    ASSERT_EQ(stop_.attempts(), attempt);
    ASSERT_EQ(nextFrame(), RUN_OFF);
    ASSERT_EQ(exchange(stop_, lost()), Progress::Failed);
  }
  EXPECT_TRUE(stop_.pending());
}

TEST_F(Mx2Stop, exceptionIsAFailedAttempt)
{
  EXPECT_EQ(exchange(stop_, exception(0x85, 0x22)), Progress::Failed);
  EXPECT_TRUE(stop_.pending());
  EXPECT_EQ(stop_.lastError(), 0x8522);
  EXPECT_EQ(nextFrame(), RUN_OFF);
}

TEST_F(Mx2Stop, remembersWhyTheLastAttemptFailed)
{
  exchange(stop_, lost());
  EXPECT_EQ(stop_.lastError(), 0x0205);
  exchange(stop_, exception(0x85, 0x22));
  EXPECT_EQ(stop_.lastError(), 0x8522);
}

TEST_F(Mx2Stop, runThatStaysOnIsNotReportedAsTheErrorOfAnEarlierAttempt)
{
  exchange(stop_, lost());
  exchange(stop_, ACKNOWLEDGED);
  exchange(stop_, RUN_IS_ON);
  EXPECT_EQ(stop_.lastError(), 0);
}

TEST_F(Mx2Stop, statusWithRunOffConfirmsIt)
{
  exchange(stop_, ACKNOWLEDGED);
  stop_.confirm();
  EXPECT_FALSE(stop_.pending());
}

TEST_F(Mx2Stop, nextStopBeginsWithTheWriteAndWithNoAttempts)
{
  exchange(stop_, lost());
  exchange(stop_, ACKNOWLEDGED);
  exchange(stop_, RUN_IS_OFF);
  stop_.request(at(5000), StopMode::Decelerate);
  EXPECT_TRUE(stop_.pending());
  EXPECT_EQ(stop_.attempts(), 0U);
  EXPECT_EQ(stop_.lastError(), 0);
  EXPECT_EQ(nextFrame(), RUN_OFF);
}

TEST_F(Mx2Stop, secondRequestLeavesTheOneUnderWayAsItIs)
{
  exchange(stop_, lost());
  exchange(stop_, ACKNOWLEDGED);
  stop_.request(at(5000), StopMode::Decelerate);
  EXPECT_EQ(stop_.attempts(), 1U);
  EXPECT_EQ(nextFrame(), READ_RUN);
}

TEST_F(Mx2Stop, measuresTheTimeFromTheRequestToItsFirstByteOnce)
{
  const auto latency = stop_.sent(at(12));
  ASSERT_TRUE(latency);
  EXPECT_EQ(*latency, Ms(12));
  EXPECT_FALSE(stop_.sent(at(30)));
  exchange(stop_, ACKNOWLEDGED);
  exchange(stop_, RUN_IS_OFF);
  stop_.request(at(1000), StopMode::Decelerate);
  EXPECT_EQ(*stop_.sent(at(1003)), Ms(3));
}

TEST_F(Mx2Stop, secondRequestDoesNotHideTheLatencyOfTheFirst)
{
  stop_.request(at(50), StopMode::Decelerate);
  EXPECT_EQ(*stop_.sent(at(60)), Ms(60));
}

TEST_F(Mx2Stop, cancelledStopIsPendingNoMore)
{
  stop_.cancel();
  EXPECT_FALSE(stop_.pending());
}

TEST_F(Mx2Stop, modesThatTheDriveLacksAreCarriedOutAsDecelerate)
{
  EXPECT_EQ(stop_.sequenceFor(StopMode::Coast), "stop");
  EXPECT_EQ(stop_.sequenceFor(StopMode::Quick), "stop");
  EXPECT_EQ(stop_.sequenceFor(StopMode::Decelerate), "stop");
}

TEST(StopJob, framesGoToTheStationOfTheInverter)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  StopJob stop(mx2, 8);
  stop.request(at(0), StopMode::Decelerate);
  EXPECT_EQ(printed(stop.next()), "08 05 00 00 00 00");
}

TEST(StopJob, nothingIsPendingBeforeTheFirstRequest)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  const StopJob stop(mx2, 1);
  EXPECT_FALSE(stop.pending());
  EXPECT_EQ(stop.attempts(), 0U);
}

TEST(StopJob, isNotPendingOnADriveWithoutAConfirmedStop)
{
  drive::Profile profile = drive::loadProfile("omron_mx2", drive::profileDirectory());
  profile.sequences.at("stop").unconfirmed = "stop_command";
  const drive::Drive drive(profile);
  StopJob stop(drive, 1);
  stop.request(at(0), StopMode::Decelerate);
  EXPECT_FALSE(stop.pending());
}

TEST(StopJob, acknowledgementConfirmsWhereTheDriveCannotTellRun)
{
  const drive::Drive drive = thatCannotTellRun(shipped("omron_mx2"));
  StopJob stop(drive, 1);
  stop.request(at(0), StopMode::Decelerate);
  EXPECT_EQ(exchange(stop, ACKNOWLEDGED), Progress::Confirmed);
}

TEST(StopJob, acknowledgementThatMayBeAnotherRequestsConfirmsNothingWhereTheDriveCannotTellRun)
{
  const drive::Drive drive = thatCannotTellRun(shipped("omron_mx2"));
  StopJob stop(drive, 1);
  stop.request(at(0), StopMode::Decelerate);
  EXPECT_FALSE(stop.wantsClearLine()) << "the first frame of a stop waits for nothing";
  stop.sent(at(1));
  EXPECT_EQ(stop.done(ACKNOWLEDGED, true), Progress::Failed);
  EXPECT_TRUE(stop.wantsClearLine());
  EXPECT_EQ(printed(stop.next()), RUN_OFF);
  EXPECT_EQ(exchange(stop, ACKNOWLEDGED), Progress::Confirmed);
}

TEST(StopJob, aLoopBackAndAWriteTakeTurnsUntilTheLineIsClear)
{
  const drive::Drive drive = thatCannotTellRun(shipped("omron_mx2"));
  StopJob stop(drive, 1);
  stop.request(at(0), StopMode::Decelerate);
  stop.sent(at(1));
  stop.done(ACKNOWLEDGED, true);
  ASSERT_TRUE(stop.wantsClearLine());
  EXPECT_EQ(stop.done(lost()), Progress::Failed) << "the loop-back";
  EXPECT_FALSE(stop.wantsClearLine()) << "RUN may still be on: the write goes again";
}

TEST(StopJob, anUpgradeWaitsForNoClearLine)
{
  const drive::Drive drive = thatCannotTellRun(mx2WithCoast());
  StopJob stop(drive, 1);
  stop.request(at(0), StopMode::Decelerate);
  stop.sent(at(1));
  stop.done(ACKNOWLEDGED, true);
  ASSERT_TRUE(stop.wantsClearLine());
  stop.request(at(2), StopMode::Coast);
  EXPECT_FALSE(stop.wantsClearLine());
}

TEST(StopJob, readBackDecidesWhoeverAcknowledgedTheWrite)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  StopJob stop(mx2, 1);
  stop.request(at(0), StopMode::Decelerate);
  stop.sent(at(1));
  EXPECT_EQ(stop.done(ACKNOWLEDGED, true), Progress::GoesOn);
  EXPECT_EQ(exchange(stop, RUN_IS_OFF), Progress::Confirmed);
}

TEST(StopJob, valueOfRunThatMeansNothingConfirmsNoStop)
{
  drive::Profile profile = drive::loadProfile("omron_mx2", drive::profileDirectory());
  profile.status.erase("running");
  drive::Item& run = profile.status.at("run_seen");
  run.space = drive::Space::Register;
  run.values = { { 0, 0 }, { 1, 1 } };
  const drive::Drive drive(profile);
  StopJob stop(drive, 1);
  stop.request(at(0), StopMode::Decelerate);
  exchange(stop, ACKNOWLEDGED);
  EXPECT_NE(exchange(stop, reply("03 02 00 07")), Progress::Confirmed) << "7 is not seen off";
}

TEST(StopJob, coastIsWrittenStepByStepBeforeTheReadBack)
{
  const drive::Drive drive = mx2WithCoast();
  StopJob stop(drive, 1);
  stop.request(at(0), StopMode::Coast);
  EXPECT_EQ(printed(stop.next()), FREE_RUN);
  EXPECT_EQ(exchange(stop, reply("05 00 08 FF 00")), Progress::GoesOn);
  EXPECT_EQ(printed(stop.next()), RUN_OFF);
  EXPECT_EQ(exchange(stop, ACKNOWLEDGED), Progress::GoesOn);
  EXPECT_EQ(printed(stop.next()), READ_RUN);
}

TEST(StopJob, coastUpgradesAPendingStopAndItsAttemptsGoOnCounting)
{
  const drive::Drive drive = mx2WithCoast();
  StopJob stop(drive, 1);
  stop.request(at(0), StopMode::Decelerate);
  exchange(stop, lost());
  exchange(stop, ACKNOWLEDGED);
  stop.request(at(100), StopMode::Coast);
  EXPECT_EQ(printed(stop.next()), FREE_RUN);
  EXPECT_EQ(stop.attempts(), 1U);
}

TEST(StopJob, decelerateDoesNotTakeAPendingCoastBack)
{
  const drive::Drive drive = mx2WithCoast();
  StopJob stop(drive, 1);
  stop.request(at(0), StopMode::Coast);
  stop.request(at(10), StopMode::Decelerate);
  EXPECT_EQ(printed(stop.next()), FREE_RUN);
}

TEST(StopJob, upgradeWhileAFrameIsOnTheWireIsWrittenFromItsFirstStep)
{
  const drive::Drive drive = mx2WithCoast();
  StopJob stop(drive, 1);
  stop.request(at(0), StopMode::Decelerate);
  ASSERT_EQ(printed(stop.next()), RUN_OFF);
  stop.sent(at(1));
  stop.request(at(5), StopMode::Coast);
  stop.done(ACKNOWLEDGED);
  EXPECT_EQ(printed(stop.next()), FREE_RUN) << "the acknowledgement belongs to the frame of the old mode";
}

TEST(StopJob, upgradeWhileTheReadBackIsOnTheWireIsNotTakenForWritten)
{
  const drive::Drive drive = mx2WithCoast();
  StopJob stop(drive, 1);
  stop.request(at(0), StopMode::Decelerate);
  exchange(stop, ACKNOWLEDGED);
  ASSERT_EQ(printed(stop.next()), READ_RUN);
  stop.sent(at(4));
  stop.request(at(5), StopMode::Coast);
  stop.done(RUN_IS_OFF);
  EXPECT_TRUE(!stop.pending() || printed(stop.next()) == FREE_RUN)
      << "the reply of a read was taken for one of a write";
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

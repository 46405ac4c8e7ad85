// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// The rules of the contract's section 4 on a whole bus in virtual time: what counts is what the simulated motor does.

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
const char* const ONE_BELT = R"(
port: /dev/virtual
baud_rate: 19200
scan_list:
  - {name: belt, node: 1, drive: omron_mx2}
)";

const char* const TWO_BELTS = R"(
port: /dev/virtual
baud_rate: 19200
scan_list:
  - {name: belt_1, node: 1, drive: omron_mx2}
  - {name: belt_2, node: 2, drive: omron_rx, hz_per_unit: -10.0}
)";

constexpr const char* RUN_ON = "01 05 00 00 FF 00";
constexpr const char* RESET_ON = "01 05 00 03 FF 00";
constexpr const char* RUN_OFF = "01 05 00 00 00 00";

TEST(Safety, runsWhenCommandedAndStopsWhenCommandsEnd)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 3.0);
  bus.run(3.0);
  EXPECT_GT(bus.motor("belt", "frequency"), 5.0);
  EXPECT_EQ(bus.motor("belt", "direction"), 1);
  bus.run(1.0);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 0);
  EXPECT_TRUE(bus.status(0).locked || !bus.status(0).run_command);
  bus.run(20.0);
  EXPECT_EQ(bus.motor("belt", "frequency"), 0.0);
}

TEST(Safety, aStreamThatChangesFasterThanAFrameTakesStartsTheMotorAndDelaysNobody)
{
  VirtualBus bus(R"(
port: /dev/virtual
baud_rate: 9600
scan_list:
  - {name: belt_1, node: 1, drive: omron_mx2}
  - {name: belt_2, node: 2, drive: omron_mx2}
)");
  bus.settleIn();
  for (int i = 0; i < 500; ++i)
  {
    bus.at(0.01 * i, [&bus, i] { bus.command(0, 10.0 + 0.02 * i); });
  }
  bus.run(0.5);
  EXPECT_EQ(bus.motor("belt_1", "run_coil"), 1);
  bus.command(1, 20.0);
  bus.run(0.49);
  EXPECT_EQ(bus.motor("belt_2", "run_coil"), 1);
  bus.run(3.0);
  EXPECT_LT(bus.now() - bus.status(0).stamp, seconds(2.0));
  EXPECT_LT(bus.now() - bus.status(1).stamp, seconds(2.0));
}

TEST(Safety, nothingRunsAtStartUpWithALiveStream)
{
  VirtualBus bus(ONE_BELT);
  bus.stream(0, 20.0, 0.1, 10.0);
  bus.run(10.0);
  EXPECT_EQ(bus.count(RUN_ON), 0U);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 0);
  EXPECT_EQ(bus.status(0).error_id, bus::ERROR_LOCKED);
}

TEST(Safety, aStreamRunsAfterItHasReturnedToNeutral)
{
  VirtualBus bus(ONE_BELT);
  bus.stream(0, 20.0, 0.1, 2.0);
  bus.run(2.0);
  bus.command(0, 0.0);
  bus.run(0.1);
  EXPECT_EQ(bus.command(0, 20.0), 0);
  bus.run(0.2);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 1);
}

TEST(Safety, aLeftoverRunFromTheBusIsClearedAtStartUp)
{
  VirtualBus bus(ONE_BELT);
  bus.world("bus foreign 01 05 00 00 FF 00");
  bus.pass(1.0);
  ASSERT_EQ(bus.motor("belt", "run_coil"), 1);
  bus.run(2.0);
  EXPECT_EQ(bus.count(RUN_OFF), 1U);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 0);
  EXPECT_EQ(bus.count(RUN_ON), 0U);
}

TEST(Safety, aShortBrownOutLocksAndNothingRunsAgain)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 8.0);
  bus.run(2.0);
  bus.clearFrames();
  bus.world("belt power_cycle 0.02");
  bus.run(6.0);
  EXPECT_EQ(bus.count(RUN_ON), 0U);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 0);
  EXPECT_TRUE(bus.status(0).locked);
  EXPECT_EQ(bus.status(0).error_id, bus::ERROR_LOCKED);
}

TEST(Safety, aPanelStopLocksAndTakesRunOff)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.world("belt set F003 1");
  bus.stream(0, 20.0, 0.1, 20.0);
  bus.run(4.0);
  bus.clearFrames();
  bus.world("belt panel_stop");
  bus.run(10.0);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 0);
  EXPECT_EQ(bus.motor("belt", "frequency"), 0.0);
  EXPECT_EQ(bus.count(RUN_ON), 0U);
  EXPECT_TRUE(bus.status(0).locked);
}

TEST(Safety, aTripTakesRunOffAtOnceSoThatAResetStartsNothing)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 30.0);
  bus.run(2.0);
  bus.clearFrames();
  bus.world("belt trip 7");
  ASSERT_TRUE(bus.runUntil(2.0, [&] { return bus.status(0).monitor.faulted.value_or(false); }));
  EXPECT_EQ(bus.status(0).monitor.fault_code.value_or(0), 7);
  bus.run(0.5);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 0);
  const bus::Answer answer = bus.wait(bus.reset(0));
  EXPECT_TRUE(answer.success) << answer.message;
  bus.run(5.0);
  EXPECT_EQ(bus.count(RUN_ON), 0U) << "a stream that goes on must not start the motor after the reset";
  EXPECT_EQ(bus.motor("belt", "frequency"), 0.0);
}

TEST(Safety, aResetThatIsAskedForTwiceIsDoneOnceAndNoMotorStartsBeforeItsEnd)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.world("belt trip 7");
  ASSERT_TRUE(bus.runUntil(2.0, [&] { return bus.status(0).monitor.faulted.value_or(false); }));
  bus.run(2.0);
  bus.clearFrames();
  const auto first = bus.reset(0);
  bus.runUntil(1.0, [&] { return bus.count(RESET_ON) == 1; });
  const auto second = bus.reset(0);
  EXPECT_TRUE(bus.wait(first).success);
  EXPECT_TRUE(bus.wait(second).success);
  bus.command(0, 0.0);
  bus.stream(0, 20.0, 0.02, 5.0);
  bus.run(2.0);
  EXPECT_EQ(bus.count(RESET_ON), 1U) << "a second reset would go to a motor that was started after the first";
  EXPECT_EQ(bus.count(RUN_ON), 1U);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 1);
}

TEST(Safety, anOfflineInverterIsStoppedOnItsReturnAndStaysLocked)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 30.0);
  bus.run(2.0);
  bus.world("belt offline");
  ASSERT_TRUE(bus.runUntil(3.0, [&] { return bus.status(0).communication_error; }));
  EXPECT_FALSE(bus.status(0).monitor.output_frequency.has_value());
  bus.clearFrames();
  bus.world("belt online");
  ASSERT_TRUE(bus.runUntil(3.0, [&] { return !bus.status(0).communication_error; }));
  bus.run(3.0);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 0);
  EXPECT_EQ(bus.count(RUN_ON), 0U);
  EXPECT_EQ(bus.status(0).error_id, bus::ERROR_LOCKED);
}

TEST(Safety, anUnpluggedPortComesBackWithinASecondAndRunsNothing)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 30.0);
  bus.run(2.0);
  bus.world("bus unplug");
  bus.run(3.0);
  EXPECT_TRUE(bus.status(0).communication_error);
  bus.clearFrames();
  bus.world("bus plug");
  ASSERT_TRUE(bus.runUntil(1.0, [&] { return !bus.status(0).communication_error; }));
  bus.run(3.0);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 0);
  EXPECT_EQ(bus.count(RUN_ON), 0U);
}

TEST(Safety, aStopIsTheNextFrameAndItsServiceAnswersWhenConfirmed)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 30.0);
  bus.run(2.0);
  std::vector<VirtualBus::Box> storm;
  for (int call = 0; call < 50; ++call)
  {
    storm.push_back(bus.readParameter(call % 2, "F002"));
  }
  bus.run(0.05);
  bus.clearFrames();
  const auto box = bus.stop(0);
  const bus::Answer answer = bus.wait(box);
  EXPECT_TRUE(answer.success) << answer.message;
  const auto requests = bus.requests();
  const auto off = std::find(requests.begin(), requests.end(), RUN_OFF);
  EXPECT_LE(off - requests.begin(), 1) << "only the exchange in flight may come before it";
  ASSERT_GE(requests.end() - off, 2);
  EXPECT_EQ(*(off + 1), "01 01 00 00 00 01");
  EXPECT_EQ(bus.motor("belt_1", "run_coil"), 0);
}

TEST(Safety, aCommandOfZeroTakesRunOffWithoutALock)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 2.0);
  bus.run(2.0);
  EXPECT_EQ(bus.command(0, 0.0), 0);
  bus.run(0.2);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 0);
  EXPECT_FALSE(bus.status(0).locked);
  EXPECT_EQ(bus.command(0, 10.0), 0);
  bus.run(0.2);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 1);
}

TEST(Safety, anEqualCommandFeedsTheWatchdogAndSendsNothing)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 5.0);
  bus.run(1.0);
  bus.clearFrames();
  bus.run(3.5);
  EXPECT_EQ(bus.count("01 05"), 0U);
  EXPECT_EQ(bus.count("01 10"), 0U);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 1);
}

TEST(Safety, aMirroredDriveTurnsTheOtherWayAndReportsTheUsersSense)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn();
  bus.stream(1, 2.0, 0.1, 3.0);
  bus.run(2.5);
  EXPECT_EQ(bus.motor("belt_2", "direction"), -1);
  EXPECT_EQ(bus.motor("belt_2", "reference"), 20.0);
}

TEST(Safety, aLostExchangeIsRepeatedAfterALoopBackAndRunsNothingTwice)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.world("belt damaged count 1");
  bus.command(0, 20.0);
  bus.run(0.4);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 1);
  EXPECT_EQ(bus.count(RUN_ON), 1U);
  EXPECT_GE(bus.count("01 08"), 1U);
}

TEST(Safety, aCommandWhoseReplyIsLostIsGivenUpAndTheNextOneRuns)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.world("belt late 0.3 count 1");
  bus.command(0, 20.0);
  bus.run(0.5);
  EXPECT_EQ(bus.count(RUN_ON), 0U);
  EXPECT_EQ(bus.status(0).error_id, wire::ERROR_TIMEOUT);
  EXPECT_FALSE(bus.status(0).move_velocity_active);
  EXPECT_EQ(bus.command(0, 20.0), 0);
  bus.run(0.4);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 1);
}

TEST(Safety, shutdownStopsWhatMayRunAndConfirms)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 10.0);
  bus.run(2.0);
  bus.coordinator().beginShutdown(bus.now());
  EXPECT_TRUE(bus.runUntil(2.0, [&] { return bus.coordinator().shutdownDone(bus.now()); }));
  EXPECT_TRUE(bus.coordinator().endShutdown().empty());
  EXPECT_EQ(bus.motor("belt_1", "run_coil"), 0);
  EXPECT_EQ(bus.command(0, 20.0), bus::ERROR_SHUTTING_DOWN);
}

TEST(Safety, shutdownWritesEveryStopBeforeItReadsTheFirstBack)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 10.0);
  bus.stream(1, 3.0, 0.1, 10.0);
  bus.run(2.0);
  ASSERT_EQ(bus.motor("belt_2", "run_coil"), 1);
  bus.clearFrames();
  bus.coordinator().beginShutdown(bus.now());
  EXPECT_TRUE(bus.runUntil(2.0, [&] { return bus.coordinator().shutdownDone(bus.now()); }));
  const std::vector<std::string> sent = bus.requests();
  ASSERT_GE(sent.size(), 4U);
  EXPECT_EQ(sent[0], "01 05 00 00 00 00");
  EXPECT_EQ(sent[1], "02 05 00 00 00 00");
}

TEST(Safety, whatIsAskedForAfterTheShutdownIsRefusedAtOnce)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn();
  bus.coordinator().beginShutdown(bus.now());
  ASSERT_TRUE(bus.runUntil(2.0, [&] { return bus.coordinator().shutdownDone(bus.now()); }));
  bus.coordinator().endShutdown();
  bus.coordinator().takeAnswers();
  bus.stop(std::nullopt);
  bus.stop(0);
  bus.reset(0);
  bus.readParameter(0, "F002");
  const bus::PendingAnswers answers = bus.coordinator().takeAnswers();
  ASSERT_EQ(answers.size(), 4U);
  for (const auto& answer : answers)
  {
    EXPECT_EQ(answer.second.error_id, bus::ERROR_SHUTTING_DOWN);
  }
}

TEST(Safety, aTripIsActedUponAlthoughTheRestOfTheStatusIsLost)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 5.0);
  bus.run(1.0);
  bus.world("belt lost_reply count 0 function 3");
  bus.world("belt trip 7");
  bus.run(2.0);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 0);
}

TEST(Safety, aStatusOfWhichHalfIsLostKeepsItsOldStamp)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.world("belt lost_reply count 0 function 3");
  bus.run(0.5);
  const TimePoint stamp = bus.status(0).stamp;
  bus.run(3.0);
  EXPECT_EQ(bus.status(0).stamp, stamp);
  EXPECT_NE(bus.status(0).error_id, 0);
}

TEST(Safety, aSingleZeroLocksNothingHoweverLongTheCycle)
{
  VirtualBus bus("port: /dev/virtual\ninterval: 3.0\nscan_list:\n  - {name: belt, node: 1, drive: omron_mx2}\n");
  ASSERT_TRUE(bus.runUntil(12.0, [&] { return bus.hasStatus(0) && !bus.status(0).locked; }));
  ASSERT_EQ(bus.command(0, 20.0), 0);
  bus.run(0.3);
  ASSERT_EQ(bus.motor("belt", "run_coil"), 1);
  bus.command(0, 0.0);
  bus.run(1.0);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 0);
  EXPECT_EQ(bus.command(0, 20.0), 0);
}

TEST(Safety, refusedVelocitiesSendNothing)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  for (const double velocity :
       { 1e9, -401.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity() })
  {
    EXPECT_EQ(bus.command(0, velocity), bus::ERROR_OUT_OF_RANGE) << velocity;
  }
  bus.run(1.0);
  EXPECT_EQ(bus.count("01 05") + bus.count("01 10") + bus.count("01 06"), 0U);
  EXPECT_EQ(bus.status(0).error_id, bus::ERROR_OUT_OF_RANGE);
}
}  // namespace
}  // namespace inverter_bus

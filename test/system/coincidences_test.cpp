// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Coincidences that far seeds of bus_fuzz met, each told again on a small bus in virtual time.

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
const char* const MIXER_AND_BELTS = R"(
port: /dev/virtual
baud_rate: 9600
parity: even
scan_list:
  - name: mixer
    node: 1
    drive: teco_7200ma
    confirm: [run_forward, fault_reset, frequency_scale, monitor_layout, fault_coding]
    overrides: {reverse_word: 2, monitor_base: 0x0020}
  - {name: belt_1, node: 2, drive: omron_mx2}
  - {name: belt_2, node: 3, drive: omron_mx2}
)";

const char* const THREE_MIXERS = R"(
port: /dev/virtual
baud_rate: 9600
parity: even
defaults:
  drive: teco_7200ma
  confirm: [run_forward, fault_reset, frequency_scale, monitor_layout, fault_coding]
  overrides: {reverse_word: 2, monitor_base: 0x0020}
scan_list:
  - {name: mixer_1, node: 1}
  - {name: mixer_2, node: 2}
  - {name: mixer_3, node: 3}
)";

/// Somebody calls a stop again and again: of one inverter, or of all.
void flood(VirtualBus& bus, std::optional<std::size_t> index, double period, double duration)
{
  for (double time = 0.0; time < duration; time += period)
  {
    bus.at(time, [&bus, index] { bus.stop(index); });
  }
}

/// It starts anew and is deaf for a second, however short the cut.
void switchOffAndOn(VirtualBus& bus, const std::string& name)
{
  bus.world(name + " power off");
  bus.at(0.02, [&bus, name] { bus.world(name + " power on"); });
  bus.run(0.03);
}

// Seed 7002317.
TEST(Coincidences, whoStopsAgainAndAgainDuringTheShutdownKeepsNoOtherMotorRunning)
{
  VirtualBus bus(MIXER_AND_BELTS);
  bus.settleIn();
  for (std::size_t index = 0; index < 3; ++index)
  {
    bus.stream(index, 20.0, 0.1, 10.0);
  }
  bus.run(3.0);
  ASSERT_EQ(bus.motor("belt_2", "run_coil"), 1);
  bus.coordinator().beginShutdown(bus.now());
  flood(bus, 0, 0.001, 3.0);
  // The flood never ends; the node's own bound ends the shutdown.
  bus.runUntil(5.0, [&] { return bus.coordinator().shutdownDone(bus.now()); });
  EXPECT_EQ(bus.motor("belt_1", "run_coil"), 0);
  EXPECT_EQ(bus.motor("belt_2", "run_coil"), 0);
  for (const std::string& text : bus.coordinator().endShutdown())
  {
    EXPECT_EQ(text.compare(0, 5, "mixer"), 0) << text;
  }
}

TEST(Coincidences, whoStopsAllAgainAndAgainBlindsTheDriverNotAndGetsHisAnswers)
{
  VirtualBus bus(THREE_MIXERS);
  bus.settleIn();
  for (std::size_t index = 0; index < 3; ++index)
  {
    bus.stream(index, 20.0, 0.1, 1.5);
  }
  bus.run(1.5);
  flood(bus, std::nullopt, 0.005, 8.0);
  const auto answer = bus.wait(bus.stop(std::nullopt), 5.0);
  EXPECT_TRUE(answer.success) << answer.message;
  bus.run(3.0);
  for (std::size_t index = 0; index < 3; ++index)
  {
    EXPECT_GT(bus.status(index).stamp, bus.now() - seconds(2.0)) << index;
  }
}
// Seed 7000622.
TEST(Coincidences, theWatchdogLocksAlthoughTheStopOfALostRunIsUnderWay)
{
  VirtualBus bus(R"(
port: /dev/virtual
retries: 0
response_timeout: 0.25
scan_list:
  - {name: belt, node: 1, drive: omron_mx2, command_timeout: 0.3}
)");
  bus.settleIn();
  EXPECT_EQ(bus.command(0, 20.0), 0);
  ASSERT_TRUE(bus.runUntil(1.0, [&] { return bus.count("01 05 00 01") > 0; }));
  // Direction is confirmed: RUN is next.
  bus.world("belt lost_reply count 1");
  // The RUN is given up after 0.3 s without a reply, and by then no command has come for as long.
  EXPECT_TRUE(bus.runUntil(1.0, [&] { return bus.count("01 05 00 00 00 00") > 0; }));
  bus.runUntil(1.0, [&] { return bus.hasStatus(0) && !bus.status(0).stop_active; });
  bus.run(0.1);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 0);
  EXPECT_EQ(bus.command(0, 20.0), bus::ERROR_LOCKED) << "who was silent for too long must return to neutral";
  EXPECT_TRUE(bus.status(0).locked);
}
// Seeds 8003100 and 10006396.
TEST(Coincidences, aDriveThatCameBackForOneReplyCostsNoMoreThanOneThatIsOffline)
{
  VirtualBus bus(R"(
port: /dev/virtual
retries: 3
offline_after: 8
scan_list:
  - {name: belt_1, node: 1, drive: omron_mx2}
  - {name: belt_2, node: 2, drive: omron_mx2}
)");
  bus.settleIn();
  bus.world("belt_2 offline");
  ASSERT_TRUE(bus.runUntil(20.0, [&] { return bus.status(1).communication_error; }));
  bus.world("belt_2 online");
  // It answers once, and is away again before anybody has read its status.
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.frames().back().drive == "belt_2"; }));
  bus.world("belt_2 offline");
  bus.run(0.6);
  bus.clearFrames();
  bus.run(10.0);
  // 0.1 s of silence each: 5 % of the time are five of them.
  EXPECT_LE(bus.count("02"), 8U);
  EXPECT_TRUE(bus.status(1).communication_error);
}
// Seeds 10000411, 10000930 and 10009227.
TEST(Coincidences, aRestartAtRestIsNoticedAsSoonAsTheDriveAnswersAgain)
{
  // Whichever read is lost while the drive is deaf, that of the restart's marker among them.
  for (double phase = 0.0; phase < 2.5; phase += 0.1)
  {
    VirtualBus bus(R"(
port: /dev/virtual
baud_rate: 9600
parity: even
interval: 0.15
offline_after: 20
scan_list:
  - {name: pump, node: 1, drive: toshiba_vfs15}
)");
    bus.settleIn();
    bus.run(phase);
    switchOffAndOn(bus, "pump");
    ASSERT_EQ(bus.motor("pump", "reset_marker"), 0.0);
    // Deaf for 1.02 s; a marker that was lost itself is asked for again after 0.5 s.
    EXPECT_TRUE(bus.runUntil(2.5, [&] { return bus.motor("pump", "reset_marker") == 1.0; })) << phase;
  }
}

TEST(Coincidences, aRestartBeforeTheRunThatIsInForceStopsNothing)
{
  VirtualBus bus(R"(
port: /dev/virtual
parity: even
interval: 1.4
scan_list:
  - {name: pump, node: 1, drive: toshiba_vfs15}
)");
  bus.settleIn(60.0);
  // Switched off and on between two refreshes: nothing gets lost, and its marker is read many refreshes later.
  const std::size_t replies = bus.frames().size();
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.frames().size() > replies; }));
  bus.run(0.1);
  switchOffAndOn(bus, "pump");
  bus.run(1.1);
  bus.stream(0, 20.0, 0.1, 30.0);
  bus.run(29.0);
  EXPECT_EQ(bus.motor("pump", "reset_marker"), 1.0);
  EXPECT_EQ(bus.motor("pump", "run_command"), 1.0);
  EXPECT_FALSE(bus.status(0).locked);
}

// Seed 1317. The commands of the others go first, and a refresh of the pump between them.
TEST(Coincidences, aVelocityThatWasAcceptedBeforeARestartWasNoticedStartsNothingAfterwards)
{
  unsigned cancelled = 0;
  for (double phase = 0.0; phase < 1.2; phase += 0.02)
  {
    VirtualBus bus(R"(
port: /dev/virtual
baud_rate: 9600
parity: even
defaults: {command_timeout: 0, drive: toshiba_vfs15}
scan_list:
  - {name: fan_1, node: 1}
  - {name: fan_2, node: 2}
  - {name: fan_3, node: 3}
  - {name: pump, node: 4}
)");
    bus.settleIn();
    bus.run(3.0);
    switchOffAndOn(bus, "pump");
    bus.clearFrames();
    bus.run(1.0 + phase);
    // What the pump is is asked as soon as its restart is noticed.
    const bool noticed = bus.count("04 03 FB 07 00 01") > 0;
    for (const std::size_t index : { 0U, 1U, 2U, 3U })
    {
      bus.command(index, 20.0);
    }
    bus.run(3.0);
    const std::vector<std::string> requests = bus.requests();
    const auto run = std::find(requests.begin(), requests.end(), "04 06 FA 00 C4 00");
    const auto marker = std::find(requests.begin(), requests.end(), "04 06 FA 87 00 01");
    ASSERT_NE(marker, requests.end()) << phase;
    if (!noticed)
    {
      EXPECT_TRUE(run == requests.end() || run < marker) << phase;
      cancelled += run == requests.end() ? 1 : 0;
    }
  }
  EXPECT_GT(cancelled, 0U);
}

TEST(Coincidences, aRestartAfterTheRunIsFoundOutByTheRunThatIsGone)
{
  VirtualBus bus(R"(
port: /dev/virtual
parity: even
interval: 1.4
scan_list:
  - {name: pump, node: 1, drive: toshiba_vfs15}
)");
  bus.settleIn(60.0);
  bus.stream(0, 20.0, 0.1, 60.0);
  bus.run(4.0);
  ASSERT_EQ(bus.motor("pump", "run_command"), 1.0);
  switchOffAndOn(bus, "pump");
  bus.clearFrames();
  bus.run(20.0);
  EXPECT_EQ(bus.motor("pump", "run_command"), 0.0);
  EXPECT_EQ(bus.count("01 06 FA 00 C4 00"), 0U);
  EXPECT_TRUE(bus.status(0).locked);
}
// Seed 10002649.
TEST(Coincidences, aStopThatNeverLeftIsNoReasonToSendRunAgain)
{
  VirtualBus bus(R"(
port: /dev/virtual
retries: 3
offline_after: 20
scan_list:
  - {name: belt, node: 1, drive: omron_mx2}
)");
  bus.settleIn();
  // A stop is repeated at once; for a second nobody knows which of the two was answered.
  bus.world("belt lost_request count 1");
  EXPECT_TRUE(bus.wait(bus.stop(0)).success);
  bus.command(0, 0.0);
  EXPECT_EQ(bus.command(0, 20.0), 0);
  ASSERT_TRUE(bus.runUntil(0.5, [&] { return bus.motor("belt", "run_coil") == 1.0; }));
  bus.world("belt offline");
  bus.clearFrames();
  // Before the 0 goes, a loop-back is to put the line into step; it gets lost.
  bus.command(0, 0.0);
  ASSERT_TRUE(bus.runUntil(1.0, [&] { return bus.count("01 08") > 0; }));
  bus.command(0, 10.0);
  bus.world("belt online");
  bus.run(0.4);
  EXPECT_EQ(bus.count("01 05 00 00 00 00"), 0U);
  EXPECT_EQ(bus.count("01 05 00 00 FF 00"), 0U) << "RUN was in force all the time";
  EXPECT_EQ(bus.motor("belt", "reference"), 10.0);
}
// Seeds 10003524 and 10004636.
TEST(Coincidences, aPowerCutWhileItIsToTurnRoundStartsNoMotor)
{
  for (const char* duration : { "0.05", "0.1", "0.3" })
  {
    VirtualBus bus(MIXER_AND_BELTS);
    bus.settleIn();
    bus.stream(0, 20.0, 0.1, 3.0);
    bus.run(3.0);
    ASSERT_EQ(bus.motor("mixer", "run_command"), 1.0);
    bus.clearFrames();
    bus.stream(0, -20.0, 0.1, 3.0);
    // The set-point is the same: the first frame is the RUN that turns it round.
    bus.world(std::string("mixer power_cycle ") + duration);
    bus.run(3.0);
    EXPECT_GE(bus.count("01 10 00 00 00 01 02 00 02"), 1U);
    EXPECT_EQ(bus.motor("mixer", "run_command"), 0.0) << duration;
    EXPECT_EQ(bus.motor("mixer", "frequency"), 0.0) << duration;
    EXPECT_TRUE(bus.status(0).locked) << duration;
  }
}

TEST(Coincidences, aLostReplyToARunThatTurnsTheMotorRoundIsRepeatedAsEver)
{
  for (const char* harm : { "lost_reply", "lost_request" })
  {
    VirtualBus bus(MIXER_AND_BELTS);
    bus.settleIn();
    bus.stream(0, 20.0, 0.1, 3.0);
    bus.run(3.0);
    bus.stream(0, -20.0, 0.1, 3.0);
    bus.world(std::string("mixer ") + harm + " count 1");
    bus.run(2.9);
    EXPECT_EQ(bus.motor("mixer", "target"), -20.0) << harm;
    EXPECT_FALSE(bus.status(0).locked) << harm;
  }
}
}  // namespace
}  // namespace inverter_bus

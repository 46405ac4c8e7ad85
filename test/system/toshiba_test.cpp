// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// A VF-S15 on a whole bus in virtual time: block read and write, the reset without a reply, the EEPROM.

#include <gmock/gmock.h>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
using ::testing::HasSubstr;
using ::testing::Not;

const char* const DIRECT = R"(
port: /dev/virtual
baud_rate: 19200
parity: even
scan_list:
  - {name: pump, node: 1, drive: toshiba_vfs15}
)";

/// F870 = 1, F871 = 3 and F875-F879 = 1, 2, 3, 4, 14: what block_read asks for by default.
const char* const BLOCK = R"(
port: /dev/virtual
baud_rate: 19200
parity: even
scan_list:
  - {name: pump, node: 1, drive: toshiba_vfs15}
simulation:
  pump: {parameters: {F870: 1, F871: 3, F875: 1, F876: 2, F877: 3, F878: 4, F879: 14}}
)";

/// Trips a second after the last request (F803, F804).
const char* const SUPERVISED = R"(
port: /dev/virtual
baud_rate: 19200
parity: even
retries: 0
scan_list:
  - {name: pump, node: 1, drive: toshiba_vfs15}
simulation:
  pump: {parameters: {F803: 1, F804: 1}}
)";

// Frames without their check sum. E6581913 p27, p33, p35.
constexpr const char* BLOCK_READ = "01 03 18 75 00 05";
constexpr const char* READ_SLOW = "01 03 FD 18 00 01";
constexpr const char* BLOCK_WRITE = "01 10 18 70 00 02 04";
constexpr const char* BLOCK_READ_WRITE = "01 17 18 75 00 05 18 70 00 02 04";
constexpr const char* WRITE_COMMAND = "01 06 FA 00";
constexpr const char* WRITE_FREQUENCY = "01 06 FA 01";
constexpr const char* RESET = "01 06 FA 00 E0 00";

/// Frames that put RUN (FA00 bit 10) on, whatever they look like.
std::size_t runFrames(const VirtualBus& bus)
{
  return bus.count("01 06 FA 00 C4") + bus.count("01 06 FA 00 C6") + bus.count("01 10 18 70 00 02 04 C4") +
         bus.count("01 10 18 70 00 02 04 C6") + bus.count("01 17 18 75 00 05 18 70 00 02 04 C4") +
         bus.count("01 17 18 75 00 05 18 70 00 02 04 C6");
}

void settle(VirtualBus& bus)
{
  bus.settleIn();
  bus.run(8.0);  // all settings read, in the lowest class
  bus.clearFrames();
}

TEST(Toshiba, runsChangesReversesAndStopsWithoutItsBlocks)
{
  VirtualBus bus(DIRECT);
  settle(bus);
  bus.stream(0, 20.0, 0.1, 20.0);
  bus.run(20.0);
  EXPECT_NEAR(bus.motor("pump", "frequency"), 20.0, 0.01);
  EXPECT_NEAR(*bus.status(0).monitor.output_frequency, 20.0, 0.01);
  EXPECT_EQ(bus.status(0).monitor.direction, 1);
  EXPECT_EQ(bus.count(BLOCK_READ_WRITE), 0U);
  EXPECT_EQ(bus.count(BLOCK_WRITE), 0U);
  EXPECT_EQ(bus.count(WRITE_COMMAND), 1U);
  EXPECT_EQ(bus.count(WRITE_FREQUENCY), 1U);
  bus.stream(0, -10.0, 0.1, 20.0);
  bus.run(20.0);
  EXPECT_NEAR(bus.motor("pump", "frequency"), 10.0, 0.01);
  EXPECT_EQ(bus.motor("pump", "direction"), -1);
  EXPECT_EQ(bus.status(0).monitor.direction, -1);
  const bus::Answer answer = bus.wait(bus.stop(0));
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(bus.count("01 06 FA 00 C0 00"), 1U);
  bus.run(20.0);
  EXPECT_EQ(bus.motor("pump", "frequency"), 0.0);
}

TEST(Toshiba, saysWhyItsBlocksAreNotUsed)
{
  VirtualBus bus(DIRECT);
  settle(bus);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("block read and write are not used"));
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("configure_block: true"));
}

std::string wellSet(const std::string& more)
{
  return "port: /dev/virtual\nbaud_rate: 19200\nparity: even\nscan_list:\n"
         "  - {name: pump, node: 1, drive: toshiba_vfs15" +
         more +
         "}\n"
         "simulation:\n"
         "  pump: {parameters: {F803: 5, F804: 2, F870: 1, F871: 3, F875: 1, F876: 2, F877: 3, F878: 4, F879: 14}}\n";
}

TEST(Toshiba, aWellSetDriveIsGreenOnceWhatNobodyNeedsIsSkipped)
{
  VirtualBus yellow(wellSet(""));
  settle(yellow);
  EXPECT_THAT(yellow.diagnostics(0), HasSubstr("dc_voltage_base"));
  VirtualBus green(wellSet(", skip: [dc_voltage, torque]"));
  settle(green);
  EXPECT_EQ("", green.findings(0));
  green.run(5.0);
  EXPECT_EQ(0U, green.count(READ_SLOW)) << "the torque is read in spite of skip";
  EXPECT_FALSE(green.status(0).monitor.torque.has_value());
  EXPECT_FALSE(green.status(0).monitor.dc_voltage.has_value());
  EXPECT_TRUE(green.status(0).monitor.output_frequency.has_value());
}

TEST(Toshiba, percentBecomesAmpereAndVoltByTheDrivesOwnRating)
{
  VirtualBus bus(DIRECT);
  settle(bus);
  bus.stream(0, 30.0, 0.1, 20.0);
  bus.run(20.0);
  ASSERT_TRUE(bus.status(0).monitor.output_current);
  EXPECT_NEAR(*bus.status(0).monitor.output_current, bus.motor("pump", "current"), 0.02);
  ASSERT_TRUE(bus.status(0).monitor.output_voltage);
  // FE71 is 200 V, and half of the 60 Hz of vL has half of the voltage.
  EXPECT_NEAR(*bus.status(0).monitor.output_voltage, 100.0, 1.0);
}

TEST(Toshiba, aFittingBlockBringsTheStatusInOneReadAndTheCommandInOneFrame)
{
  VirtualBus bus(BLOCK);
  settle(bus);
  bus.run(1.0);
  EXPECT_GT(bus.count(BLOCK_READ), 10U);
  EXPECT_EQ(bus.count("01 03 FD"), 0U);
  EXPECT_EQ(bus.count(BLOCK_READ_WRITE), 0U) << "no command of ours is in force";
  bus.clearFrames();
  bus.command(0, 20.0);
  bus.runUntil(1.0, [&] { return bus.motor("pump", "frequency") > 0.0; });
  EXPECT_EQ(bus.count("01 10 18 70 00 02 04 C4 00 07 D0"), 1U);
  EXPECT_EQ(bus.count(WRITE_COMMAND), 0U);
}

TEST(Toshiba, aSettledCommandIsReadByThePlainReadAndANewOneGoesWithTheStatus)
{
  VirtualBus bus(BLOCK);
  settle(bus);
  bus.stream(0, 20.0, 0.1, 20.0);
  bus.run(19.0);
  EXPECT_EQ(bus.count(BLOCK_READ_WRITE), 0U) << "nothing is to be written";
  EXPECT_GT(bus.count(BLOCK_READ), 100U);
  EXPECT_NEAR(*bus.status(0).monitor.output_frequency, 20.0, 0.01);
  EXPECT_NEAR(*bus.status(0).monitor.output_current, bus.motor("pump", "current"), 0.02);
  bus.clearFrames();
  bus.run(0.95);
  bus.stream(0, 25.0, 0.1, 1.0);
  ASSERT_TRUE(bus.runUntil(1.0, [&] { return bus.count("01 17 18 75 00 05 18 70 00 02 04 C4 00 09 C4") > 0; }));
  ASSERT_EQ(bus.requests().back().substr(0, 5), "01 17");
  const auto& frames = bus.frames();
  const auto sent = std::find_if(frames.rbegin(), frames.rend(), [](const simulation::FrameRecord& frame) {
    return frame.source == simulation::FrameRecord::Source::Master;
  });
  EXPECT_GT(bus.status(0).stamp, sent->time) << "the status came with it";
  bus.run(0.9);
  EXPECT_EQ(bus.count(BLOCK_READ_WRITE), 1U);
}

TEST(Toshiba, aLostWriteWithAReadIsFollowedByAPlainReadThenByPlainWrites)
{
  VirtualBus bus(BLOCK);
  settle(bus);
  bus.stream(0, 20.0, 0.1, 3.0);
  bus.run(3.05);
  bus.clearFrames();
  bus.world("pump lost_request writes count 1");
  bus.stream(0, 25.0, 0.1, 2.0);
  bus.run(2.0);
  std::vector<std::string> frames = bus.requests();
  const auto lost = std::find_if(frames.begin(), frames.end(),
                                 [](const std::string& text) { return text.compare(0, 5, "01 17") == 0; });
  ASSERT_NE(lost, frames.end());
  const auto read = std::find_if(lost + 1, frames.end(), [](const std::string& text) {
    return text.compare(0, std::string(BLOCK_READ).size(), BLOCK_READ) == 0;
  });
  const auto write = std::find_if(lost + 1, frames.end(),
                                  [](const std::string& text) { return text.compare(0, 11, WRITE_FREQUENCY) == 0; });
  ASSERT_NE(write, frames.end());
  EXPECT_LT(read - frames.begin(), write - frames.begin());
  EXPECT_EQ(bus.count("01 17"), 1U);
  EXPECT_EQ(*write, "01 06 FA 01 09 C4");
}

/// A drive whose own time-out is fed by its command word only.
std::string fedByCommandWord(const std::string& yaml)
{
  std::string text = yaml;
  text.replace(text.find("toshiba_vfs15}"), 14, "toshiba_vfs15, overrides: {feeds: command_word}}");
  const std::size_t parameters = text.find("parameters: {");
  return text.insert(parameters + 13, "F803: 2, F804: 1, ");
}

TEST(Toshiba, whereOnlyTheCommandWordFeedsTheDriveItIsRepeatedBeforeItsTimeOut)
{
  VirtualBus bus(fedByCommandWord(BLOCK));
  settle(bus);
  bus.run(10.0);
  // At rest the stop word.
  const std::size_t stops = bus.count("01 06 FA 00 C0 00");
  EXPECT_GE(stops, 5U);
  EXPECT_LE(stops, 12U);
  bus.stream(0, 20.0, 0.1, 20.0);
  bus.run(5.0);
  bus.clearFrames();
  bus.run(10.0);
  const std::size_t repeats =
      bus.count("01 17 18 75 00 05 18 70 00 02 04 C4 00 07 D0") + bus.count("01 06 FA 00 C4 00");
  EXPECT_GE(repeats, 5U);
  EXPECT_LE(repeats, 12U) << "as a keep-alive, not in every refresh";
  EXPECT_EQ(bus.count("01 06 FA 00 C0 00"), 0U);
  EXPECT_FALSE(bus.status(0).locked);
}

TEST(Toshiba, afterAStopNoRefreshGivesRunBack)
{
  VirtualBus bus(BLOCK);
  settle(bus);
  bus.stream(0, 20.0, 0.1, 5.0);
  bus.run(5.0);
  EXPECT_TRUE(bus.wait(bus.stop(0)).success);
  bus.clearFrames();
  bus.run(20.0);
  EXPECT_EQ(runFrames(bus), 0U);
  EXPECT_EQ(bus.motor("pump", "frequency"), 0.0);
}

TEST(Toshiba, afterALostExchangeTheStatusIsAPlainRead)
{
  VirtualBus bus(BLOCK);
  settle(bus);
  bus.stream(0, 20.0, 0.1, 10.0);
  bus.run(3.0);
  bus.world("pump lost_reply count 1");
  bus.runUntil(1.0, [&] { return bus.line().counters().timeouts > 0; });
  bus.clearFrames();
  bus.runUntil(2.0, [&] { return !bus.requests().empty() && bus.count("01 03 18 75") + bus.count("01 17") > 0; });
  EXPECT_EQ(bus.count("01 17"), 0U);
}

TEST(Toshiba, aBrownOutWhileItRunsLocksItAndNothingGivesRunBack)
{
  for (const char* duration : { "0.02", "0.3", "2.0" })
  {
    VirtualBus bus(BLOCK);
    settle(bus);
    bus.stream(0, 20.0, 0.1, 10.0);
    bus.run(3.0);
    bus.world(std::string("pump power_cycle ") + duration);
    // Not one frame with RUN may reach the drive once it listens again.
    bus.run(0.05);
    bus.clearFrames();
    bus.run(6.0);
    EXPECT_EQ(runFrames(bus), 0U) << duration;
    EXPECT_EQ(bus.motor("pump", "frequency"), 0.0) << duration;
    EXPECT_TRUE(bus.status(0).locked) << duration;
  }
}

TEST(Toshiba, aBrownOutUnderAChangingVelocityGivesNoRunBackEither)
{
  for (const char* yaml : { BLOCK, DIRECT })
  {
    for (const char* harm : { "power_cycle 0.02", "power_cycle 0.3", "power_cycle 2.0", "sto on" })
    {
      VirtualBus bus(yaml);
      settle(bus);
      for (int i = 0; i < 100; ++i)
      {
        bus.at(0.1 * i, [&bus, i] { bus.command(0, 10.0 + 0.1 * i); });
      }
      bus.run(3.0);
      ASSERT_GT(bus.motor("pump", "frequency"), 0.0);
      bus.world(std::string("pump ") + harm);
      bus.run(0.05);
      bus.clearFrames();
      bus.run(6.0);
      EXPECT_EQ(runFrames(bus), 0U) << harm;
      EXPECT_EQ(bus.motor("pump", "frequency"), 0.0) << harm;
      EXPECT_TRUE(bus.status(0).locked) << harm;
    }
  }
}

TEST(Toshiba, aLostExchangeEndsTheProofOfRunUntilTheDriveHasShownIt)
{
  VirtualBus bus(fedByCommandWord(BLOCK));
  settle(bus);
  bus.stream(0, 20.0, 0.1, 10.0);
  bus.run(3.0);
  bus.world("pump lost_reply count 1");
  bus.runUntil(1.0, [&] { return bus.line().counters().timeouts > 0; });
  bus.clearFrames();
  bus.run(3.0);
  const auto requests = bus.requests();
  const auto repeats = [](const std::string& text) {
    return text.compare(0, 5, "01 17") == 0 || text == "01 06 FA 00 C4 00";
  };
  const auto proof = std::find(requests.begin(), requests.end(), "01 03 FA 00 00 01");
  const auto first = std::find_if(requests.begin(), requests.end(), repeats);
  ASSERT_NE(first, requests.end()) << "the words are repeated again once RUN is proven";
  EXPECT_LT(proof - requests.begin(), first - requests.begin());
  EXPECT_FALSE(bus.status(0).locked);
}

TEST(Toshiba, configureBlockWritesTheSlotsOnceAndThenUsesThem)
{
  std::string yaml = DIRECT;
  yaml.replace(yaml.find("toshiba_vfs15}"), 14, "toshiba_vfs15, configure_block: true}");
  VirtualBus bus(yaml);
  bus.settleIn();
  bus.run(5.0);
  EXPECT_EQ(bus.motor("pump", "eeprom_writes"), 8.0);  // F870, F871, F875-F879, F899
  bus.clearFrames();
  bus.run(1.0);
  EXPECT_GT(bus.count(BLOCK_READ), 10U);
  bus.world("pump power_cycle 1");
  bus.run(10.0);
  EXPECT_EQ(bus.motor("pump", "eeprom_writes"), 8.0);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("EEPROM writes by this node = 8"));
}

TEST(Toshiba, slotsThatAreSetButNotInEffectAreNotBelieved)
{
  VirtualBus bus(DIRECT);
  for (const char* slot : { "F870 1", "F871 3", "F875 1", "F876 2", "F877 3", "F878 4", "F879 14" })
  {
    bus.world(std::string("pump set ") + slot);
  }
  settle(bus);
  bus.run(1.0);
  ASSERT_TRUE(bus.status(0).monitor.ready);
  EXPECT_TRUE(*bus.status(0).monitor.ready);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("not in effect"));
}

TEST(Toshiba, chosenWordsWithoutAStatusFieldShowInDiagnostics)
{
  std::string yaml = BLOCK;
  yaml.replace(yaml.find("toshiba_vfs15}"), 14, "toshiba_vfs15, block_read: [1, 2, 3, 7, 13]}");
  yaml.replace(yaml.find("F878: 4, F879: 14"), 17, "F878: 7, F879: 13");
  VirtualBus bus(yaml);
  settle(bus);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("block read = in use: 1, 2, 3, 7, 13"));
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("peed"));
}

TEST(Toshiba, tripIsShownWithItsReasonAndResetWithoutAReplyIsNoError)
{
  VirtualBus bus(BLOCK);
  settle(bus);
  bus.stream(0, 20.0, 0.1, 30.0);
  bus.run(3.0);
  bus.world("pump trip 16");
  EXPECT_TRUE(bus.runUntil(2.0, [&] { return bus.status(0).monitor.faulted.value_or(false); }));
  EXPECT_EQ(bus.status(0).monitor.fault_code, 16);
  bus.run(1.0);
  bus.clearFrames();
  const std::uint64_t timeouts = bus.line().counters().timeouts;
  const auto answer = bus.wait(bus.reset(0));
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(bus.count(RESET), 1U);
  EXPECT_EQ(bus.line().counters().timeouts, timeouts);
  bus.run(5.0);
  EXPECT_EQ(runFrames(bus), 0U);
  EXPECT_FALSE(bus.status(0).communication_error);
  EXPECT_EQ(bus.status(0).error_id, bus::ERROR_LOCKED) << "the stream went on through all of it";
  EXPECT_EQ(bus.motor("pump", "frequency"), 0.0);
  EXPECT_EQ(bus.line().counters().timeouts, timeouts);
  // The bus has its command back: a closed terminal can't start the motor.
  EXPECT_EQ(bus.count("01 06 FA 00 C0 00"), 1U);
}

TEST(Toshiba, aResetThatGotLostIsSentAgain)
{
  VirtualBus bus(DIRECT);
  settle(bus);
  bus.world("pump trip 16");
  bus.run(2.0);
  bus.clearFrames();
  bus.world("pump lost_request count 1 function 6");
  const auto answer = bus.wait(bus.reset(0));
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(bus.count(RESET), 2U);
  EXPECT_EQ(bus.motor("pump", "tripped"), 0.0);
}

TEST(Toshiba, aLostReplyDoesNotLeaveItUnwatched)
{
  for (const char* yaml : { DIRECT, BLOCK })
  {
    VirtualBus bus(yaml);
    settle(bus);
    bus.world("pump lost_reply count 1 function 3");
    bus.runUntil(2.0, [&] { return bus.line().counters().timeouts > 0; });
    const TimePoint lost = bus.now();
    EXPECT_TRUE(bus.runUntil(0.5, [&] { return bus.status(0).stamp > lost; })) << "rule 3.9 bars one shape only";
  }
}

/// Reads of one word that were asked within a second of one that got no answer.
std::size_t doubtfulReads(const VirtualBus& bus, std::size_t& lost)
{
  using Source = simulation::FrameRecord::Source;
  std::size_t doubtful = 0;
  std::optional<TimePoint> barred_since;
  std::optional<TimePoint> waiting_since;
  for (const simulation::FrameRecord& frame : bus.frames())
  {
    const bool one_word = frame.bytes.size() == 8 && frame.bytes[1] == 0x03 && frame.bytes[5] == 1;
    if (frame.source == Source::Drive)
    {
      waiting_since.reset();
    }
    else if (frame.source == Source::Master)
    {
      lost += waiting_since ? 1 : 0;
      barred_since = waiting_since ? waiting_since : barred_since;
      doubtful += one_word && barred_since && frame.time - *barred_since < seconds(1.0) ? 1 : 0;
      waiting_since = one_word ? std::optional<TimePoint>(frame.time) : std::nullopt;
    }
  }
  return doubtful;
}

TEST(Toshiba, runIsNotReadOffInWhatCouldBeTheReplyToAnotherRead)
{
  // All reads of one word look alike, and this drive has no loop-back to put the line into step.
  VirtualBus bus(DIRECT);
  settle(bus);
  std::size_t lost = 0;
  for (int round = 0; round < 30; ++round)
  {
    bus.command(0, 0.0);
    bus.stream(0, 20.0, 0.1, 1.0);
    bus.run(0.7 + 0.011 * round);
    bus.clearFrames();
    bus.world("pump lost_reply count 1 function 3");
    const std::uint64_t timeouts = bus.line().counters().timeouts;
    ASSERT_TRUE(bus.runUntil(2.0, [&] { return bus.line().counters().timeouts > timeouts; }));
    EXPECT_TRUE(bus.wait(bus.stop(0)).success);
    EXPECT_EQ(bus.motor("pump", "run_command"), 0.0);
    EXPECT_EQ(doubtfulReads(bus, lost), 0U) << "round " << round;
    bus.run(1.5);
  }
  EXPECT_GT(lost, 0U) << "no read of one word was lost: nothing was shown";
}

TEST(Toshiba, aLostSlowValueDelaysNoStatus)
{
  VirtualBus bus(DIRECT);
  settle(bus);
  for (int round = 0; round < 20; ++round)
  {
    // FD18, the temperature or torque: one word, like the RUN command, the marker of a restart and the voltage.
    bus.clearFrames();
    ASSERT_TRUE(bus.runUntil(3.0, [&] { return bus.count(READ_SLOW) > 0; }));
    bus.world("pump lost_reply count 1 function 3");
    bus.runUntil(2.0, [&] { return bus.line().counters().timeouts > static_cast<unsigned>(round); });
    const TimePoint lost = bus.now();
    EXPECT_TRUE(bus.runUntil(0.5, [&] { return bus.status(0).stamp > lost; })) << "round " << round;
    bus.run(0.1 * round);
  }
}

TEST(Toshiba, itsOwnTimeOutNeverPassesWhateverReplyIsLost)
{
  VirtualBus bus(SUPERVISED);
  settle(bus);
  bus.stream(0, 20.0, 0.1, 40.0);
  for (int round = 0; round < 20; ++round)
  {
    bus.run(1.7 + 0.013 * round);
    bus.world("pump lost_reply count 1 function 3");
  }
  EXPECT_EQ(bus.motor("pump", "tripped"), 0.0);
  EXPECT_NEAR(bus.motor("pump", "frequency"), 20.0, 0.01);
}

TEST(Toshiba, itsOwnTimeOutIsMetThoughItWasRefusedForTheMomentAtConnect)
{
  VirtualBus bus(R"(
port: /dev/virtual
baud_rate: 19200
parity: even
interval: 1.4
scan_list:
  - {name: pump, node: 1, drive: toshiba_vfs15}
simulation:
  pump: {parameters: {F803: 1, F804: 2}}
)");
  const std::string reads_delay = "01 03 08 05 00 01";
  ASSERT_TRUE(bus.runUntil(2.0, [&] {
    return !bus.frames().empty() && bus.frames().back().drive == "pump" && bus.requests().back() == reads_delay;
  }));
  bus.world("pump exception 4 count 2");
  bus.run(6.0);
  // It may have tripped before it told.
  bus.wait(bus.reset(0));
  bus.run(60.0);
  EXPECT_EQ(bus.motor("pump", "tripped"), 0.0);
}

TEST(Toshiba, isOfflineSoonAfterItWasSwitchedOff)
{
  VirtualBus bus(DIRECT);
  settle(bus);
  bus.world("pump power off");
  EXPECT_TRUE(bus.runUntil(3.0, [&] { return bus.status(0).communication_error; }));
}

TEST(Toshiba, readsItsEightTripsNewestFirst)
{
  VirtualBus bus(DIRECT);
  settle(bus);
  for (const char* code : { "1", "16", "24" })
  {
    bus.world(std::string("pump trip ") + code);
    bus.run(2.0);
    EXPECT_TRUE(bus.wait(bus.reset(0)).success);
    bus.run(2.0);
  }
  const auto answer = bus.wait(bus.readFaults(0));
  ASSERT_TRUE(answer.success) << answer.message;
  ASSERT_EQ(answer.faults.size(), 3U);
  EXPECT_EQ(answer.faults[0].code, 24);
  EXPECT_EQ(answer.faults[1].code, 16);
  EXPECT_EQ(answer.faults[2].code, 1);
  EXPECT_EQ(answer.present.code, 0);
}

TEST(Toshiba, parametersAreWrittenToTheEepromOnlyWhenTheCallerSaysSo)
{
  VirtualBus bus(DIRECT);
  settle(bus);
  const auto refused = bus.wait(bus.writeParameter(0, "ACC", 5.0, false));
  EXPECT_EQ(refused.error_id, bus::ERROR_NOT_OFFERED);
  EXPECT_EQ(bus.motor("pump", "eeprom_writes"), 0.0);
  const auto written = bus.wait(bus.writeParameter(0, "ACC", 5.0, true));
  EXPECT_TRUE(written.success) << written.message;
  EXPECT_EQ(bus.motor("pump", "eeprom_writes"), 1.0);
  const auto read = bus.wait(bus.readParameter(0, "ACC"));
  EXPECT_DOUBLE_EQ(read.value, 5.0);
  EXPECT_EQ(read.unit, "s");
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("EEPROM writes by this node = 1"));
  bus.stream(0, 20.0, 0.05, 10.0);
  bus.run(10.0);
  EXPECT_EQ(bus.motor("pump", "eeprom_writes"), 1.0);
}

TEST(Toshiba, exceptionsCarryTheDrivesOwnWords)
{
  VirtualBus bus(DIRECT);
  settle(bus);
  bus.stream(0, 20.0, 0.1, 2.0);
  bus.run(1.0);
  const auto answer = bus.wait(bus.writeParameter(0, "FH", 60.0, true));
  EXPECT_FALSE(answer.success);
  const auto missing = bus.wait(bus.readParameter(0, "0x0A00"));
  EXPECT_EQ(missing.error_id, 0x8302) << missing.message;
  EXPECT_THAT(missing.message, HasSubstr("exception 02H"));
}

TEST(Toshiba, anotherBrandAtItsStationGetsNoCommandButAStop)
{
  VirtualBus bus(R"(
port: /dev/virtual
baud_rate: 19200
parity: even
scan_list:
  - {name: pump, node: 1, drive: toshiba_vfs15}
simulation:
  pump: {model: omron_mx2}
)");
  bus.run(3.0);
  bus.clearFrames();
  EXPECT_EQ(bus.command(0, 10.0), bus::ERROR_NOT_ARMED);
  EXPECT_EQ(bus.wait(bus.reset(0)).error_id, bus::ERROR_NOT_ARMED);
  bus.run(1.0);
  EXPECT_EQ(runFrames(bus), 0U);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("wrong drive"));
}

TEST(Toshiba, aLeftoverRunFromTheBusIsClearedAtStartUp)
{
  VirtualBus bus(DIRECT);
  bus.world("bus foreign 01 06 FA 01 07 D0");
  bus.pass(0.5);
  bus.world("bus foreign 01 06 FA 00 C4 00");
  bus.pass(2.0);
  ASSERT_GT(bus.motor("pump", "frequency"), 0.0);
  bus.run(20.0);
  EXPECT_EQ(bus.motor("pump", "frequency"), 0.0);
  EXPECT_EQ(runFrames(bus), 0U);
}

TEST(Toshiba, aDriveThatRunsFromItsPanelIsLeftAlone)
{
  VirtualBus bus(DIRECT);
  bus.world("pump panel 15");
  bus.pass(10.0);
  ASSERT_GT(bus.motor("pump", "frequency"), 0.0);
  bus.run(5.0);
  EXPECT_EQ(bus.count(WRITE_COMMAND), 0U);
  EXPECT_NEAR(bus.motor("pump", "frequency"), 15.0, 0.1);
}

TEST(Toshiba, aTakeoverAtThePanelShows)
{
  VirtualBus bus(DIRECT);
  settle(bus);
  bus.stream(0, 20.0, 0.1, 30.0);
  bus.run(4.0);
  bus.world("pump panel 15");
  EXPECT_TRUE(
      bus.runUntil(12.0, [&] { return bus.diagnostics(0).find("not commanded by the bus") != std::string::npos; }));
}

TEST(Toshiba, aRestartWhileItStandsIsSeenAndTheMarkerWrittenAgain)
{
  VirtualBus bus(DIRECT);
  bus.settleIn();
  bus.run(1.0);
  EXPECT_EQ(bus.motor("pump", "reset_marker"), 1.0);
  bus.world("pump power_cycle 0.02");
  EXPECT_TRUE(bus.runUntil(8.0, [&] { return bus.motor("pump", "reset_marker") == 1.0; }));
  EXPECT_EQ(runFrames(bus), 0U);
}

TEST(Toshiba, anotherCommandSourceShowsOnceACommandIsInForce)
{
  VirtualBus bus(DIRECT);
  settle(bus);
  bus.stream(0, 20.0, 0.1, 12.0);
  bus.run(4.0);
  EXPECT_THAT(bus.diagnostics(0), Not(HasSubstr("not commanded by the bus")));
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("runs on when communication is lost"));
}
}  // namespace
}  // namespace inverter_bus

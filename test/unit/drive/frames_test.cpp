// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Frames as the makers' manuals and traces of real drives print them (without CRC, which belongs to the wire).

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/drive_fixture.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
Parameter parameterOf(const Drive& drive, const std::string& name)
{
  const auto found = drive.findParameter(name, false);
  EXPECT_TRUE(found.has_value()) << name;
  return found.value_or(Parameter());
}

/// The command text of a CompoWay/F request: what stands between the SID and ETX.
std::string text(const wire::Request& request)
{
  return std::string(request.pdu.begin(), request.pdu.end());
}

/// The response text of a CompoWay/F reply: what stands between the end code and ETX.
wire::Bytes response(const std::string& characters)
{
  return wire::Bytes(characters.begin(), characters.end());
}

ProfileChanges overriding(const std::string& yaml)
{
  ProfileChanges changes;
  changes.overrides = overridesOf(yaml);
  return changes;
}

ProfileChanges confirming(const std::vector<std::string>& names)
{
  ProfileChanges changes;
  changes.confirm = names;
  return changes;
}

/// All frames of a sequence.
std::vector<std::string> framesOf(const Drive& drive, const std::string& name, std::uint32_t setpoint = 0)
{
  std::vector<std::string> frames;
  const Sequence* sequence = drive.sequence(name);
  EXPECT_NE(sequence, nullptr) << name;
  for (const Step& step : sequence == nullptr ? std::vector<Step>() : sequence->steps)
  {
    frames.push_back(printed(drive.command(1, step, setpoint)));
  }
  return frames;
}

std::string writeFrame(const Drive& drive, std::uint8_t station, const std::string& name, double value)
{
  const Parameter parameter = parameterOf(drive, name);
  const Encoded encoded = drive.encodeParameter(parameter, value);
  EXPECT_TRUE(encoded.ok) << encoded.error;
  return printed(drive.writeParameter(station, parameter, encoded.raw));
}

TEST(DriveFrames, RunAndStopAreThePrintedCoilWrites)
{
  const Drive drive = shipped("omron_mx2");
  EXPECT_EQ(printed(drive.write(1, "run", 1)), "01 05 00 00 FF 00");
  EXPECT_EQ(printed(drive.write(8, "run", 1)), "08 05 00 00 FF 00");
  EXPECT_EQ(printed(drive.write(8, "run", 0)), "08 05 00 00 00 00");
}

TEST(DriveFrames, ReverseAndTripResetAreThePrintedCoilWrites)
{
  const Drive drive = shipped("omron_mx2");
  EXPECT_EQ(printed(drive.write(1, "direction", 1)), "01 05 00 01 FF 00");
  EXPECT_EQ(printed(drive.write(1, "trip_reset", 1)), "01 05 00 03 FF 00");
  EXPECT_EQ(printed(drive.write(1, "trip_reset", 0)), "01 05 00 03 00 00");
}

TEST(DriveFrames, FrequencyIsATwoWordWriteWithTheHighWordFirst)
{
  const Drive drive = shipped("omron_mx2");
  EXPECT_EQ(printed(drive.write(1, "frequency", drive.frequencyCounts(50.0))), "01 10 00 00 00 02 04 00 00 13 88");
  EXPECT_EQ(printed(drive.write(1, "frequency", 100000)), "01 10 00 00 00 02 04 00 01 86 A0");
}

TEST(DriveFrames, AccelerationTimeOfTenSecondsIsOneThousandCounts)
{
  EXPECT_EQ(writeFrame(shipped("omron_mx2"), 1, "F002", 10.0), "01 10 11 02 00 02 04 00 00 03 E8");
  EXPECT_EQ(writeFrame(shipped("omron_rx"), 1, "F002", 10.0), "01 10 11 02 00 02 04 00 00 03 E8");
}

TEST(DriveFrames, BaseFrequencyCountsTenthsOnTheMx2AndWholeHertzOnTheRx)
{
  EXPECT_EQ(writeFrame(shipped("omron_mx2"), 8, "A003", 50.0), "08 06 12 02 01 F4");
  EXPECT_EQ(writeFrame(shipped("omron_rx"), 5, "A003", 50.0), "05 06 12 02 00 32");
}

TEST(DriveFrames, StoreIsTheEnterCommandAndItsBusyFlagIsCoil0049)
{
  const Drive drive = shipped("omron_mx2");
  const Sequence* store = drive.sequence("store");
  ASSERT_NE(store, nullptr);
  ASSERT_EQ(store->steps.size(), 1U);
  EXPECT_EQ(printed(drive.write(8, store->steps[0].point, *store->steps[0].value)), "08 06 08 FF 00 01");
  ASSERT_TRUE(drive.readStoreBusy(1).has_value());
  EXPECT_EQ(printed(*drive.readStoreBusy(1)), "01 01 00 48 00 01");
  EXPECT_TRUE(drive.decodeStoreBusy(bytes("01 01 01")));
  EXPECT_FALSE(drive.decodeStoreBusy(bytes("01 01 00")));
}

TEST(DriveFrames, LoopBackEchoesTheNumberItIsGiven)
{
  const auto request = shipped("omron_mx2").loopback(1, 0x01F4);
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(printed(*request), "01 08 00 00 01 F4");
}

TEST(DriveFrames, ATripBlockIsOneReadOnTheMx2)
{
  const Drive drive = shipped("omron_mx2");
  const auto blocks = drive.faultReads(0);
  ASSERT_EQ(blocks.size(), 1U);
  EXPECT_EQ(printed(drive.read(1, blocks[0])), "01 03 00 11 00 0A");
}

TEST(DriveFrames, WattHoursReadAsTheTwoWordsOfARealDrive)
{
  const Drive drive = shipped("omron_mx2");
  const Parameter watt_hours = parameterOf(drive, "d015");
  EXPECT_EQ(printed(drive.readParameter(1, watt_hours)), "01 03 10 12 00 02");
  EXPECT_DOUBLE_EQ(drive.decodeParameter(watt_hours, bytes("03 04 00 04 93 E0")), 30000.0);
}

TEST(DriveFrames, NobodyAnswersABroadcast)
{
  const wire::Request request = shipped("omron_mx2").broadcast("run", 0);
  EXPECT_EQ(printed(request), "00 05 00 00 00 00");
  EXPECT_TRUE(request.broadcast);
  EXPECT_FALSE(request.expects_reply);
}

TEST(DriveFrames, StationZeroAloneMakesNoBroadcast)
{
  const wire::Request request = shipped("omron_mx2").write(0, "run", 0);
  EXPECT_EQ(printed(request), "00 05 00 00 00 00");
  EXPECT_FALSE(request.broadcast);
  EXPECT_TRUE(request.expects_reply) << "a drive with a port of its own may have this number";
}

TEST(DriveFrames, AnOrdinaryRequestExpectsAReply)
{
  const wire::Request request = shipped("omron_mx2").write(3, "run", 0);
  EXPECT_FALSE(request.broadcast);
  EXPECT_TRUE(request.expects_reply);
}

TEST(DriveFrames, ADriveWithoutFunction05And06UsesTheLongerOnes)
{
  const std::string text = replaced(smallProfile(), "[1, 3, 5, 6, 16]", "[1, 3, 0x0F, 0x10]");
  const Drive drive(ProfileFile(text).load());
  EXPECT_EQ(printed(drive.write(2, "run", 1)), "02 0F 00 00 00 01 01 01");
  EXPECT_EQ(printed(drive.write(2, "run", 0)), "02 0F 00 00 00 01 01 00");
  EXPECT_EQ(printed(drive.write(2, "frequency", 0x1388)), "02 10 00 00 00 01 02 13 88");
  EXPECT_FALSE(drive.loopback(2, 1).has_value());
}

TEST(DriveFrames, AnUnknownPointGivesAnEmptyRequest)
{
  EXPECT_TRUE(shipped("omron_mx2").write(1, "no_such_point", 1).pdu.empty());
}

TEST(DriveFrames, SetPointIsRoundedToTheNearestCount)
{
  const Drive drive = shipped("omron_mx2");
  EXPECT_DOUBLE_EQ(drive.frequencyResolution(), 0.01);
  EXPECT_EQ(drive.frequencyCounts(0.0), 0U);
  EXPECT_EQ(drive.frequencyCounts(0.004), 0U);
  EXPECT_EQ(drive.frequencyCounts(0.006), 1U);
  EXPECT_EQ(drive.frequencyCounts(49.999), 5000U);
  EXPECT_EQ(drive.frequencyCounts(0.29), 29U);
  EXPECT_EQ(drive.frequencyCounts(400.0), 40000U);
}

// --- Toshiba VF-S15: E6581913, pages 26 to 38 ---------------------------------------------------------------------------
TEST(ToshibaFrames, BlockReadOfFiveAndOfTwoWords)
{
  const Drive drive = shipped("toshiba_vfs15");
  const auto five = drive.chosenRead({ 1, 2, 3, 4, 5 });
  ASSERT_TRUE(five.has_value());
  EXPECT_EQ(printed(drive.read(1, *five)), "01 03 18 75 00 05");
  const auto two = drive.chosenRead({ 1, 2, 0, 0, 0 });
  ASSERT_TRUE(two.has_value());
  EXPECT_EQ(printed(drive.read(1, *two)), "01 03 18 75 00 02");
  // Two is the least that the drive brings, even if only one is wanted; more than five it refuses.
  const auto one = drive.chosenRead({ 2 });
  ASSERT_TRUE(one.has_value());
  EXPECT_EQ(printed(drive.read(1, *one)), "01 03 18 75 00 02");
  const auto seven = drive.chosenRead({ 1, 2, 3, 4, 5, 12, 14 });
  ASSERT_TRUE(seven.has_value());
  EXPECT_EQ(printed(drive.read(1, *seven)), "01 03 18 75 00 05");
  EXPECT_FALSE(drive.chosenRead({ 0, 0, 0, 0, 0 }).has_value());
  EXPECT_FALSE(drive.chosenRead({ 1, 2, 15 }).has_value());
  EXPECT_FALSE(drive.chosenRead({ 1, -1 }).has_value());
}

TEST(ToshibaFrames, BlockWriteOfForwardAndSixtyHertz)
{
  const Drive drive = shipped("toshiba_vfs15");
  const std::vector<Word> words = { { "frequency", drive.frequencyCounts(60.0) }, { "command", 0xC400 } };
  ASSERT_TRUE(drive.fitsBlockWrite(words));
  EXPECT_EQ(printed(drive.writeChosen(1, words)), "01 10 18 70 00 02 04 C4 00 17 70");
}

TEST(ToshibaFrames, WriteAndReadInOneFrame)
{
  const Drive drive = shipped("toshiba_vfs15");
  const std::vector<Word> words = { { "command", 0xC400 }, { "frequency", 6000 } };
  const auto block = drive.chosenRead({ 1, 2, 3, 4, 14 });
  ASSERT_TRUE(block.has_value());
  EXPECT_EQ(printed(drive.writeAndRead(1, words, *block)), "01 17 18 75 00 05 18 70 00 02 04 C4 00 17 70");
}

TEST(ToshibaFrames, OnlyBothCommandWordsFitTheBlockWrite)
{
  const Drive drive = shipped("toshiba_vfs15");
  EXPECT_FALSE(drive.fitsBlockWrite({ { "command", 0xC400 } }));
  EXPECT_FALSE(drive.fitsBlockWrite({ { "command", 0xC400 }, { "restart_marker", 1 } }));
  EXPECT_FALSE(drive.fitsBlockWrite({ { "command", 0xC400 }, { "frequency", 1 }, { "restart_marker", 1 } }));
  EXPECT_FALSE(shipped("omron_mx2").fitsBlockWrite({ { "run", 1 }, { "frequency", 1 } }));
}

TEST(ToshibaFrames, CommandsAreTheWordsOfThePrintedTable)
{
  const Drive drive = shipped("toshiba_vfs15");
  using testing::ElementsAre;
  EXPECT_THAT(framesOf(drive, "forward", 6000), ElementsAre("01 06 FA 01 17 70", "01 06 FA 00 C4 00"));
  EXPECT_THAT(framesOf(drive, "reverse", 6000), ElementsAre("01 06 FA 01 17 70", "01 06 FA 00 C6 00"));
  EXPECT_THAT(framesOf(drive, "stop"), ElementsAre("01 06 FA 00 C0 00"));
  EXPECT_THAT(framesOf(drive, "coast"), ElementsAre("01 06 FA 00 C8 00"));
  EXPECT_THAT(framesOf(drive, "release"), ElementsAre("01 06 FA 00 00 00"));
  EXPECT_THAT(framesOf(drive, "connect"), ElementsAre("01 06 FA 87 00 01"));
  ASSERT_FALSE(framesOf(drive, "reset").empty());
  EXPECT_EQ(framesOf(drive, "reset").front(), "01 06 FA 00 E0 00");
}

TEST(ToshibaFrames, TheResetExpectsNoReplyAndAllOthersDo)
{
  const Drive drive = shipped("toshiba_vfs15");
  const Sequence* reset = drive.sequence("reset");
  ASSERT_NE(reset, nullptr);
  EXPECT_FALSE(drive.command(1, reset->steps.front()).expects_reply);
  EXPECT_FALSE(drive.command(1, reset->steps.front()).broadcast);
  for (const char* name : { "forward", "reverse", "stop", "coast", "release", "connect" })
  {
    for (const Step& step : drive.sequence(name)->steps)
    {
      EXPECT_TRUE(drive.command(1, step).expects_reply) << name;
    }
  }
}

TEST(ToshibaFrames, NoSequenceTripsTheDriveOrGivesItsPriorityAwayUnasked)
{
  const Drive drive = shipped("toshiba_vfs15");
  for (const char* name : { "forward", "reverse", "stop", "coast", "reset" })
  {
    for (const Step& step : drive.sequence(name)->steps)
    {
      if (step.point == "command")
      {
        EXPECT_EQ(*step.value & 0x1000U, 0U) << name << ": the emergency stop trips";
        EXPECT_EQ(*step.value & 0xC000U, 0xC000U) << name;
      }
    }
  }
}

TEST(ToshibaFrames, SixtyHertzToFA01AndReadsOfSingleRegisters)
{
  const Drive drive = shipped("toshiba_vfs15");
  EXPECT_EQ(printed(drive.write(1, "frequency", drive.frequencyCounts(60.0))), "01 06 FA 01 17 70");
  const auto fd00 = drive.findParameter("0xFD00", false);
  ASSERT_TRUE(fd00.has_value());
  EXPECT_EQ(printed(drive.readParameter(1, *fd00)), "01 03 FD 00 00 01");
  const Parameter timeout = parameterOf(drive, "F803");
  EXPECT_EQ(printed(drive.readParameter(1, timeout)), "01 03 08 03 00 01");
  EXPECT_EQ(writeFrame(drive, 1, "F803", 6.0), "01 06 08 03 00 3C");
}

TEST(ToshibaFrames, ItsStatusIsOneDirectReadWithoutTheBlock)
{
  const Drive drive = shipped("toshiba_vfs15");
  ASSERT_EQ(drive.fastBlocks().size(), 1U);
  EXPECT_EQ(printed(drive.read(1, drive.fastBlocks()[0])), "01 03 FD 00 00 04");
  EXPECT_EQ(drive.loopback(1, 1), std::nullopt) << "p25: no 08H";
}

TEST(ToshibaFrames, TheBlockOfTheManualIsDecoded)
{
  const Drive drive = shipped("toshiba_vfs15");
  const auto block = drive.chosenRead({ 1, 2, 3, 4, 5 });
  ASSERT_TRUE(block.has_value());
  Monitor monitor;
  drive.decode(*block, bytes("03 0A E4 04 17 70 00 00 26 FF 00 80"), monitor, Ratings{ 4.8, 200.0 });
  // p59: bit 15 is undefined, and set in this very example. Bits 14, 13, 10, 2: ready, ready with RUN, running, alarm.
  EXPECT_EQ(monitor.raw_status, 0x6404U);
  EXPECT_EQ(monitor.running, true);
  EXPECT_EQ(monitor.operation, true);
  EXPECT_EQ(monitor.direction, 1);
  EXPECT_EQ(monitor.ready, true);
  EXPECT_EQ(monitor.faulted, false);
  EXPECT_DOUBLE_EQ(monitor.output_frequency.value_or(-1.0), 60.0);
  EXPECT_DOUBLE_EQ(monitor.output_current.value_or(-1.0), 0.0);
  EXPECT_NEAR(monitor.output_voltage.value_or(-1.0), 199.66, 1e-9);
  EXPECT_EQ(monitor.warning_code, 0x0080U);
  EXPECT_EQ(monitor.overload_warning, false);
  EXPECT_EQ(drive.warningText(0x0080), "low current");
  EXPECT_FALSE(monitor.torque.has_value());
  EXPECT_FALSE(monitor.restarted.has_value());
}

TEST(ToshibaFrames, TheReplyOf17HIsDecodedLikeThatOf03H)
{
  const Drive drive = shipped("toshiba_vfs15");
  const auto block = drive.chosenRead({ 1, 2, 3, 4, 14 });
  Monitor monitor;
  drive.decode(*block, bytes("17 0A 66 00 0B B8 13 88 13 88 FC 18"), monitor, Ratings{ 4.8, 200.0 });
  EXPECT_EQ(monitor.direction, -1);
  EXPECT_DOUBLE_EQ(monitor.output_frequency.value_or(-1.0), 30.0);
  EXPECT_NEAR(monitor.output_current.value_or(-1.0), 2.4, 1e-9);  // p56: 4.8 A drive, 5000
  EXPECT_NEAR(monitor.output_voltage.value_or(-1.0), 100.0, 1e-9);
  EXPECT_NEAR(monitor.torque.value_or(1.0), -10.0, 1e-9);  // two's complement: p68
}

TEST(ToshibaFrames, WithoutARatingPercentIsNoAmpere)
{
  const Drive drive = shipped("toshiba_vfs15");
  const auto block = drive.chosenRead({ 1, 2, 3, 4, 5 });
  Monitor monitor;
  drive.decode(*block, bytes("03 0A 64 00 17 70 13 88 26 FF 00 00"), monitor);
  EXPECT_DOUBLE_EQ(monitor.output_frequency.value_or(-1.0), 60.0);
  EXPECT_FALSE(monitor.output_current.has_value());
  EXPECT_FALSE(monitor.output_voltage.has_value());
}

TEST(ToshibaFrames, StatusWordsOfTheManual)
{
  const Drive drive = shipped("toshiba_vfs15");
  const ReadBlock block = drive.blockOf({ "raw_status", "running", "direction", "faulted", "ready" });
  struct Case
  {
    const char* reply;
    bool running;
    int direction;
    bool faulted;
    bool ready;
  };
  // p15, p23: idle, forward, reverse, tripped; with and without the undefined bit 15.
  for (const Case& word :
       { Case{ "03 02 40 00", false, 0, false, true }, Case{ "03 02 64 00", true, 1, false, true },
         Case{ "03 02 66 00", true, -1, false, true }, Case{ "03 02 00 03", false, 0, true, false },
         Case{ "03 02 C0 00", false, 0, false, true }, Case{ "03 02 42 00", false, 0, false, true } })
  {
    Monitor monitor;
    drive.decode(block, bytes(word.reply), monitor);
    EXPECT_EQ(monitor.running, word.running) << word.reply;
    EXPECT_EQ(monitor.direction, word.direction) << word.reply;
    EXPECT_EQ(monitor.faulted, word.faulted) << word.reply;
    EXPECT_EQ(monitor.ready, word.ready) << word.reply;
    EXPECT_EQ(monitor.raw_status.value_or(0xFFFF) & 0x8000U, 0U) << word.reply;
  }
}

TEST(ToshibaFrames, AnUnselectedSlotOfTheBlockTellsNothing)
{
  const Drive drive = shipped("toshiba_vfs15");
  const auto block = drive.chosenRead({ 0, 2, 0, 0, 0 });
  ASSERT_TRUE(block.has_value());
  Monitor monitor;
  drive.decode(*block, bytes("03 04 00 00 17 70"), monitor);  // p28: F875 = 0
  EXPECT_DOUBLE_EQ(monitor.output_frequency.value_or(-1.0), 60.0);
  EXPECT_FALSE(monitor.raw_status.has_value());
  EXPECT_FALSE(monitor.running.has_value());
}

TEST(ToshibaFrames, WhatTheBlockBringsBesidesTheStatusHasItsTitle)
{
  const Drive drive = shipped("toshiba_vfs15");
  const auto block = drive.chosenRead({ 1, 2, 7, 10, 13 });
  ASSERT_TRUE(block.has_value());
  const auto values = drive.chosenValues(*block, bytes("03 0A 64 00 17 70 00 05 D8 F0 07 08"), Ratings());
  using testing::Pair;
  // p27, p57, p71: terminals F and RES, VIB at -100 %, motor speed in min-1.
  EXPECT_THAT(values, testing::UnorderedElementsAre(Pair("input terminals", "5"), Pair("analog input VIB", "-100 %"),
                                                    Pair("motor speed", "1800 rpm")));
}

TEST(ToshibaFrames, TheHoleOfTheManualsDirectReadIsNotTold)
{
  std::string text =
      replaced(smallProfile(), "{register_offset: -1, coil_offset: -1}", "{register_offset: 0, decimal: true}");
  text = replaced(text, "  read_coils: 16", "  read_coils: 16\n  hole: 0x8000");
  text = replaced(text, "[[0x0100, 0x0120]]", "[[0x0130, 0x0134]]");
  text = replaced(text, "  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n",
                  "  output_frequency: {register: 0x0130}\n  output_current: {register: 0x0132}\n"
                  "  output_voltage: {register: 0x0133}\n  torque: {register: 0x0134, signed: true}\n");
  const Drive drive(ProfileFile(text).load());
  ASSERT_FALSE(drive.fastBlocks().empty());
  const ReadBlock& block = drive.fastBlocks().back();             // after the coils
  EXPECT_EQ(printed(drive.read(1, block)), "01 03 01 30 00 05");  // p30
  Monitor monitor;
  drive.decode(block, bytes("03 0A 00 04 00 06 00 0A 80 00 80 00"), monitor);
  EXPECT_DOUBLE_EQ(monitor.output_frequency.value_or(-1.0), 4.0);
  EXPECT_DOUBLE_EQ(monitor.output_current.value_or(-1.0), 10.0);
  EXPECT_FALSE(monitor.output_voltage.has_value());
  EXPECT_FALSE(monitor.torque.has_value());
}

TEST(ToshibaFrames, InAReadOfOneRegister8000HIsAValue)
{
  std::string text = replaced(smallProfile(), "  read_coils: 16", "  read_coils: 16\n  hole: 0x8000");
  text = replaced(text, "  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n",
                  "  torque: {register: 0x0134, signed: true}\n");
  const Drive drive(ProfileFile(text).load());
  Monitor monitor;
  drive.decode(drive.fastBlocks().back(), bytes("03 02 80 00"), monitor);
  EXPECT_DOUBLE_EQ(monitor.torque.value_or(0.0), -32768.0);
}

// --- TECO 7200MA: application manual, table 1; the bits of 0000H are those that the user has confirmed --------------------
TEST(TecoFrames, RunStopAndFrequency)
{
  const Drive drive = shipped("teco_7200ma", confirming({ "run_forward", "frequency_scale", "fault_reset" }));
  using testing::ElementsAre;
  EXPECT_THAT(framesOf(drive, "forward", drive.frequencyCounts(50.0)),
              ElementsAre("01 10 00 01 00 01 02 13 88", "01 10 00 00 00 01 02 00 01"));
  EXPECT_THAT(framesOf(drive, "stop"), ElementsAre("01 10 00 00 00 01 02 00 00"));
  // Reset is a level: taken back, so that it doesn't stand there at the next start.
  EXPECT_THAT(framesOf(drive, "reset"), ElementsAre("01 10 00 00 00 01 02 00 08", "01 10 00 00 00 01 02 00 00"));
}

TEST(TecoFrames, OtherStationsAndTheBroadcastStop)
{
  const Drive drive = shipped("teco_7200ma");
  EXPECT_EQ(printed(drive.write(31, "command", 1)), "1F 10 00 00 00 01 02 00 01");
  const wire::Request broadcast = drive.broadcast("command", 0);
  EXPECT_EQ(printed(broadcast), "00 10 00 00 00 01 02 00 00");
  EXPECT_FALSE(broadcast.expects_reply);
}

TEST(TecoFrames, ReadOfOneRegisterAndTheLoopTest)
{
  const Drive drive = shipped("teco_7200ma");
  ASSERT_EQ(drive.fastBlocks().size(), 1U);
  EXPECT_EQ(printed(drive.read(1, drive.fastBlocks()[0])), "01 03 00 00 00 01");  // p8
  EXPECT_EQ(printed(drive.read(31, drive.fastBlocks()[0])), "1F 03 00 00 00 01");
  const auto loop = drive.loopback(1, 0xAA55);
  ASSERT_TRUE(loop.has_value());
  EXPECT_EQ(printed(*loop), "01 08 00 00 AA 55");  // p9
}

TEST(TecoFrames, TheKeepAliveTellsNothing)
{
  const Drive drive = shipped("teco_7200ma");
  Monitor monitor;
  drive.decode(drive.fastBlocks().at(0), bytes("03 02 00 01"), monitor);
  EXPECT_FALSE(monitor.running.has_value());
  EXPECT_FALSE(monitor.raw_status.has_value());
  EXPECT_FALSE(monitor.output_frequency.has_value());
}

TEST(TecoFrames, MonitorsOfItsRelativesAtTheBaseOfTheUser)
{
  ProfileChanges changes = overriding("{monitor_base: 0x0020, spans: {registers: [[0x0020, 0x0027]]}}");
  changes.confirm = { "monitor_layout", "fault_coding" };
  const Drive drive = shipped("teco_7200ma", changes);
  ASSERT_EQ(drive.fastBlocks().size(), 1U);
  EXPECT_EQ(printed(drive.read(3, drive.fastBlocks()[0])), "03 03 00 20 00 08");
  Monitor monitor;
  // Status run + reverse + ready, no fault, link, command 30 Hz, output 25 Hz, 115.0 V, 310 V, 2.1 A (7300CV, L510).
  drive.decode(drive.fastBlocks()[0], bytes("03 10 00 07 00 00 00 00 0B B8 09 C4 04 7E 01 36 00 15"), monitor);
  EXPECT_EQ(monitor.raw_status, 7U);
  EXPECT_EQ(monitor.running, true);
  EXPECT_EQ(monitor.direction, -1);
  EXPECT_EQ(monitor.ready, true);
  EXPECT_EQ(monitor.faulted, false);
  EXPECT_DOUBLE_EQ(monitor.output_frequency.value_or(-1.0), 25.0);
  EXPECT_NEAR(monitor.output_current.value_or(-1.0), 2.1, 1e-9);
}

// --- OMRON 3G3JE: I548 and the golden frames of its relatives -------------------------------------------------------------
TEST(CompowayFrames, ReadsOfVariables)
{
  const Drive drive = shipped("omron_3g3je");
  const auto& blocks = drive.fastBlocks();
  ASSERT_EQ(blocks.size(), 2U);
  EXPECT_EQ(text(drive.read(1, blocks[0])), "0101C00001000001");
  EXPECT_EQ(text(drive.read(1, blocks[1])), "0601");
  const Drive two = shipped("omron_3g3je", confirming({ "current_scale" }));
  EXPECT_EQ(text(two.read(1, two.fastBlocks().at(0))), "0101C00001000002");
  EXPECT_EQ(drive.read(99, blocks[0]).station, 99);
  EXPECT_EQ(text(drive.readParameter(99, parameterOf(drive, "P12"))), "0101C3000B000001");
}

TEST(CompowayFrames, WritesOfTheFrequency)
{
  const Drive drive = shipped("omron_3g3je");
  EXPECT_EQ(text(drive.write(1, "frequency", drive.frequencyCounts(30.0))), "0102C100000000010000012C");
  EXPECT_EQ(text(drive.write(1, "frequency", drive.frequencyCounts(120.0))), "0102C10000000001000004B0");
  EXPECT_TRUE(drive.write(0, "frequency", 0).expects_reply) << "0 is a station like any other; XX is the broadcast";
  EXPECT_TRUE(drive.wears("frequency"));
  EXPECT_FALSE(drive.wears("operate"));
}

TEST(CompowayFrames, OperationsCarryTheCodeOfTheUser)
{
  // Codes of a temperature controller (G3ZA): the framing is golden, their meaning in a 3G3JE is not known.
  const Drive drive = shipped("omron_3g3je", overriding("operation_codes: {run_forward: \"0100\", stop: \"0101\", "
                                                        "ram_write_mode: \"0401\"}"));
  ASSERT_NE(drive.sequence("forward"), nullptr);
  ASSERT_EQ(drive.sequence("forward")->steps.size(), 2U);
  EXPECT_EQ(text(drive.command(1, drive.sequence("forward")->steps[0], 300)), "0102C100000000010000012C");
  EXPECT_EQ(text(drive.command(1, drive.sequence("forward")->steps[1])), "30050100");
  EXPECT_EQ(text(drive.command(1, drive.sequence("stop")->steps.at(0))), "30050101");
  EXPECT_EQ(text(drive.command(1, drive.sequence("connect")->steps.at(0))), "30050401");
}

TEST(CompowayFrames, AttributesAndEchoback)
{
  const Drive drive = shipped("omron_3g3je");
  ASSERT_TRUE(drive.readAttributes(1).has_value());
  EXPECT_EQ(text(*drive.readAttributes(1)), "0503");
  EXPECT_EQ(drive.decodeModel(response("050300003G3JE202BF0028")), "3G3JE202BF");
  EXPECT_EQ(drive.decodeModel(response("05030000G3PW      00D9")), "G3PW");
  EXPECT_EQ(drive.decodeModel(response("0503")), "");
  ASSERT_TRUE(drive.loopback(1, 0x0123).has_value());
  EXPECT_EQ(text(*drive.loopback(1, 0x0123)), "08010123");
  EXPECT_FALSE(shipped("omron_mx2").readAttributes(1).has_value());
}

TEST(CompowayFrames, RepliesOfVariables)
{
  const Drive drive = shipped("omron_3g3je", confirming({ "current_scale" }));
  const ReadBlock frequency = drive.blockOf({ "output_frequency" });
  const ReadBlock both = drive.fastBlocks().at(0);
  Monitor monitor;
  drive.decode(frequency, response("01010000000001F4"), monitor);
  EXPECT_DOUBLE_EQ(monitor.output_frequency.value_or(-1.0), 50.0);
  EXPECT_FALSE(monitor.output_current.has_value());
  drive.decode(both, response("010100000000012C0000000A"), monitor);
  EXPECT_DOUBLE_EQ(monitor.output_frequency.value_or(-1.0), 30.0);
  EXPECT_DOUBLE_EQ(monitor.output_current.value_or(-1.0), 1.0);
  for (const char* small : { "0101000000000000", "0101000000000001", "0101000000000002" })
  {
    drive.decode(frequency, response(small), monitor);
    EXPECT_NEAR(monitor.output_frequency.value_or(-1.0), 0.1 * (small[15] - '0'), 1e-9) << small;
  }
}

TEST(CompowayFrames, ANegativeNumberIsTwosComplementOf32Bits)
{
  const Drive drive(ProfileFile(smallCompowayProfile()).load());
  Monitor monitor;
  drive.decode(drive.blockOf({ "torque" }), response("01010000FFFFFFFF"), monitor);
  EXPECT_NEAR(monitor.torque.value_or(1.0), -0.1, 1e-9);
}

TEST(CompowayFrames, ABitOfAVariableCountsFromTheLowestEnd)
{
  const Drive drive(ProfileFile(smallCompowayProfile()).load());
  Monitor monitor;
  drive.decode(drive.blockOf({ "faulted" }), response("0101000000000080"), monitor);
  EXPECT_EQ(monitor.faulted, true);
  drive.decode(drive.blockOf({ "faulted" }), response("01010000FFFFFF7F"), monitor);
  EXPECT_EQ(monitor.faulted, false);
}

TEST(CompowayFrames, ControllerStatus)
{
  const Drive drive = shipped("omron_3g3je", confirming({ "controller_status_meaning" }));
  const ReadBlock block = drive.blockOf({ "raw_status", "running" });
  Monitor monitor;
  drive.decode(block, response("060100000000"), monitor);
  EXPECT_EQ(monitor.raw_status, 0U);
  EXPECT_EQ(monitor.running, true);  // E5 family: 00, control is performed
  drive.decode(block, response("060100000100"), monitor);
  EXPECT_EQ(monitor.raw_status, 0x0100U);
  EXPECT_EQ(monitor.running, false);
  drive.decode(block, response("060100000200"), monitor);
  EXPECT_FALSE(monitor.running.has_value()) << "a value that no manual has";
}

TEST(CompowayFrames, AReplyOfAnotherServiceOrTooShortTellsNothing)
{
  const Drive drive = shipped("omron_3g3je");
  const ReadBlock block = drive.blockOf({ "output_frequency" });
  for (const char* reply : { "01020000", "01010000", "010100000000", "0101000000000x1F", "" })
  {
    Monitor monitor;
    drive.decode(block, response(reply), monitor);
    EXPECT_FALSE(monitor.output_frequency.has_value()) << reply;
  }
}

TEST(CompowayFrames, ParametersAreReadAndWrittenAsElements)
{
  const Drive drive = shipped("omron_3g3je");
  EXPECT_EQ(text(drive.readParameter(1, parameterOf(drive, "P06"))), "0101C30005000001");
  const Parameter limit = parameterOf(drive, "P07");
  const Encoded encoded = drive.encodeParameter(limit, 60.0);
  ASSERT_TRUE(encoded.ok) << encoded.error;
  EXPECT_EQ(text(drive.writeParameter(1, limit, encoded.raw)), "0102C3000600000100000258");
  EXPECT_DOUBLE_EQ(drive.decodeParameter(limit, response("0101000000000258")), 60.0);
  EXPECT_TRUE(limit.setup);
}
}  // namespace
}  // namespace drive
}  // namespace inverter_bus

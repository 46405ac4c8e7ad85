// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What replies of a drive mean.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/drive_fixture.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
using testing::Eq;
using testing::Optional;

constexpr std::size_t COILS = 0;

Monitor decoded(const Drive& drive, const ReadBlock& block, const std::string& reply)
{
  Monitor monitor;
  drive.decode(block, bytes(reply), monitor);
  return monitor;
}

/// The monitor after one status line and one reply with this word.
Monitor decodedWord(const std::string& item, const std::string& reply)
{
  const std::string old = "  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n";
  const Drive drive(ProfileFile(replaced(smallProfile(), old, "  " + item + "\n")).load());
  return decoded(drive, drive.fastBlocks().back(), reply);
}

TEST(DriveStatus, TheCoilsOfAnMx2GiveTheBitsOfTheStatusWord)
{
  const Drive drive = shipped("omron_mx2");
  // Coils 0001h RUN, 000Fh operation, 0011h ready, 0013h running, 0014h at speed, 0016h overload warning.
  const Monitor monitor = decoded(drive, drive.fastBlocks()[COILS], "01 03 01 40 2D");
  EXPECT_THAT(monitor.run_seen, Optional(true));
  EXPECT_THAT(monitor.operation, Optional(true));
  EXPECT_THAT(monitor.ready, Optional(true));
  EXPECT_THAT(monitor.running, Optional(true));
  EXPECT_THAT(monitor.at_speed, Optional(true));
  EXPECT_THAT(monitor.at_set_frequency, Optional(false));
  EXPECT_THAT(monitor.overload_warning, Optional(true));
  EXPECT_THAT(monitor.pid_deviation, Optional(false));
  EXPECT_THAT(monitor.faulted, Optional(false));
  EXPECT_THAT(monitor.raw_status, Optional(Eq(0x2D4001U)));
}

TEST(DriveStatus, EveryStatusBitOfAnMx2HasItsOwnCoil)
{
  const Drive drive = shipped("omron_mx2");
  const ReadBlock& block = drive.fastBlocks()[COILS];
  EXPECT_THAT(decoded(drive, block, "01 03 00 40 00").operation, Optional(true));
  EXPECT_THAT(decoded(drive, block, "01 03 00 00 01").ready, Optional(true));
  EXPECT_THAT(decoded(drive, block, "01 03 00 00 04").running, Optional(true));
  EXPECT_THAT(decoded(drive, block, "01 03 00 00 08").at_speed, Optional(true));
  EXPECT_THAT(decoded(drive, block, "01 03 00 00 10").at_set_frequency, Optional(true));
  EXPECT_THAT(decoded(drive, block, "01 03 00 00 20").overload_warning, Optional(true));
  EXPECT_THAT(decoded(drive, block, "01 03 00 00 40").pid_deviation, Optional(true));
  EXPECT_THAT(decoded(drive, block, "01 03 00 00 80").faulted, Optional(true));
}

TEST(DriveStatus, FrequencyCurrentAndDirectionOfAnMx2ComeInOneReply)
{
  const Drive drive = shipped("omron_mx2");
  const Monitor monitor = decoded(drive, drive.fastBlocks()[1], "03 08 00 00 13 88 01 F3 00 02");
  EXPECT_THAT(monitor.output_frequency, Optional(50.0));
  EXPECT_THAT(monitor.output_current, Optional(4.99));
  EXPECT_THAT(monitor.direction, Optional(-1));
}

TEST(DriveStatus, AFrequencyBeyondSixteenBitsIsWhole)
{
  const Drive drive = shipped("omron_mx2");
  EXPECT_THAT(decoded(drive, drive.fastBlocks()[1], "03 08 00 01 86 A0 00 00 00 01").output_frequency,
              Optional(1000.0));
}

TEST(DriveStatus, TorqueAndTemperatureAreSigned)
{
  const Drive drive = shipped("omron_mx2");
  const Monitor monitor =
      decoded(drive, drive.slowBlocks()[1], "03 14 FF CE 09 C4 00 00 00 00 00 00 00 00 00 00 00 00 00 00 FF 38");
  EXPECT_THAT(monitor.torque, Optional(-50.0));
  EXPECT_THAT(monitor.output_voltage, Optional(250.0));
  EXPECT_THAT(monitor.temperature, Optional(-20.0));
  EXPECT_FALSE(monitor.dc_voltage.has_value());
}

TEST(DriveStatus, AnUnknownDirectionIsNotKnown)
{
  const Drive drive = shipped("omron_mx2");
  EXPECT_FALSE(decoded(drive, drive.fastBlocks()[1], "03 08 00 00 00 00 00 00 00 07").direction.has_value());
}

TEST(DriveStatus, ATripOfAnRxShowsInStatusB)
{
  const Drive drive = shipped("omron_rx");
  const ReadBlock& block = drive.fastBlocks()[1];
  EXPECT_THAT(decoded(drive, block, "03 02 00 00").faulted, Optional(false));
  EXPECT_THAT(decoded(drive, block, "03 02 00 01").faulted, Optional(false));
  EXPECT_THAT(decoded(drive, block, "03 02 00 02").faulted, Optional(true));
  EXPECT_FALSE(decoded(drive, block, "03 02 00 03").faulted.has_value());
}

TEST(DriveStatus, AStateThatStandsInNoTableCountsAsATrip)
{
  const Drive drive = shipped("omron_rx");
  const ReadBlock& block = drive.fastBlocks()[1];
  const Monitor monitor = decoded(drive, block, "03 02 00 07");
  EXPECT_FALSE(monitor.faulted.has_value());
  EXPECT_THAT(monitor.unknown_trip, Optional(Eq(7U)));
  EXPECT_THAT(monitor.tripped(), Optional(true));
  EXPECT_FALSE(decoded(drive, block, "03 02 00 01").unknown_trip.has_value());
  EXPECT_THAT(decoded(drive, block, "03 02 00 01").tripped(), Optional(false));
  EXPECT_FALSE(Monitor().tripped().has_value()) << "what was not read is no trip";
}

TEST(DriveStatus, AnUnknownStateIsNamedWithTheReasonOfTheTrip)
{
  const Drive drive = shipped("omron_mx2");
  Monitor monitor;
  monitor.faulted = true;
  EXPECT_EQ(drive.tripText(monitor), "trip 0: no reason given");
  monitor.faulted.reset();
  monitor.unknown_trip = 300;
  EXPECT_THAT(drive.tripText(monitor), testing::StartsWith("unknown state 300 (0x012C) of faulted"));
  monitor.fault_code = 12;
  EXPECT_THAT(drive.tripText(monitor), testing::EndsWith("trip 12: " + drive.faultText(12)));
}

TEST(DriveStatus, TheCurrentOfAnRxIsUnknownUntilItsScaleIsConfirmed)
{
  const Drive careful = shipped("omron_rx");
  EXPECT_FALSE(careful.reports("output_current"));
  EXPECT_FALSE(decoded(careful, careful.fastBlocks()[2], "03 08 00 00 13 88 00 64 00 01").output_current.has_value());

  ProfileChanges changes;
  changes.confirm = { "current_scale" };
  const Drive confirmed = shipped("omron_rx", changes);
  EXPECT_TRUE(confirmed.reports("output_current"));
  EXPECT_THAT(decoded(confirmed, confirmed.fastBlocks()[2], "03 08 00 00 13 88 00 64 00 01").output_current,
              Optional(10.0));
}

TEST(DriveStatus, ReportsWhatTheProfileHas)
{
  const Drive mx2 = shipped("omron_mx2");
  for (const char* field :
       { "run_seen", "operation", "running", "direction", "ready", "at_speed", "at_set_frequency", "overload_warning",
         "pid_deviation", "faulted", "raw_status", "fault_code", "warning_code", "output_frequency", "output_current",
         "output_voltage", "dc_voltage", "torque", "temperature" })
  {
    EXPECT_TRUE(mx2.reports(field)) << field;
  }
  EXPECT_FALSE(mx2.reports("no_such_field"));
}

TEST(DriveStatus, AShortReplyIsNeverReadBeyondItsEnd)
{
  const Drive drive = shipped("omron_mx2");
  const ReadBlock& block = drive.fastBlocks()[1];
  for (const char* reply : { "", "03", "03 08", "03 08 00 00 13", "03 02 00 00", "83 02", "01 03 01 40 2D", "03 00" })
  {
    const Monitor monitor = decoded(drive, block, reply);
    EXPECT_FALSE(monitor.output_frequency.has_value()) << reply;
    EXPECT_FALSE(monitor.direction.has_value()) << reply;
  }
}

TEST(DriveStatus, WhatAShortReplyHoldsIsStillTaken)
{
  const Drive drive = shipped("omron_mx2");
  const Monitor monitor = decoded(drive, drive.fastBlocks()[1], "03 04 00 00 13 88");
  EXPECT_THAT(monitor.output_frequency, Optional(50.0));
  EXPECT_FALSE(monitor.output_current.has_value());
}

TEST(DriveStatus, ABitOfARegisterIsAFlag)
{
  EXPECT_THAT(decodedWord("faulted: {register: 0x0100, bit: 1}", "03 02 00 02").faulted, Optional(true));
  EXPECT_THAT(decodedWord("faulted: {register: 0x0100, bit: 1}", "03 02 FF FD").faulted, Optional(false));
  EXPECT_THAT(decodedWord("faulted: {register: 0x0100, bit: 15}", "03 02 80 00").faulted, Optional(true));
}

TEST(DriveStatus, AFlagThatIsNotZeroKnowsEveryValue)
{
  const std::string error = "faulted: {register: 0x0100, nonzero: true}";
  EXPECT_THAT(decodedWord(error, "03 02 00 00").faulted, Optional(false));
  EXPECT_THAT(decodedWord(error, "03 02 00 01").faulted, Optional(true));
  EXPECT_THAT(decodedWord(error, "03 02 FF FF").faulted, Optional(true));
  EXPECT_FALSE(decodedWord(error, "03 02 FF FF").unknown_trip.has_value());
  const std::string masked = "faulted: {register: 0x0100, mask: 0x00FF, nonzero: true}";
  EXPECT_THAT(decodedWord(masked, "03 02 FF 00").faulted, Optional(false));
  EXPECT_THAT(decodedWord(masked, "03 02 FF 10").faulted, Optional(true));
}

TEST(DriveStatus, BitsThatTheMaskLeavesOutDoNotCount)
{
  EXPECT_THAT(decodedWord("raw_status: {register: 0x0100, mask: 0x00F0}", "03 02 FF FF").raw_status,
              Optional(Eq(0xF0U)));
  EXPECT_THAT(decodedWord("direction: {register: 0x0100, mask: 1, values: {0: 1, 1: -1}}", "03 02 00 FF").direction,
              Optional(-1));
}

TEST(DriveStatus, PackedCoilsOfAnyStartKeepTheirOrder)
{
  const std::string old = "  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n";
  const Drive drive(ProfileFile(replaced(smallProfile(), old, "  warning_code: {coil: 6, count: 5}\n")).load());
  // The read begins at coil 1 for run_seen only if a span joins them; here 5 and 6-10 touch.
  const ReadBlock& block = drive.fastBlocks().back();
  EXPECT_EQ(block.number, 5);
  EXPECT_EQ(block.count, 6U);
  EXPECT_THAT(decoded(drive, block, "01 01 2A").warning_code, Optional(Eq(0x15U)));
}
}  // namespace
}  // namespace drive
}  // namespace inverter_bus

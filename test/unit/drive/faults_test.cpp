// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Trips, warnings and exceptions in words.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/drive_fixture.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Optional;

TEST(DriveFaults, TheTripBlockOfARealMx2IsUnderstood)
{
  const Drive drive = shipped("omron_mx2");
  const auto blocks = drive.faultReads(0);
  ASSERT_EQ(blocks.size(), 1U);
  FaultRecord record;
  // The first six words are the reply of a real drive: E12 at standstill with 333.0 V; the hours are made up.
  drive.decodeFault(0, blocks[0], bytes("03 14 00 0C 00 01 00 00 00 00 00 00 0D 02 00 00 04 D2 00 01 00 00"), record);
  EXPECT_EQ(record.code, 12);
  EXPECT_THAT(record.text, HasSubstr("external trip"));
  EXPECT_THAT(record.output_frequency, Optional(0.0));
  EXPECT_THAT(record.output_current, Optional(0.0));
  EXPECT_THAT(record.dc_voltage, Optional(333.0));
  EXPECT_THAT(record.run_hours, Optional(1234.0));
  EXPECT_THAT(record.power_on_hours, Optional(65536.0));
}

TEST(DriveFaults, OlderTripsLieTenRegistersFurther)
{
  const Drive drive = shipped("omron_mx2");
  ASSERT_EQ(drive.faultEntries(), 6U);
  EXPECT_EQ(printed(drive.read(1, drive.faultReads(1)[0])), "01 03 00 1B 00 0A");
  EXPECT_EQ(printed(drive.read(1, drive.faultReads(5)[0])), "01 03 00 43 00 0A");
}

TEST(DriveFaults, TheTripBlockOfAnRxIsPutTogetherFromItsPieces)
{
  ProfileChanges changes;
  changes.confirm = { "current_scale" };
  const Drive drive = shipped("omron_rx", changes);
  const auto blocks = drive.faultReads(0);
  ASSERT_EQ(blocks.size(), 3U);
  FaultRecord record;
  drive.decodeFault(0, blocks[0], bytes("03 08 00 07 00 02 00 00 13 88"), record);
  drive.decodeFault(0, blocks[1], bytes("03 08 00 64 02 BC 00 00 00 0A"), record);
  drive.decodeFault(0, blocks[2], bytes("03 04 00 00 00 14"), record);
  EXPECT_EQ(record.code, 7);
  EXPECT_THAT(record.output_frequency, Optional(50.0));
  EXPECT_THAT(record.output_current, Optional(10.0));
  EXPECT_THAT(record.dc_voltage, Optional(700.0));
  EXPECT_THAT(record.run_hours, Optional(10.0));
  EXPECT_THAT(record.power_on_hours, Optional(20.0));
}

TEST(DriveFaults, TheTripCurrentOfAnRxStaysOpenUntilItsScaleIsConfirmed)
{
  const Drive drive = shipped("omron_rx");
  FaultRecord record;
  for (const ReadBlock& block : drive.faultReads(0))
  {
    drive.decodeFault(0, block, bytes("03 14 00 07 00 02 00 00 13 88 00 64 02 BC 00 00 00 0A 00 00 00 14"), record);
  }
  EXPECT_FALSE(record.output_current.has_value());
}

TEST(DriveFaults, AnEntryThatIsNotThereIsIgnored)
{
  const Drive drive = shipped("omron_mx2");
  FaultRecord record;
  drive.decodeFault(6, drive.faultReads(0)[0], bytes("03 02 00 0C"), record);
  EXPECT_EQ(record.code, 0);
  drive.decodeFault(0, drive.faultReads(0)[0], bytes("03"), record);
  EXPECT_EQ(record.code, 0);
}

TEST(DriveFaults, EveryCodeHasAText)
{
  const Drive drive = shipped("omron_mx2");
  EXPECT_EQ(drive.faultText(0), "");
  EXPECT_THAT(drive.faultText(41), HasSubstr("Modbus communication"));
  EXPECT_EQ(drive.faultText(16), "unknown trip 16");
  EXPECT_EQ(drive.faultText(65535), "unknown trip 65535");
  EXPECT_EQ(drive.warningText(0), "");
  EXPECT_EQ(drive.warningText(31), "warning 31");
  EXPECT_EQ(drive.warningText(0x80000001U), "warning 2147483649");
}

TEST(DriveFaults, ATextThatIsNotTheDrivesOwnSaysSo)
{
  EXPECT_THAT(shipped("omron_rx").faultText(16), HasSubstr("unconfirmed"));
  EXPECT_THAT(shipped("omron_rx").faultText(7), testing::Not(HasSubstr("unconfirmed")));
  ProfileChanges changes;
  changes.confirm = { "trip_texts" };
  EXPECT_EQ(shipped("omron_rx", changes).faultText(16), "E16 momentary power interruption");
}

TEST(DriveFaults, ExceptionsSpeakTheDrivesWords)
{
  const Drive drive = shipped("omron_mx2");
  EXPECT_EQ(drive.exceptionText(0x9021), "exception 21H: value outside the drive's range");
  EXPECT_THAT(drive.exceptionText(0x8622), HasSubstr("while running"));
  EXPECT_EQ(drive.exceptionText(0x8306), "exception 06H: device busy");
  EXPECT_EQ(drive.exceptionText(0x83EE), "exception EEH: unknown to the profile");
  EXPECT_EQ(drive.exceptionText(0x0205), "");
}

TEST(DriveFaults, AHistoryMayBeListedEntryByEntry)
{
  const std::string listed =
      "  history:\n    - {code: {register: 0x0300}, output_frequency: {register: 0x0310, resolution: 0.1}}\n"
      "    - {code: {register: 0x0305}}\n";
  const Drive drive(ProfileFile(replaced(smallProfile(), "faults:\n", "faults:\n" + listed)).load());
  ASSERT_EQ(drive.faultEntries(), 2U);
  EXPECT_EQ(drive.faultReads(0).size(), 2U);
  ASSERT_EQ(drive.faultReads(1).size(), 1U);
  EXPECT_THAT(drive.faultReads(1)[0].fields, ElementsAre("code"));
}
}  // namespace
}  // namespace drive
}  // namespace inverter_bus

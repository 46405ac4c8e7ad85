// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Frames as the makers' manuals and traces of real drives print them (without CRC, which belongs to the wire).

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drive_fixture.h"

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

TEST(DriveFrames, StationZeroMakesABroadcastThatNobodyAnswers)
{
  const wire::Request request = shipped("omron_mx2").write(0, "run", 0);
  EXPECT_EQ(printed(request), "00 05 00 00 00 00");
  EXPECT_TRUE(request.broadcast);
  EXPECT_FALSE(request.expects_reply);
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
}  // namespace
}  // namespace drive
}  // namespace inverter_bus

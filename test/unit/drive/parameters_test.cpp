// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Reading and writing parameters: names, scales, ranges, protection.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/drive_fixture.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;

Parameter find(const Drive& drive, const std::string& name)
{
  const auto found = drive.findParameter(name, false);
  EXPECT_TRUE(found.has_value()) << name;
  return found.value_or(Parameter());
}

Parameter made(unsigned words, bool is_signed, double resolution)
{
  Parameter parameter;
  parameter.name = "X01";
  parameter.item.size = words;
  parameter.item.is_signed = is_signed;
  parameter.item.resolution = resolution;
  parameter.item.unit = "V";
  return parameter;
}

class DriveParameters : public testing::Test
{
protected:
  Encoded encode(const Parameter& parameter, double value) const
  {
    return mx2_.encodeParameter(parameter, value);
  }

  const Drive mx2_ = shipped("omron_mx2");
  const Drive rx_ = shipped("omron_rx");
};

TEST_F(DriveParameters, ScalesAreExactInBothDirections)
{
  const Parameter f002 = find(mx2_, "F002");
  EXPECT_EQ(encode(f002, 10.0).raw, 1000U);
  EXPECT_EQ(mx2_.decodeParameter(f002, bytes("03 04 00 00 03 E8")), 10.0);
  EXPECT_EQ(mx2_.rawParameter(f002, bytes("03 04 00 00 03 E8")), 1000U);
  for (std::uint32_t raw = 1; raw <= 360000; raw += 7)
  {
    const double value = static_cast<double>(raw) / 100.0;
    ASSERT_EQ(encode(f002, value).raw, raw) << value;
  }
}

TEST_F(DriveParameters, ValuesBeyondSixteenBitsUseBothWords)
{
  const Parameter f002 = find(mx2_, "F002");
  const Encoded encoded = encode(f002, 3600.0);
  ASSERT_TRUE(encoded.ok) << encoded.error;
  EXPECT_EQ(encoded.raw, 360000U);
  EXPECT_EQ(printed(mx2_.writeParameter(1, f002, encoded.raw)), "01 10 11 02 00 02 04 00 05 7E 40");
  EXPECT_EQ(mx2_.decodeParameter(f002, bytes("03 04 00 05 7E 40")), 3600.0);
}

TEST_F(DriveParameters, AValueBetweenTwoCountsIsRefusedWithItsNeighbours)
{
  const Encoded encoded = encode(find(mx2_, "F002"), 10.005);
  EXPECT_FALSE(encoded.ok);
  EXPECT_THAT(encoded.error, AllOf(HasSubstr("F002"), HasSubstr("0.01 s"), HasSubstr("10 and 10.01 s")));
  EXPECT_FALSE(encode(find(rx_, "A003"), 50.5).ok);
  EXPECT_TRUE(encode(find(mx2_, "A003"), 50.5).ok);
}

TEST_F(DriveParameters, RoundingErrorsOfDoublesAreNoValuesBetweenCounts)
{
  EXPECT_EQ(encode(find(mx2_, "F002"), 0.1 + 0.2).raw, 30U);
  EXPECT_EQ(encode(find(mx2_, "F002"), 0.29).raw, 29U);
  EXPECT_EQ(encode(find(mx2_, "b002"), 0.3).raw, 3U);
}

TEST_F(DriveParameters, AConfirmedRangeIsKept)
{
  const Parameter timeout = find(mx2_, "C077");
  EXPECT_TRUE(encode(timeout, 0.0).ok);
  EXPECT_EQ(encode(timeout, 99.99).raw, 9999U);
  EXPECT_THAT(encode(timeout, 100.0).error, HasSubstr("C077: 100 s is outside 0 to 99.99 s"));
  EXPECT_FALSE(encode(timeout, -0.01).ok);
}

TEST_F(DriveParameters, AnUnconfirmedRangeLeavesOnlyTheRegisterAsLimit)
{
  const Parameter f002 = find(mx2_, "F002");
  ASSERT_TRUE(f002.range.has_value());
  EXPECT_TRUE(f002.range_unconfirmed);
  EXPECT_TRUE(encode(f002, 5000.0).ok);
  EXPECT_THAT(encode(f002, 5e7).error, HasSubstr("what the register can hold"));
  EXPECT_FALSE(encode(f002, -0.01).ok);

  ProfileChanges changes;
  changes.confirm = { "parameter_ranges" };
  const Drive confirmed = shipped("omron_mx2", changes);
  EXPECT_FALSE(confirmed.encodeParameter(find(confirmed, "F002"), 5000.0).ok);
}

TEST_F(DriveParameters, NegativeValuesAreTwosComplementOfTheRegistersSize)
{
  EXPECT_EQ(encode(made(1, true, 0.1), -5.0).raw, 0xFFCEU);
  EXPECT_EQ(encode(made(2, true, 0.1), -5.0).raw, 0xFFFFFFCEU);
  EXPECT_EQ(encode(made(1, true, 1.0), -32768.0).raw, 0x8000U);
  EXPECT_FALSE(encode(made(1, true, 1.0), -32769.0).ok);
  EXPECT_FALSE(encode(made(1, true, 1.0), 32768.0).ok);
  EXPECT_FALSE(encode(made(1, false, 1.0), -1.0).ok);
  EXPECT_EQ(mx2_.decodeParameter(made(1, true, 0.1), bytes("03 02 FF CE")), -5.0);
  EXPECT_EQ(mx2_.decodeParameter(made(2, true, 0.1), bytes("03 04 FF FF FF CE")), -5.0);
}

TEST_F(DriveParameters, TheEndsOfARegisterCanBeWritten)
{
  EXPECT_EQ(encode(made(1, false, 1.0), 65535.0).raw, 65535U);
  EXPECT_FALSE(encode(made(1, false, 1.0), 65536.0).ok);
  EXPECT_EQ(encode(made(2, false, 1.0), 4294967295.0).raw, 4294967295U);
  EXPECT_FALSE(encode(made(2, false, 1.0), 4294967296.0).ok);
  EXPECT_EQ(encode(made(2, true, 1.0), -2147483648.0).raw, 0x80000000U);
}

TEST_F(DriveParameters, NotANumberAndInfinityAreRefused)
{
  for (const double value : { std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity(), 1e300, -1e300 })
  {
    EXPECT_FALSE(encode(made(2, true, 0.01), value).ok) << value;
  }
}

TEST_F(DriveParameters, ADamagedReplyIsNotANumber)
{
  const Parameter f002 = find(mx2_, "F002");
  for (const char* reply : { "", "03", "03 04 00 00 03", "83 02", "03 02 03 E8" })
  {
    EXPECT_TRUE(std::isnan(mx2_.decodeParameter(f002, bytes(reply)))) << reply;
    EXPECT_EQ(mx2_.rawParameter(f002, bytes(reply)), 0U) << reply;
  }
}

TEST_F(DriveParameters, CaseCounts)
{
  EXPECT_TRUE(mx2_.findParameter("F002", true).has_value());
  EXPECT_FALSE(mx2_.findParameter("f002", true).has_value());
  EXPECT_TRUE(mx2_.findParameter("b001", true).has_value());
  EXPECT_FALSE(mx2_.findParameter("B001", true).has_value());
}

TEST_F(DriveParameters, ANumberFindsTheTablesEntryForReading)
{
  const Parameter by_number = find(mx2_, "0x1103");
  EXPECT_EQ(by_number.name, "F002");
  EXPECT_EQ(by_number.item.size, 2U);
  EXPECT_FALSE(mx2_.findParameter("0x1103", true).has_value());
}

TEST_F(DriveParameters, ANumberThatTheTableLacksReadsOnePlainWord)
{
  const Parameter raw = find(mx2_, "0x1E01");
  EXPECT_EQ(printed(mx2_.readParameter(1, raw)), "01 03 1E 00 00 01");
  EXPECT_EQ(mx2_.decodeParameter(raw, bytes("03 02 FF FF")), 65535.0);
  EXPECT_FALSE(encode(raw, 1.0).ok);
  // The second word of a pair is a register of its own.
  EXPECT_EQ(printed(mx2_.readParameter(1, find(mx2_, "0x1104"))), "01 03 11 03 00 01");
  EXPECT_EQ(printed(mx2_.readParameter(1, find(mx2_, "0xFFFF"))), "01 03 FF FE 00 01");
}

TEST_F(DriveParameters, ANumberThatDoesNotExistFindsNothing)
{
  for (const char* name : { "0x0", "0x0000", "0x10000", "0x", "0xG", "0x-1", "0x1103 ", "1103", "" })
  {
    EXPECT_FALSE(mx2_.findParameter(name, false).has_value()) << name;
  }
}

TEST_F(DriveParameters, MonitorsCanBeReadButNotWritten)
{
  const Parameter d001 = find(mx2_, "d001");
  EXPECT_EQ(d001.item.unit, "Hz");
  EXPECT_EQ(mx2_.decodeParameter(d001, bytes("03 04 00 00 13 88")), 50.0);
  EXPECT_FALSE(mx2_.findParameter("d001", true).has_value());
  EXPECT_THAT(encode(d001, 1.0).error, HasSubstr("read-only"));
  EXPECT_THAT(mx2_.parameterRefusal("d001", true), HasSubstr("read-only"));
  EXPECT_EQ(mx2_.parameterRefusal("d001", false), "");
}

TEST_F(DriveParameters, TheCommandFrequencyIsNotWritableAsAParameter)
{
  for (const Drive* drive : { &mx2_, &rx_ })
  {
    EXPECT_TRUE(drive->findParameter("F001", false).has_value());
    EXPECT_FALSE(drive->findParameter("F001", true).has_value());
  }
}

TEST_F(DriveParameters, NoWritableParameterLiesOnACommandRegister)
{
  for (const Drive* drive : { &mx2_, &rx_ })
  {
    for (const auto& [name, parameter] : drive->profile().parameters)
    {
      const unsigned number = parameter.item.number;
      const bool command = number <= 0x0008 || (number >= 0x0900 && number <= 0x0902) || number >= 0x1E00;
      EXPECT_TRUE(parameter.read_only || !command || number >= 0x2000) << name;
    }
  }
}

TEST_F(DriveParameters, AParameterThatIsNotPrintedForTheRxWaitsForConfirmation)
{
  EXPECT_FALSE(rx_.findParameter("C077", false).has_value());
  EXPECT_EQ(rx_.missingForParameter("C077"), "parameter_C077");
  EXPECT_THAT(rx_.parameterRefusal("C077", false), HasSubstr("parameter_C077"));

  ProfileChanges changes;
  changes.confirm = { "parameter_C077" };
  const Drive confirmed = shipped("omron_rx", changes);
  EXPECT_TRUE(confirmed.findParameter("C077", true).has_value());
  EXPECT_EQ(confirmed.missingForParameter("C077"), "");
  EXPECT_FALSE(confirmed.findParameter("C076", false).has_value());
}

TEST_F(DriveParameters, AnUnconfirmedRegisterCanStillBeReadByItsNumber)
{
  const Parameter raw = find(rx_, "0x1451");
  EXPECT_EQ(raw.name, "0x1451");
  EXPECT_EQ(raw.item.resolution, 1.0);
}

TEST_F(DriveParameters, UnknownNamesAreExplained)
{
  EXPECT_EQ(mx2_.missingForParameter("Z999"), "");
  EXPECT_THAT(mx2_.parameterRefusal("Z999", false), HasSubstr("not in the profile omron_mx2"));
  EXPECT_THAT(mx2_.parameterRefusal("0x1103", true), HasSubstr("needs a name"));
  EXPECT_THAT(mx2_.parameterRefusal("0x99999", false), HasSubstr("does not exist"));
}

TEST_F(DriveParameters, SerialSettingsAreMarked)
{
  for (const char* name : { "C071", "C072", "C074", "C075" })
  {
    EXPECT_TRUE(find(mx2_, name).communication) << name;
  }
  for (const char* name : { "F002", "C076", "C077", "C078" })
  {
    EXPECT_FALSE(find(mx2_, name).communication) << name;
  }
}

TEST_F(DriveParameters, OnlyWhatTheMakerAllowsIsMarkedAsWritableWhileRunning)
{
  EXPECT_EQ(find(mx2_, "F002").while_running, std::optional<bool>(true));
  EXPECT_EQ(find(mx2_, "A020").while_running, std::optional<bool>(true));
  EXPECT_FALSE(find(mx2_, "A003").while_running.has_value());
}
}  // namespace
}  // namespace drive
}  // namespace inverter_bus

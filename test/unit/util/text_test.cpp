// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "util/text.h"

#include <limits>
#include <locale>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace util
{
namespace
{
TEST(TextTest, numbersLookAsPeopleWriteThem)
{
  EXPECT_EQ("0.5", numberText(0.5));
  EXPECT_EQ("0", numberText(0.0));
  EXPECT_EQ("0", numberText(-0.0));
  EXPECT_EQ("-0.25", numberText(-0.25));
  EXPECT_EQ("1000000", numberText(1e6));
  EXPECT_EQ("1234568", numberText(1234567.8));
  EXPECT_EQ("0.0001", numberText(1e-4));
  EXPECT_EQ("0.00003", numberText(3e-5));
  EXPECT_EQ("655.35", numberText(655.35));
  EXPECT_EQ("0.333333", numberText(1.0 / 3.0));
  EXPECT_EQ("16.6667", numberText(50.0 / 3.0));
  EXPECT_EQ("10", numberText(9.99999999));
  EXPECT_EQ("0.1", numberText(0.1, 12));
  EXPECT_EQ("16.6666666667", numberText(50.0 / 3.0, 12));
}

TEST(TextTest, onlyWhatNobodyCanReadOtherwiseHasAnExponent)
{
  EXPECT_EQ("1e+300", numberText(1e300));
  EXPECT_EQ("1e-30", numberText(1e-30));
  EXPECT_EQ("inf", numberText(std::numeric_limits<double>::infinity()));
  EXPECT_EQ("-inf", numberText(-std::numeric_limits<double>::infinity()));
  EXPECT_EQ("nan", numberText(-std::numeric_limits<double>::quiet_NaN()));
}

TEST(TextTest, durationsHaveTheUnitThatFits)
{
  EXPECT_EQ("0 ms", durationText(Duration::zero()));
  EXPECT_EQ("0.4 ms", durationText(seconds(0.0004)));
  EXPECT_EQ("4.01 ms", durationText(seconds(0.00401)));
  EXPECT_EQ("158 ms", durationText(seconds(0.158)));
  EXPECT_EQ("999 ms", durationText(seconds(0.9994)));
  EXPECT_EQ("1 s", durationText(seconds(0.9996)));
  EXPECT_EQ("3.81 s", durationText(seconds(3.81)));
  EXPECT_EQ("120 s", durationText(seconds(120.4)));
  EXPECT_EQ("86400 s", durationText(seconds(86400.0)));
}

TEST(TextTest, whatIsComparedWithAFileHasTheDigitsOfTheFile)
{
  EXPECT_EQ("0.1", exactText(0.1));
  EXPECT_EQ("123456.789012", exactText(123456.789012));
  EXPECT_EQ("16.6666666667", exactText(50.0 / 3.0));
}

TEST(TextTest, fixedTextsKeepTheirZeros)
{
  EXPECT_EQ("0.50", fixedText(0.5, 2));
  EXPECT_EQ("-1.3", fixedText(-1.25001, 1));
  EXPECT_EQ("1000001", fixedText(1000000.6, 0));
  EXPECT_EQ("inf", fixedText(std::numeric_limits<double>::infinity(), 1));
}

TEST(TextTest, aUnitFollowsAfterASpace)
{
  EXPECT_EQ("0.5 Hz", withUnit("0.5", "Hz"));
  EXPECT_EQ("0.5", withUnit("0.5", ""));
}

TEST(TextTest, millisecondsStayMilliseconds)
{
  EXPECT_EQ("0.0 ms", millisecondsText(Duration::zero()));
  EXPECT_EQ("12.3 ms", millisecondsText(seconds(0.01234)));
  EXPECT_EQ("123456.0 ms", millisecondsText(seconds(123.456)));
  EXPECT_EQ("16 ms", millisecondsText(std::chrono::milliseconds(16), 0));
}

TEST(TextTest, hexadecimalDigitsAreFilledUpAndNeverCut)
{
  EXPECT_EQ("0A", hexText(0x0A, 2));
  EXPECT_EQ("00AF", hexText(0xAF, 4));
  EXPECT_EQ("12345", hexText(0x12345, 4));
  EXPECT_EQ("FFFFFFFF", hexText(0xFFFFFFFF, 8));
  EXPECT_EQ("0x00AF", hexNumber(0xAF));
  EXPECT_EQ("0x12345", hexNumber(0x12345));
}

TEST(TextTest, listsHaveSeparatorsBetweenTheirParts)
{
  EXPECT_EQ("", joined(std::vector<std::string>()));
  EXPECT_EQ("a", joined(std::vector<std::string>{ "a" }));
  EXPECT_EQ("a, b, c", joined(std::set<std::string>{ "c", "a", "b" }));
  EXPECT_EQ("a; b", joined(std::vector<std::string>{ "a", "b" }, "; "));
  EXPECT_EQ("1, -2, 3", joined(std::vector<int>{ 1, -2, 3 }));
}

/// A locale with a decimal comma and points between thousands, as many programs set it.
struct Comma : std::numpunct<char>
{
  char do_decimal_point() const override
  {
    return ',';
  }
  char do_thousands_sep() const override
  {
    return '.';
  }
  std::string do_grouping() const override
  {
    return "\3";
  }
};

TEST(TextTest, noLocaleChangesANumber)
{
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  EXPECT_EQ("1234.5", numberText(1234.5));
  EXPECT_EQ("1234.50", fixedText(1234.5, 2));
  EXPECT_EQ("1234.5 ms", millisecondsText(seconds(1.2345)));
  std::locale::global(before);
}
}  // namespace
}  // namespace util
}  // namespace inverter_bus

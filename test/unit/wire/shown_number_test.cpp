// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "wire/shown_number.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace inverter_bus
{
namespace wire
{
namespace
{
TEST(ShownNumberTest, numbersLookAsPeopleWriteThem)
{
  EXPECT_EQ("0.5", shownNumber(0.5));
  EXPECT_EQ("0", shownNumber(0.0));
  EXPECT_EQ("0", shownNumber(-0.0));
  EXPECT_EQ("-0.25", shownNumber(-0.25));
  EXPECT_EQ("1000000", shownNumber(1e6));
  EXPECT_EQ("1234568", shownNumber(1234567.8));
  EXPECT_EQ("0.0001", shownNumber(1e-4));
  EXPECT_EQ("0.00003", shownNumber(3e-5));
  EXPECT_EQ("655.35", shownNumber(655.35));
  EXPECT_EQ("0.333333", shownNumber(1.0 / 3.0));
  EXPECT_EQ("16.6667", shownNumber(50.0 / 3.0));
  EXPECT_EQ("10", shownNumber(9.99999999));
  EXPECT_EQ("0.1", shownNumber(0.1, 12));
  EXPECT_EQ("16.6666666667", shownNumber(50.0 / 3.0, 12));
}

TEST(ShownNumberTest, onlyWhatNobodyCanReadOtherwiseHasAnExponent)
{
  EXPECT_EQ("1e+300", shownNumber(1e300));
  EXPECT_EQ("1e-30", shownNumber(1e-30));
  EXPECT_EQ("inf", shownNumber(std::numeric_limits<double>::infinity()));
  EXPECT_EQ("-inf", shownNumber(-std::numeric_limits<double>::infinity()));
  EXPECT_EQ("nan", shownNumber(-std::numeric_limits<double>::quiet_NaN()));
}

TEST(ShownNumberTest, durationsHaveTheUnitThatFits)
{
  EXPECT_EQ("0 ms", shownDuration(Duration::zero()));
  EXPECT_EQ("0.4 ms", shownDuration(seconds(0.0004)));
  EXPECT_EQ("4.01 ms", shownDuration(seconds(0.00401)));
  EXPECT_EQ("158 ms", shownDuration(seconds(0.158)));
  EXPECT_EQ("999 ms", shownDuration(seconds(0.9994)));
  EXPECT_EQ("1 s", shownDuration(seconds(0.9996)));
  EXPECT_EQ("3.81 s", shownDuration(seconds(3.81)));
  EXPECT_EQ("120 s", shownDuration(seconds(120.4)));
  EXPECT_EQ("86400 s", shownDuration(seconds(86400.0)));
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus

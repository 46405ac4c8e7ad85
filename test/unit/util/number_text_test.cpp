// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "util/number_text.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace inverter_bus
{
namespace util
{
namespace
{
TEST(NumberTextTest, numbersLookAsPeopleWriteThem)
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

TEST(NumberTextTest, onlyWhatNobodyCanReadOtherwiseHasAnExponent)
{
  EXPECT_EQ("1e+300", numberText(1e300));
  EXPECT_EQ("1e-30", numberText(1e-30));
  EXPECT_EQ("inf", numberText(std::numeric_limits<double>::infinity()));
  EXPECT_EQ("-inf", numberText(-std::numeric_limits<double>::infinity()));
  EXPECT_EQ("nan", numberText(-std::numeric_limits<double>::quiet_NaN()));
}

TEST(NumberTextTest, durationsHaveTheUnitThatFits)
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
}  // namespace
}  // namespace util
}  // namespace inverter_bus

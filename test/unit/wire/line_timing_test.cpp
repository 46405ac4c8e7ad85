// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <gtest/gtest.h>

#include "inverter_bus/wire/line.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using std::chrono::microseconds;
using std::chrono::milliseconds;

Duration rounded(Duration duration)
{
  return std::chrono::round<microseconds>(duration);
}

TEST(LineTiming, aCharacterTakesItsBits)
{
  EXPECT_EQ(microseconds(1042), rounded(LineTiming(9600, 10).characters(1)));
  EXPECT_EQ(microseconds(1146), rounded(LineTiming(9600, 11).characters(1)));
  EXPECT_EQ(microseconds(41667), rounded(LineTiming(2400, 10).characters(10)));
  EXPECT_EQ(Duration::zero(), LineTiming(9600, 11).characters(0));
}

TEST(LineTiming, theGapIsCountedInCharactersUpTo19200Baud)
{
  EXPECT_EQ(microseconds(32083), rounded(LineTiming(1200, 11).gap(3.5)));
  EXPECT_EQ(microseconds(4010), rounded(LineTiming(9600, 11).gap(3.5)));
  EXPECT_EQ(microseconds(2005), rounded(LineTiming(19200, 11).gap(3.5)));
  EXPECT_EQ(microseconds(1823), rounded(LineTiming(19200, 10).gap(3.5)));
}

TEST(LineTiming, theGapIsFixedAbove19200Baud)
{
  EXPECT_EQ(microseconds(1750), rounded(LineTiming(38400, 11).gap(3.5)));
  EXPECT_EQ(microseconds(1750), rounded(LineTiming(115200, 10).gap(3.5)));
}

TEST(LineTiming, aReplyMayPauseFor25Milliseconds)
{
  EXPECT_EQ(microseconds(25000), rounded(LineTiming(19200, 10).patience(3.5)));
  EXPECT_EQ(microseconds(25000), rounded(LineTiming(115200, 12).patience(3.5)));
  EXPECT_EQ(microseconds(25000), rounded(LineTiming(9600, 11).patience(0.0)));
}

TEST(LineTiming, aReplyMayPauseFor18CharactersAtLowRates)
{
  // 14 of a FIFO's trigger level and 4 of silence.
  EXPECT_EQ(microseconds(41250), rounded(LineTiming(4800, 11).patience(3.5)));
  EXPECT_EQ(microseconds(75000), rounded(LineTiming(2400, 10).patience(3.5)));
  EXPECT_EQ(microseconds(82500), rounded(LineTiming(2400, 11).patience(0.0)));
  EXPECT_EQ(microseconds(165000), rounded(LineTiming(1200, 11).patience(3.5)));
}

TEST(LineTiming, aPauseThatIsGivenIsWaitedForAndNoLessThanAGap)
{
  EXPECT_EQ(microseconds(200000), rounded(LineTiming(19200, 10, milliseconds(200)).patience(3.5)));
  EXPECT_EQ(microseconds(100000), rounded(LineTiming(1200, 11, milliseconds(100)).patience(3.5)));
  EXPECT_EQ(microseconds(32083), rounded(LineTiming(1200, 11, milliseconds(10)).patience(3.5)));
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "util/printable.h"

#include <string>

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace util
{
namespace
{
TEST(PrintableTest, whatIsPlainStaysAsItIs)
{
  EXPECT_EQ("belt_1 'x' ~", printable("belt_1 'x' ~"));
  EXPECT_EQ("", printable(""));
  EXPECT_EQ("Förderband \xE2\x82\xAC \xF0\x9F\x9B\x91", printable("Förderband \xE2\x82\xAC \xF0\x9F\x9B\x91"));
}

TEST(PrintableTest, isOneLineThatNoTerminalObeys)
{
  EXPECT_EQ("a b c", printable("a\nb\tc"));
  EXPECT_EQ(" [2J", printable("\x1B[2J"));
  EXPECT_EQ("a b", printable(std::string("a\0b", 3)));
  // CSI of Latin-1, LINE SEPARATOR, RIGHT-TO-LEFT OVERRIDE.
  EXPECT_EQ("?? ??? ???", printable("\xC2\x9B \xE2\x80\xA8 \xE2\x80\xAE"));
}

TEST(PrintableTest, isUtf8WhateverTheBytesAre)
{
  EXPECT_EQ("?", printable("\xFF"));
  EXPECT_EQ("?x", printable("\xC3x"));
  EXPECT_EQ("?", printable("\xC3"));
  EXPECT_EQ("??", printable("\xC0\xAF"));            // '/' written longer than needed
  EXPECT_EQ("???", printable("\xED\xA0\x80"));       // a surrogate
  EXPECT_EQ("????", printable("\xF4\x90\x80\x80"));  // beyond the last character
  EXPECT_EQ("???", printable("\xE0\x80\xAF"));
}

TEST(PrintableTest, isCutBetweenCharactersWithItsLength)
{
  EXPECT_EQ("0123456789", printable("0123456789", 10));
  EXPECT_EQ("0123456789... (11 bytes)", printable("0123456789A", 10));
  EXPECT_EQ("012345678... (11 bytes)", printable("012345678\xC3\xA4", 10));
  EXPECT_EQ(std::string(100, 'x') + "... (1000000 bytes)", printable(std::string(1000000, 'x')));
}
}  // namespace
}  // namespace util
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "config/shown.h"

#include <string>

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace config
{
namespace
{
TEST(ShownText, whatIsPlainStaysAsItIs)
{
  EXPECT_EQ("belt_1 'x' ~", shown("belt_1 'x' ~"));
  EXPECT_EQ("", shown(""));
  EXPECT_EQ("Förderband \xE2\x82\xAC \xF0\x9F\x9B\x91", shown("Förderband \xE2\x82\xAC \xF0\x9F\x9B\x91"));
}

TEST(ShownText, isOneLineThatNoTerminalObeys)
{
  EXPECT_EQ("a b c", shown("a\nb\tc"));
  EXPECT_EQ(" [2J", shown("\x1B[2J"));
  EXPECT_EQ("a b", shown(std::string("a\0b", 3)));
  // CSI of Latin-1, LINE SEPARATOR, RIGHT-TO-LEFT OVERRIDE.
  EXPECT_EQ("?? ??? ???", shown("\xC2\x9B \xE2\x80\xA8 \xE2\x80\xAE"));
}

TEST(ShownText, isUtf8WhateverTheBytesAre)
{
  EXPECT_EQ("?", shown("\xFF"));
  EXPECT_EQ("?x", shown("\xC3x"));
  EXPECT_EQ("?", shown("\xC3"));
  EXPECT_EQ("??", shown("\xC0\xAF"));            // '/' written longer than needed
  EXPECT_EQ("???", shown("\xED\xA0\x80"));       // a surrogate
  EXPECT_EQ("????", shown("\xF4\x90\x80\x80"));  // beyond the last character
  EXPECT_EQ("???", shown("\xE0\x80\xAF"));
}

TEST(ShownText, isCutBetweenCharactersWithItsLength)
{
  EXPECT_EQ("0123456789", shown("0123456789", 10));
  EXPECT_EQ("0123456789... (11 bytes)", shown("0123456789A", 10));
  EXPECT_EQ("012345678... (11 bytes)", shown("012345678\xC3\xA4", 10));
  EXPECT_EQ(std::string(100, 'x') + "... (1000000 bytes)", shown(std::string(1000000, 'x')));
}
}  // namespace
}  // namespace config
}  // namespace inverter_bus

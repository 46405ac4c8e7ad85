// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What feeds a drive's own communication time-out (contract, 3.12 and 8.17).

#include "bus/inverter/feeding.h"

#include <string>

#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
drive::Drive fedBy(const std::string& profile_name, drive::Feeds feeds)
{
  drive::Profile profile = drive::loadProfile(profile_name, drive::profileDirectory());
  profile.feeds = feeds;
  return drive::Drive(profile);
}

bool feeds(const drive::Drive& drive, const std::string& pdu)
{
  Feeding feeding(drive);
  wire::Request request;
  request.pdu = drive::bytes("03 10 00 00 01");
  EXPECT_FALSE(feeding.fedAt());
  feeding.answered(request, at(0));
  EXPECT_EQ(feeding.fedAt(), at(0)) << "the drive is heard of first";
  request.pdu = drive::bytes(pdu);
  feeding.answered(request, at(100));
  EXPECT_TRUE(*feeding.fedAt() == at(0) || *feeding.fedAt() == at(100));
  return *feeding.fedAt() == at(100);
}

TEST(Feeding, everyAnsweredRequestFeedsAnOrdinaryDrive)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  EXPECT_FALSE(Feeding(mx2).needsWrites());
  EXPECT_TRUE(feeds(mx2, "01 00 00 00 18"));
  EXPECT_TRUE(feeds(mx2, "05 00 00 FF 00"));
}

TEST(Feeding, onlyWritesFeedADriveThatSaysSo)
{
  const drive::Drive mx2 = fedBy("omron_mx2", drive::Feeds::Writes);
  EXPECT_TRUE(Feeding(mx2).needsWrites());
  EXPECT_FALSE(feeds(mx2, "01 00 00 00 18"));
  EXPECT_FALSE(feeds(mx2, "03 10 00 00 04"));
  EXPECT_FALSE(feeds(mx2, "08 00 00 12 34"));
  EXPECT_TRUE(feeds(mx2, "05 00 00 FF 00"));
  EXPECT_TRUE(feeds(mx2, "10 00 00 00 02 04 00 00 13 88"));
  EXPECT_TRUE(feeds(mx2, "17 10 00 00 04 00 00 00 02 04 00 00 13 88"));
}

TEST(Feeding, onlyTheCommandWordFeedsADriveThatSaysSo)
{
  const drive::Drive mx2 = fedBy("omron_mx2", drive::Feeds::CommandWord);
  EXPECT_TRUE(feeds(mx2, "05 00 00 00 00"));
  EXPECT_FALSE(feeds(mx2, "05 00 01 00 00")) << "the direction";
  EXPECT_FALSE(feeds(mx2, "10 00 00 00 02 04 00 00 13 88")) << "a register, though it has the number of the RUN coil";
  const drive::Drive vfs15 = fedBy("toshiba_vfs15", drive::Feeds::CommandWord);
  EXPECT_TRUE(feeds(vfs15, "06 FA 00 C4 00"));
  EXPECT_FALSE(feeds(vfs15, "06 FA 01 07 D0"));
  EXPECT_TRUE(feeds(vfs15, "10 18 70 00 02 04 C4 00 07 D0")) << "all command words in one frame";
  EXPECT_TRUE(feeds(vfs15, "17 18 75 00 05 18 70 00 02 04 C4 00 07 D0"));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

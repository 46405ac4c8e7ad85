// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Which reads a refresh consists of.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "drive_fixture.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::vector<std::string> framesOf(const Drive& drive, const std::vector<ReadBlock>& blocks)
{
  std::vector<std::string> frames;
  for (const ReadBlock& block : blocks)
  {
    frames.push_back(printed(drive.read(1, block)));
  }
  return frames;
}

std::vector<ReadBlock> allBlocks(const Drive& drive)
{
  std::vector<ReadBlock> blocks = drive.fastBlocks();
  blocks.insert(blocks.end(), drive.slowBlocks().begin(), drive.slowBlocks().end());
  blocks.insert(blocks.end(), drive.faultBlocks().begin(), drive.faultBlocks().end());
  for (std::size_t i = 0; i < drive.faultEntries(); ++i)
  {
    const auto reads = drive.faultReads(i);
    blocks.insert(blocks.end(), reads.begin(), reads.end());
  }
  return blocks;
}

/// The fast reads of a profile with these status lines and register spans.
std::vector<std::string> plan(const std::string& status, const std::string& spans, unsigned limit)
{
  std::string text = smallProfile();
  text = replaced(text, "  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n", status);
  text = replaced(text, "[[0x0100, 0x0120]]", spans);
  text = replaced(text, "read_registers: 8", "read_registers: " + std::to_string(limit));
  const Drive drive(ProfileFile(text).load());
  std::vector<std::string> frames = framesOf(drive, drive.fastBlocks());
  // The coils come first and are not the point here.
  frames.erase(
      std::remove_if(frames.begin(), frames.end(), [](const std::string& f) { return f.substr(3, 2) == "01"; }),
      frames.end());
  return frames;
}

TEST(DriveReadPlan, AnMx2IsRefreshedWithExactlyTwoReads)
{
  const Drive drive = shipped("omron_mx2");
  EXPECT_THAT(framesOf(drive, drive.fastBlocks()), ElementsAre("01 01 00 00 00 18", "01 03 10 00 00 04"));
}

TEST(DriveReadPlan, TheSlowPartOfAnMx2IsThreeReads)
{
  const Drive drive = shipped("omron_mx2");
  EXPECT_THAT(framesOf(drive, drive.slowBlocks()),
              ElementsAre("01 03 00 4D 00 01", "01 03 10 0F 00 0A", "01 03 10 25 00 01"));
}

TEST(DriveReadPlan, TheFaultCodeIsReadOnItsOwnAndOnlyWhileTripped)
{
  for (const char* name : { "omron_mx2", "omron_rx" })
  {
    const Drive drive = shipped(name);
    ASSERT_EQ(drive.faultBlocks().size(), 1U);
    EXPECT_EQ(printed(drive.read(1, drive.faultBlocks()[0])), "01 03 00 11 00 01");
    EXPECT_THAT(drive.faultBlocks()[0].fields, ElementsAre("fault_code"));
  }
}

TEST(DriveReadPlan, AnRxIsRefreshedWithThreeReadsOfAtMostFourRegisters)
{
  const Drive drive = shipped("omron_rx");
  EXPECT_THAT(framesOf(drive, drive.fastBlocks()),
              ElementsAre("01 01 00 00 00 18", "01 03 00 03 00 01", "01 03 10 00 00 04"));
  EXPECT_THAT(framesOf(drive, drive.slowBlocks()), ElementsAre("01 03 00 4D 00 01", "01 03 10 0F 00 02"));
}

TEST(DriveReadPlan, ATripBlockOfAnRxIsReadInThreePieces)
{
  ProfileChanges changes;
  changes.confirm = { "current_scale" };
  const Drive drive = shipped("omron_rx", changes);
  EXPECT_THAT(framesOf(drive, drive.faultReads(0)),
              ElementsAre("01 03 00 11 00 04", "01 03 00 15 00 04", "01 03 00 19 00 02"));
  EXPECT_THAT(drive.faultReads(6), IsEmpty());
}

TEST(DriveReadPlan, TheReadBackOfAStopIsOneCoil)
{
  const Drive drive = shipped("omron_mx2");
  ASSERT_TRUE(drive.runBlock().has_value());
  EXPECT_EQ(printed(drive.read(1, *drive.runBlock())), "01 01 00 00 00 01");
  EXPECT_THAT(drive.runBlock()->fields, ElementsAre("run_seen"));
}

TEST(DriveReadPlan, WithoutARunBitTheReadBackOfAStopFallsBackToRunning)
{
  const Drive drive(ProfileFile(replaced(smallProfile(), "  run_seen: {coil: 1}\n", "")).load());
  ASSERT_TRUE(drive.runBlock().has_value());
  EXPECT_THAT(drive.runBlock()->fields, ElementsAre("running"));
  std::string text = replaced(smallProfile(), "  run_seen: {coil: 1}\n", "");
  text = replaced(text, "  running: {coil: 5}\n", "");
  EXPECT_FALSE(Drive(ProfileFile(text).load()).runBlock().has_value());
}

TEST(DriveReadPlan, NoReadOfAShippedProfileExceedsItsLimits)
{
  for (const char* name : { "omron_mx2", "omron_rx" })
  {
    ProfileChanges changes;
    changes.confirm = { "all" };
    const Drive drive = shipped(name, changes);
    for (const ReadBlock& block : allBlocks(drive))
    {
      const unsigned limit = block.space == Space::Coil ? drive.profile().read_coils : drive.profile().read_registers;
      EXPECT_LE(block.count, limit) << name << " " << block.number;
      EXPECT_EQ(block.address, block.number - 1) << name;
    }
  }
}

TEST(DriveReadPlan, RegistersSideBySideShareARead)
{
  EXPECT_THAT(plan("  output_frequency: {register: 0x0010}\n  output_current: {register: 0x0011}\n", "[]", 8),
              ElementsAre("01 03 00 0F 00 02"));
}

TEST(DriveReadPlan, AGapInsideASpanIsReadOver)
{
  EXPECT_THAT(
      plan("  output_frequency: {register: 0x0010}\n  output_current: {register: 0x0014}\n", "[[0x11, 0x13]]", 8),
      ElementsAre("01 03 00 0F 00 05"));
}

TEST(DriveReadPlan, AHoleIsNeverReadOver)
{
  const std::string status = "  output_frequency: {register: 0x0010}\n  output_current: {register: 0x0014}\n";
  EXPECT_THAT(plan(status, "[]", 8), ElementsAre("01 03 00 0F 00 01", "01 03 00 13 00 01"));
  EXPECT_THAT(plan(status, "[[0x11, 0x12]]", 8), ElementsAre("01 03 00 0F 00 01", "01 03 00 13 00 01"));
  // Two spans that leave a number between them are two, even if together they cover nearly all.
  EXPECT_THAT(plan(status, "[[0x10, 0x11], [0x13, 0x14]]", 8), ElementsAre("01 03 00 0F 00 01", "01 03 00 13 00 01"));
}

TEST(DriveReadPlan, TheLimitSplitsAReadButNeverAValue)
{
  const std::string status =
      "  output_frequency: {register: 0x0010}\n"
      "  output_current: {register: 0x0011, words: 2}\n"
      "  torque: {register: 0x0013}\n";
  EXPECT_THAT(plan(status, "[]", 4), ElementsAre("01 03 00 0F 00 04"));
  EXPECT_THAT(plan(status, "[]", 3), ElementsAre("01 03 00 0F 00 03", "01 03 00 12 00 01"));
  EXPECT_THAT(plan(status, "[]", 2), ElementsAre("01 03 00 0F 00 01", "01 03 00 10 00 02", "01 03 00 12 00 01"));
}

TEST(DriveReadPlan, FieldsOfOneRegisterAreReadOnce)
{
  EXPECT_THAT(plan("  ready: {register: 0x0010, bit: 0}\n  faulted: {register: 0x0010, bit: 3}\n"
                   "  raw_status: {register: 0x0010}\n",
                   "[]", 8),
              ElementsAre("01 03 00 0F 00 01"));
}

TEST(DriveReadPlan, AnUnconfirmedFieldIsNotRead)
{
  EXPECT_THAT(plan("  output_frequency: {register: 0x0010}\n  output_current: {register: 0x0011, unconfirmed: scale}\n",
                   "[]", 8),
              ElementsAre("01 03 00 0F 00 01"));
}
}  // namespace
}  // namespace drive
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Which reads a refresh consists of.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "support/drive_fixture.h"

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

TEST(DriveReadPlan, WithoutARunBitThereIsNoReadBackOfAStop)
{
  // `running` is no substitute: a motor that still ramps down holds no RUN.
  const Drive drive(ProfileFile(replaced(smallProfile(), "  run_seen: {coil: 1}\n", "")).load());
  EXPECT_FALSE(drive.runBlock().has_value());
  EXPECT_FALSE(drive.tellsRun());
  EXPECT_TRUE(Drive(ProfileFile(smallProfile()).load()).tellsRun());
}

TEST(DriveReadPlan, NoReadOfAShippedProfileExceedsItsLimits)
{
  for (const std::string& name : knownProfiles(profileDirectory()))
  {
    ProfileChanges changes;
    changes.confirm = { "all" };
    changes.overrides = overridesOf(name == "teco_7200ma" ? "{monitor_base: 0x0020}" : "{}");
    const Drive drive = shipped(name, changes);
    ASSERT_FALSE(drive.fastBlocks().empty()) << name;
    for (const ReadBlock& block : allBlocks(drive))
    {
      const unsigned limit = block.space == Space::Coil ? drive.profile().read_coils : drive.profile().read_registers;
      EXPECT_LE(block.count, limit) << name << " " << block.number;
      const bool from_one = name == "omron_mx2" || name == "omron_rx" || name == "hitachi_wj200";
      EXPECT_EQ(block.address, block.number - (from_one ? 1 : 0)) << name;
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

/// The fast reads of a profile whose last two digits count decimally.
std::vector<std::string> decimalPlan(const std::string& status, const std::string& spans, unsigned limit)
{
  std::string text =
      replaced(smallProfile(), "{register_offset: -1, coil_offset: -1}", "{register_offset: 0, decimal: true}");
  text = replaced(text, "  run_seen: {coil: 1}\n  running: {coil: 5}\n", "");
  text = replaced(text, "  P02: {register: 0x0201, words: 2}\n", "");
  text = replaced(text, "  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n", status);
  text = replaced(text, "[[0x0100, 0x0120]]", spans);
  text = replaced(text, "read_registers: 8", "read_registers: " + std::to_string(limit));
  const Drive drive(ProfileFile(text).load());
  return framesOf(drive, drive.fastBlocks());
}

TEST(DriveReadPlan, AfterFD09ComesFD10)
{
  // E6581913 p29, p68: two words from 0009 are 0009 and 0010.
  const std::string status = "  output_frequency: {register: 0xFD09}\n  output_current: {register: 0xFD10}\n";
  EXPECT_THAT(decimalPlan(status, "[]", 8), ElementsAre("01 03 FD 09 00 02"));
  EXPECT_THAT(decimalPlan(status, "[]", 1), ElementsAre("01 03 FD 09 00 01", "01 03 FD 10 00 01"));
}

TEST(DriveReadPlan, AfterFD99ComesFE00)
{
  const std::string status = "  output_frequency: {register: 0xFD99}\n  output_current: {register: 0xFE00}\n";
  EXPECT_THAT(decimalPlan(status, "[]", 8), ElementsAre("01 03 FD 99 00 02"));
}

TEST(DriveReadPlan, DecimalGapsAreCountedInNumbersThatExist)
{
  const std::string status = "  output_frequency: {register: 0xFD08}\n  output_current: {register: 0xFD11}\n";
  EXPECT_THAT(decimalPlan(status, "[[0xFD00, 0xFD20]]", 8), ElementsAre("01 03 FD 08 00 04"));
  EXPECT_THAT(decimalPlan(status, "[[0xFD00, 0xFD20]]", 3), ElementsAre("01 03 FD 08 00 01", "01 03 FD 11 00 01"));
  EXPECT_THAT(decimalPlan(status, "[]", 8), ElementsAre("01 03 FD 08 00 01", "01 03 FD 11 00 01"));
}

TEST(DriveReadPlan, WordsOfADecimalReadAreTakenFromTheirPlace)
{
  std::string text =
      replaced(smallProfile(), "{register_offset: -1, coil_offset: -1}", "{register_offset: 0, decimal: true}");
  text = replaced(text, "  run_seen: {coil: 1}\n  running: {coil: 5}\n", "");
  text = replaced(text, "  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n",
                  "  output_frequency: {register: 0xFD09}\n  output_current: {register: 0xFD10}\n"
                  "  torque: {register: 0xFD12}\n");
  text = replaced(text, "[[0x0100, 0x0120]]", "[[0xFD09, 0xFD12]]");
  const Drive drive(ProfileFile(text).load());
  ASSERT_THAT(framesOf(drive, drive.fastBlocks()), ElementsAre("01 03 FD 09 00 04"));
  Monitor monitor;
  drive.decode(drive.fastBlocks()[0], bytes("03 08 00 01 00 02 00 03 00 04"), monitor);
  EXPECT_DOUBLE_EQ(monitor.output_frequency.value_or(-1.0), 1.0);
  EXPECT_DOUBLE_EQ(monitor.output_current.value_or(-1.0), 2.0);
  EXPECT_DOUBLE_EQ(monitor.torque.value_or(-1.0), 4.0);
}

TEST(DriveReadPlan, AVfs15IsRefreshedWithOneReadOrWithItsBlock)
{
  const Drive drive = shipped("toshiba_vfs15");
  EXPECT_THAT(framesOf(drive, drive.fastBlocks()), ElementsAre("01 03 FD 00 00 04"));
  const auto block = drive.chosenRead({ 1, 2, 3, 4, 14 });
  ASSERT_TRUE(block.has_value());
  EXPECT_THAT(block->chosen, ElementsAre(0xFD01, 0xFD00, 0xFD03, 0xFD05, 0xFD18));
  EXPECT_THAT(block->fields, UnorderedElementsAre("raw_status", "operation", "running", "direction", "faulted", "ready",
                                                  "output_frequency", "output_current", "output_voltage", "torque"));
  EXPECT_THAT(drive.fastBlocksBeside(*block), IsEmpty());
  for (const ReadBlock& slow : drive.slowBlocksBeside(*block))
  {
    EXPECT_THAT(slow.fields, testing::Not(testing::Contains("output_voltage")));
    EXPECT_THAT(slow.fields, testing::Not(testing::Contains("torque")));
  }
}

TEST(DriveReadPlan, WhatTheChosenWordsLeaveOutIsReadBesideThem)
{
  const Drive drive = shipped("toshiba_vfs15");
  const auto block = drive.chosenRead({ 2, 3, 0, 0, 0 });
  ASSERT_TRUE(block.has_value());
  // The status word is not chosen: it stays a read of its own.
  EXPECT_THAT(framesOf(drive, drive.fastBlocksBeside(*block)), ElementsAre("01 03 FD 01 00 01"));
}

TEST(DriveReadPlan, TheTripMemoryOfAVfs15LiesInTwoPlaces)
{
  const Drive drive = shipped("toshiba_vfs15");
  ASSERT_EQ(drive.faultEntries(), 8U);
  EXPECT_THAT(framesOf(drive, drive.faultReads(0)), ElementsAre("01 03 FE 10 00 01"));
  EXPECT_THAT(framesOf(drive, drive.faultReads(3)), ElementsAre("01 03 FE 13 00 01"));
  EXPECT_THAT(framesOf(drive, drive.faultReads(4)), ElementsAre("01 03 FD 10 00 01"));
  EXPECT_THAT(framesOf(drive, drive.faultReads(7)), ElementsAre("01 03 FD 13 00 01"));
}

TEST(DriveReadPlan, AVfs11IsAskedForOneRegisterAtATime)
{
  EXPECT_THAT(framesOf(shipped("toshiba_vfs11"), shipped("toshiba_vfs11").fastBlocks()),
              ElementsAre("01 03 FD 01 00 01"));
  ProfileChanges changes;
  changes.confirm = { "all" };
  const Drive drive = shipped("toshiba_vfs11", changes);
  EXPECT_THAT(framesOf(drive, drive.fastBlocks()),
              ElementsAre("01 03 FD 00 00 01", "01 03 FD 01 00 01", "01 03 FE 03 00 01"));
}

TEST(DriveReadPlan, KeepAliveIsReadOnlyWhileNothingElseIs)
{
  std::string text = replaced(smallProfile(), "  run_seen: {coil: 1}\n  running: {coil: 5}\n", "");
  text = replaced(text, "  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}\n",
                  "  output_frequency: {register: 0x0100, unconfirmed: place}\n"
                  "keep_alive: {register: 0x0300}\n");
  const ProfileFile file(text);
  const Drive silent(file.load());
  EXPECT_THAT(framesOf(silent, silent.fastBlocks()), ElementsAre("01 03 02 FF 00 01"));
  EXPECT_THAT(silent.fastBlocks()[0].fields, IsEmpty());
  ProfileChanges changes;
  changes.confirm = { "place" };
  const Drive telling(file.load(changes));
  EXPECT_THAT(framesOf(telling, telling.fastBlocks()), ElementsAre("01 03 00 FF 00 01"));
}

TEST(DriveReadPlan, TheReadBackOfAStopOnAVfs15IsItsCommandWord)
{
  const Drive drive = shipped("toshiba_vfs15");
  ASSERT_TRUE(drive.runBlock().has_value());
  EXPECT_EQ(printed(drive.read(1, *drive.runBlock())), "01 03 FA 00 00 01");
  Monitor monitor;
  drive.decode(*drive.runBlock(), bytes("03 02 C4 00"), monitor);
  EXPECT_EQ(monitor.run_seen, true);
  drive.decode(*drive.runBlock(), bytes("03 02 C0 00"), monitor);
  EXPECT_EQ(monitor.run_seen, false);
}

TEST(DriveReadPlan, VariablesSideBySideShareARead)
{
  const Drive drive(ProfileFile(smallCompowayProfile()).load());
  std::vector<std::string> texts;
  for (const ReadBlock& block : drive.fastBlocks())
  {
    const wire::Bytes pdu = drive.read(1, block).pdu;
    texts.emplace_back(pdu.begin(), pdu.end());
  }
  // Two elements are the most that the drive brings; the third goes on its own.
  EXPECT_THAT(texts, ElementsAre("0101C00001000002", "0101C00003000001", "0601"));
}
}  // namespace
}  // namespace drive
}  // namespace inverter_bus

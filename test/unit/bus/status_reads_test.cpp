// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Which reads make the status, in pieces where the drive wants pieces (contract, rule 3.10).

#include "bus/inverter/status_reads.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::ElementsAre;
using testing::IsEmpty;
using Kind = StatusRead::Kind;

class Mx2Reads : public testing::Test
{
protected:
  std::vector<std::string> frames(Kind kind) const
  {
    std::vector<std::string> texts;
    for (const drive::ReadBlock& block : reads_.blocks(kind))
    {
      texts.push_back(printed(mx2_.read(1, block)));
    }
    return texts;
  }

  std::size_t indexOf(const char* field) const
  {
    std::size_t index = 0;
    while (index < reads_.size() && !reads_[index].brings(field))
    {
      ++index;
    }
    return index;
  }

  const drive::Drive mx2_ = shipped("omron_mx2");
  StatusReads reads_{ mx2_ };
};

TEST_F(Mx2Reads, slowOnesStandFirstAndFastOnesLast)
{
  std::vector<Kind> kinds;
  for (std::size_t index = 0; index < reads_.size(); ++index)
  {
    kinds.push_back(reads_[index].kind);
  }
  EXPECT_THAT(kinds, ElementsAre(Kind::Slow, Kind::Slow, Kind::Slow, Kind::Fault, Kind::Fast, Kind::Fast));
  EXPECT_THAT(frames(Kind::Fast), ElementsAre("01 01 00 00 00 18", "01 03 10 00 00 04"));
  EXPECT_THAT(frames(Kind::Fault), ElementsAre("01 03 00 11 00 01"));
}

TEST_F(Mx2Reads, coilsTellRunAndTheRegistersDoNot)
{
  EXPECT_TRUE(reads_[indexOf("running")].tellsRun());
  EXPECT_FALSE(reads_[indexOf("output_frequency")].tellsRun());
  EXPECT_TRUE(reads_.tellRun());
}

TEST_F(Mx2Reads, splitPutsTwoReadsInThePlaceOfOne)
{
  const std::size_t registers = indexOf("output_frequency");
  EXPECT_TRUE(reads_.split(registers, false));
  EXPECT_THAT(frames(Kind::Fast), ElementsAre("01 01 00 00 00 18", "01 03 10 00 00 02", "01 03 10 02 00 02"));
  EXPECT_FALSE(reads_.split(registers, false));
  EXPECT_THAT(frames(Kind::Fast), ElementsAre("01 01 00 00 00 18", "01 03 10 00 00 02", "01 03 10 02 00 02"));
}

TEST_F(Mx2Reads, onlyAnotherReadOfRunThatMayBeAskedCounts)
{
  const std::size_t coils = indexOf("running");
  EXPECT_FALSE(reads_.othersTellRun(coils, at(0)));
  ASSERT_TRUE(reads_.split(coils, false));
  EXPECT_TRUE(reads_.othersTellRun(coils, at(0)));
  reads_[coils + 1].left_out_until = at(500);
  EXPECT_FALSE(reads_.othersTellRun(coils, at(499)));
  EXPECT_TRUE(reads_.othersTellRun(coils, at(500)));
}

TEST_F(Mx2Reads, oneThatIsLeftOutIsOpenAgainAfterItsTime)
{
  ASSERT_THAT(reads_.open(Kind::Fault, at(0)), ElementsAre(indexOf("fault_code")));
  reads_[indexOf("fault_code")].left_out_until = at(30000);
  EXPECT_THAT(reads_.open(Kind::Fault, at(29999)), IsEmpty());
  EXPECT_THAT(reads_.open(Kind::Fault, at(30000)), ElementsAre(indexOf("fault_code")));
}

TEST_F(Mx2Reads, builtAnewTheyAreWholeAgain)
{
  const std::vector<std::string> whole = frames(Kind::Fast);
  reads_.split(indexOf("output_frequency"), false);
  reads_[indexOf("fault_code")].left_out_until = at(30000);
  reads_.build(std::nullopt);
  EXPECT_EQ(frames(Kind::Fast), whole);
  EXPECT_THAT(reads_.open(Kind::Fault, at(0)), ElementsAre(indexOf("fault_code")));
}

TEST_F(Mx2Reads, thoseAcrossAHoleStaySplit)
{
  const std::size_t slow = indexOf("torque");
  ASSERT_TRUE(reads_.split(slow, true));
  const std::vector<std::string> split = frames(Kind::Slow);
  EXPECT_EQ(split.size(), 4U);
  reads_.forget();
  EXPECT_EQ(frames(Kind::Slow), split);
}

TEST_F(Mx2Reads, whatWasReadCountsAfterABuildButNotAfterAReturn)
{
  StatusRead& read = reads_[indexOf("dc_voltage")];
  read.values.dc_voltage = 320.0;
  read.last = at(1000);
  read.ever = true;
  reads_.build(std::nullopt);
  drive::Monitor monitor;
  reads_.addSlowValues(at(2000), monitor);
  EXPECT_TRUE(monitor.dc_voltage);
  reads_.forget();
  monitor = drive::Monitor();
  reads_.addSlowValues(at(2000), monitor);
  EXPECT_FALSE(monitor.dc_voltage);
  EXPECT_FALSE(reads_.slowAge(at(2000)));
}

TEST_F(Mx2Reads, slowValuesCountForTenSecondsOrTwoAndAHalfOfTheirPeriods)
{
  StatusRead& read = reads_[indexOf("dc_voltage")];
  read.values.dc_voltage = 320.0;
  read.last = at(1000);
  const auto shown = [this](int time) {
    drive::Monitor monitor;
    reads_.addSlowValues(at(time), monitor);
    return monitor.dc_voltage.has_value();
  };
  EXPECT_FALSE(shown(1000)) << "it was never read";
  read.ever = true;
  EXPECT_TRUE(shown(11000));
  EXPECT_FALSE(shown(11001));
  reads_.planPeriod(Ms(8000));
  EXPECT_TRUE(shown(21000));
  EXPECT_FALSE(shown(21001));
  // As seen, where that is longer.
  read.period = Ms(10000);
  EXPECT_EQ(reads_.slowPeriod(), Ms(10000));
  EXPECT_TRUE(shown(26000));
  EXPECT_FALSE(shown(26001));
}

TEST_F(Mx2Reads, ageIsThatOfTheOldestSlowValue)
{
  EXPECT_FALSE(reads_.slowAge(at(0)));
  for (const char* field : { "dc_voltage", "torque" })
  {
    reads_[indexOf(field)].ever = true;
  }
  reads_[indexOf("dc_voltage")].last = at(1000);
  reads_[indexOf("torque")].last = at(3000);
  EXPECT_EQ(reads_.slowAge(at(4000)), Ms(3000));
}

TEST_F(Mx2Reads, needsAreWhatTheReadsTookWithTheirGaps)
{
  EXPECT_EQ(reads_.slowNeeds(Ms(2), Ms(30)), Ms(90));
  StatusRead& read = reads_[indexOf("torque")];
  read.ever = true;
  read.took = Ms(20);
  EXPECT_EQ(reads_.slowNeeds(Ms(2), Ms(30)), Ms(82));
}

TEST(Vfs15Reads, whatShowsALeftoverRunOrARestartIsNotSlowed)
{
  const drive::Drive vfs15 = shipped("toshiba_vfs15");
  StatusReads reads(vfs15);
  unsigned slowed = 0;
  for (std::size_t index = 0; index < reads.size(); ++index)
  {
    const bool guards = reads[index].brings("run_seen") || reads[index].brings("restarted");
    EXPECT_FALSE(guards && reads[index].isSlowed());
    slowed += reads[index].isSlowed() ? 1 : 0;
    if (guards)
    {
      reads[index].ever = true;
      reads[index].last = at(0);
      reads[index].values.run_seen = true;
    }
  }
  EXPECT_EQ(slowed, 3U) << "output voltage, torque, warnings";
  drive::Monitor monitor;
  reads.addSlowValues(at(1001), monitor);
  EXPECT_FALSE(monitor.run_seen);
  reads.addSlowValues(at(1000), monitor);
  EXPECT_TRUE(monitor.run_seen);
}

TEST(Vfs15Reads, chosenBlockGoesLastAndTakesWhatItBringsFromTheOthers)
{
  const drive::Drive vfs15 = shipped("toshiba_vfs15");
  StatusReads reads(vfs15);
  // Status, output frequency, current, output voltage, torque: the codes of the profile's own example.
  const auto chosen = vfs15.chosenRead({ 1, 2, 3, 4, 14 });
  ASSERT_TRUE(chosen);
  reads.build(chosen);
  EXPECT_EQ(reads[reads.size() - 1].block.chosen, chosen->chosen);
  for (std::size_t index = 0; index + 1 < reads.size(); ++index)
  {
    for (const std::string& field : chosen->fields)
    {
      EXPECT_FALSE(reads[index].brings(field.c_str())) << field;
    }
  }
}

TEST(SplitBlock, singleValueCannotBeSplit)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  ASSERT_EQ(mx2.faultBlocks().size(), 1U);
  EXPECT_EQ(splitBlock(mx2, mx2.faultBlocks().front()).size(), 1U);
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

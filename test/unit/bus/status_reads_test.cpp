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
  EXPECT_TRUE(reads_.split(registers));
  EXPECT_THAT(frames(Kind::Fast), ElementsAre("01 01 00 00 00 18", "01 03 10 00 00 02", "01 03 10 02 00 02"));
  EXPECT_FALSE(reads_.split(registers));
  EXPECT_THAT(frames(Kind::Fast), ElementsAre("01 01 00 00 00 18", "01 03 10 00 00 02", "01 03 10 02 00 02"));
}

TEST_F(Mx2Reads, onlyAnotherReadOfRunThatMayBeAskedCounts)
{
  const std::size_t coils = indexOf("running");
  EXPECT_FALSE(reads_.othersTellRun(coils, at(0)));
  ASSERT_TRUE(reads_.split(coils));
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
  reads_.split(indexOf("output_frequency"));
  reads_[indexOf("fault_code")].left_out_until = at(30000);
  reads_.build(std::nullopt);
  EXPECT_EQ(frames(Kind::Fast), whole);
  EXPECT_THAT(reads_.open(Kind::Fault, at(0)), ElementsAre(indexOf("fault_code")));
}

TEST_F(Mx2Reads, slowValuesCountUpToTheirAge)
{
  StatusRead& read = reads_[indexOf("dc_voltage")];
  read.values.dc_voltage = 320.0;
  read.last = at(1000);
  drive::Monitor monitor;
  reads_.addSlowValues(at(1000), Ms(500), monitor);
  EXPECT_FALSE(monitor.dc_voltage) << "it was never read";
  read.ever = true;
  reads_.addSlowValues(at(1501), Ms(500), monitor);
  EXPECT_FALSE(monitor.dc_voltage);
  reads_.addSlowValues(at(1500), Ms(500), monitor);
  EXPECT_DOUBLE_EQ(monitor.dc_voltage.value(), 320.0);
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

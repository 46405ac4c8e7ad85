// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What is read of a drive's register map, how mapped words are proven, and when they are used (contract, 8.17).

#include "bus/inverter/map_use.h"

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
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using Verdict = MapOutcome::Verdict;

drive::Drive confirmedMx2()
{
  drive::ProfileChanges changes;
  changes.confirm = { "register_map" };
  return drive::Drive(drive::loadProfile("omron_mx2", INVERTER_BUS_ROOT "/config/drives", changes));
}

/// The answers to the reads of P200-P215, P216-P230 with P301, and P302-P310: their registers follow each other.
struct Answers
{
  std::string first =
      "03 20 00 01 10 05 10 06 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00";
  std::string second =
      "03 20 00 00 00 00 00 00 00 00 00 00 03 E8 03 E8 03 E8 03 E8 03 E8 03 E8 03 E8 03 E8 03 E8 03 E8 1E 01";
  std::string third = "03 12 1F 01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00";
};

class Mx2Map : public testing::Test
{
protected:
  static InverterConfig config(bool configure)
  {
    InverterConfig config = inverterConfig();
    config.configure_map = configure;
    return config;
  }

  void read(const Answers& answers)
  {
    table_.restart();
    for (const std::string& answer : { answers.first, answers.second, answers.third })
    {
      ASSERT_NE(nullptr, table_.next());
      table_.done(reply(answer));
    }
  }

  /// A refresh with a proof in which plain reads show \p plain before and after the mapped word \p mapped.
  static MapOutcome proof(std::uint32_t plain, std::uint32_t mapped, std::uint32_t after, bool run = false)
  {
    MappedReads reads;
    drive::Monitor before;
    before.raw_status = plain;
    before.run_seen = run;
    drive::Monitor values;
    values.raw_status = mapped;
    reads.compare(true, values, before);
    values.raw_status = after;
    reads.compare(false, values, before);
    return reads.takeOutcome().value_or(MapOutcome{ Verdict::Refused, false });
  }

  bool reads(TimePoint now, bool run)
  {
    return map_.orders(now, true, run, !run).read.has_value();
  }

  const drive::Drive mx2_ = confirmedMx2();
  const InverterConfig config_ = config(false);
  const InverterConfig configuring_ = config(true);
  MapTable table_{ mx2_, true };
  MapUse map_{ mx2_, config_ };
};

TEST_F(Mx2Map, tableIsReadInThreeExchanges)
{
  EXPECT_EQ("01 03 16 C7 00 10", printed(mx2_.read(1, *table_.next())));
  EXPECT_FALSE(table_.known());
  read(Answers());
  EXPECT_EQ(nullptr, table_.next());
  EXPECT_TRUE(table_.fits());
  EXPECT_FALSE(table_.inOtherUse());
  table_.restart();
  EXPECT_FALSE(table_.known());
}

TEST_F(Mx2Map, anyOfItsParametersThatDiffersMakesItUnfit)
{
  Answers ratio;
  ratio.second.replace(ratio.second.size() - 11, 5, "07 D0");
  Answers format;
  format.first.replace(format.first.size() - 5, 5, "00 01");
  Answers slot;
  slot.third.replace(slot.third.size() - 5, 5, "12 10");
  Answers off;
  off.first.replace(9, 2, "00");
  for (const Answers& answers : { ratio, format, slot, off })
  {
    read(answers);
    EXPECT_TRUE(table_.known());
    EXPECT_FALSE(table_.fits());
  }
  EXPECT_THAT(table_.differences(), ElementsAre(Pair("P200", 1U)));
  EXPECT_FALSE(table_.inOtherUse()) << "it is off";
}

TEST_F(Mx2Map, inOtherUseIsOnlyAMapThatIsOnForSomethingElse)
{
  Answers other;
  other.first.replace(12, 5, "40 01");
  other.second.replace(other.second.size() - 5, 5, "12 12");
  read(other);
  EXPECT_TRUE(table_.inOtherUse());
  EXPECT_EQ("P201 = 0x4001, P301 = 0x1212", table_.text());
  EXPECT_EQ("P201 = 0x1005, P301 = 0x1E01", table_.wantedText());
  other.first.replace(9, 2, "00");
  read(other);
  EXPECT_FALSE(table_.inOtherUse());
  Answers half;  // written by halves: nobody else's
  half.first.replace(18, 5, "00 00");
  read(half);
  EXPECT_FALSE(table_.inOtherUse());
  EXPECT_THAT(table_.differences(), ElementsAre(Pair("P202", 0x1006U)));
}

TEST_F(Mx2Map, aDriveThatRefusesHasNone)
{
  table_.done(exception(0x83, 0x02));
  EXPECT_EQ(nullptr, table_.next());
  EXPECT_TRUE(table_.refused());
  EXPECT_FALSE(table_.fits());
  EXPECT_THAT(map_.whyNot(table_), HasSubstr("may have no map"));
}

TEST_F(Mx2Map, nobodyReadsItUnasked)
{
  const drive::Drive plain = shipped("omron_mx2");
  EXPECT_FALSE(MapUse::wanted(plain, config_));
  EXPECT_TRUE(MapUse::wanted(plain, configuring_));
  EXPECT_TRUE(MapUse::wanted(mx2_, config_));
  EXPECT_FALSE(MapUse::wanted(shipped("omron_rx"), config_));
  EXPECT_EQ(nullptr, MapTable(plain, false).next());
}

TEST_F(Mx2Map, oneReadBringsAllFastFields)
{
  const auto block = mx2_.mappedRead();
  ASSERT_TRUE(block);
  EXPECT_EQ("01 03 10 00 00 06", printed(mx2_.read(1, *block)));
  EXPECT_THAT(mx2_.fastBlocksBeside(*block), IsEmpty());
  drive::Monitor monitor;
  // 50.00 Hz, 3.00 A, reverse; ready, RUN, FA1, OL; RUN, reverse, operation.
  mx2_.decode(*block, drive::bytes("03 0C 00 00 13 88 01 2C 00 02 00 5A 80 06"), monitor);
  EXPECT_DOUBLE_EQ(50.0, monitor.output_frequency.value_or(0.0));
  EXPECT_DOUBLE_EQ(3.0, monitor.output_current.value_or(0.0));
  EXPECT_EQ(-1, monitor.direction.value_or(0));
  EXPECT_TRUE(monitor.run_seen.value_or(false));
  EXPECT_TRUE(monitor.operation.value_or(false));
  EXPECT_TRUE(monitor.ready.value_or(false));
  EXPECT_TRUE(monitor.running.value_or(false));
  EXPECT_TRUE(monitor.at_speed.value_or(false));
  EXPECT_FALSE(monitor.at_set_frequency.value_or(true));
  EXPECT_TRUE(monitor.overload_warning.value_or(false));
  EXPECT_FALSE(monitor.pid_deviation.value_or(true));
  EXPECT_FALSE(monitor.faulted.value_or(true));
  // The same word as coils 0001h to 0018h: 0x5A << 15 | 0x8006 >> 1.
  EXPECT_EQ(0x2D4003U, monitor.raw_status.value_or(0));
}

TEST_F(Mx2Map, wordsAreEqualOnlyBetweenTwoEqualPlainReads)
{
  EXPECT_EQ(Verdict::Equal, proof(0x10000, 0x10000, 0x10000).verdict);
  EXPECT_EQ(Verdict::Unlike, proof(0x10000, 0, 0x10000).verdict);
  EXPECT_EQ(Verdict::Open, proof(0x10000, 0x50001, 0x50001).verdict) << "the drive's state changed meanwhile";
  EXPECT_EQ(Verdict::Open, proof(0, 0, 0).verdict) << "no bit, no proof";
  EXPECT_TRUE(proof(0x50001, 0x50001, 0x50001, true).run);
}

TEST_F(Mx2Map, isUsedOnlyWhereItWasProvenForRunAsItIs)
{
  EXPECT_FALSE(reads(at(0), false));
  map_.note({ Verdict::Equal, false });
  EXPECT_TRUE(reads(at(1000), false));
  EXPECT_TRUE(map_.inUse());
  EXPECT_EQ(false, map_.orders(at(1000), true, false, true).proven_with_run.value_or(true));
  EXPECT_FALSE(reads(at(2000), true)) << "never seen with RUN on";
  EXPECT_FALSE(map_.inUse());
  map_.note({ Verdict::Equal, true });
  EXPECT_TRUE(reads(at(3000), true));
  EXPECT_FALSE(map_.orders(at(3000), true, true, false).proven_with_run) << "both are proven";
  EXPECT_FALSE(map_.orders(at(4000), false, true, false).read) << "its table does not fit any more";
}

TEST_F(Mx2Map, aProofComesAtRestOrWithRunAndNotInEveryRefresh)
{
  EXPECT_THAT(map_.orders(at(0), true, false, false).proof, IsEmpty()) << "it coasts, or somebody else moves it";
  EXPECT_THAT(map_.orders(at(0), false, false, true).proof, IsEmpty());
  const MapOrders orders = map_.orders(at(0), true, false, true);
  ASSERT_EQ(2U, orders.proof.size());
  EXPECT_EQ("01 03 10 00 00 06", printed(mx2_.read(1, orders.proof[0])));
  EXPECT_EQ("01 01 00 00 00 18", printed(mx2_.read(1, orders.proof[1])));
  EXPECT_THAT(map_.orders(at(100), true, false, true).proof, IsEmpty());
  EXPECT_EQ(2U, map_.orders(at(500), true, true, false).proof.size());
}

TEST_F(Mx2Map, aRefusedOrUnlikeReadEndsItUntilTheNextConnect)
{
  for (const Verdict verdict : { Verdict::Unlike, Verdict::Refused })
  {
    map_.note({ Verdict::Equal, false });
    map_.note({ verdict, false });
    EXPECT_FALSE(reads(at(1000), false));
    EXPECT_THAT(map_.orders(at(5000), true, false, true).proof, IsEmpty());
    map_.note({ Verdict::Equal, false });
    EXPECT_FALSE(reads(at(6000), false));
    map_.restart();
    EXPECT_EQ(2U, map_.orders(at(7000), true, false, true).proof.size());
    map_.restart();
  }
}

TEST_F(Mx2Map, aLostExchangeHasItProvenAnew)
{
  map_.note({ Verdict::Equal, false });
  map_.note({ Verdict::Equal, true });
  map_.lost();
  EXPECT_FALSE(reads(at(0), false));
  map_.note({ Verdict::Equal, true });
  EXPECT_TRUE(reads(at(1000), true));
  EXPECT_FALSE(reads(at(1000), false));
}

TEST_F(Mx2Map, wordsWithAnotherRunThanWasProvenAreNotAccepted)
{
  MappedReads reads;
  MapOrders orders;
  orders.read = mx2_.mappedRead();
  orders.proven_with_run = false;
  EXPECT_TRUE(reads.take(orders));
  EXPECT_FALSE(reads.take(orders));
  drive::Monitor values;
  EXPECT_FALSE(reads.accepts(values)) << "no RUN in it at all";
  values.run_seen = true;
  EXPECT_FALSE(reads.accepts(values));
  values.run_seen = false;
  EXPECT_TRUE(reads.accepts(values));
  orders.proven_with_run.reset();
  reads.take(orders);
  values.run_seen = true;
  EXPECT_TRUE(reads.accepts(values));
}

TEST_F(Mx2Map, wordsThatContradictTheFrequencyBesideThemHaveItProvenAnew)
{
  MappedReads reads;
  MapOrders orders;
  orders.read = mx2_.mappedRead();
  reads.take(orders);
  drive::Monitor values;
  values.run_seen = false;
  values.running = false;
  values.output_frequency = 0.0;
  EXPECT_TRUE(reads.accepts(values));
  values.output_frequency = 20.0;
  EXPECT_FALSE(reads.accepts(values));
  const auto outcome = reads.takeOutcome();
  ASSERT_TRUE(outcome);
  EXPECT_EQ(Verdict::Doubtful, outcome->verdict);
  values.running = true;
  EXPECT_TRUE(reads.accepts(values));
  map_.note({ Verdict::Equal, false });
  map_.note(*outcome);
  EXPECT_FALSE(this->reads(at(0), false));
}

TEST_F(Mx2Map, isWrittenOnceAtRestAndOnlyWhereTheUserWantsIt)
{
  Answers factory;
  factory.first = "03 20" + std::string(96, ' ');
  for (std::size_t place = 5; place < factory.first.size(); place += 3)
  {
    factory.first.replace(place, 3, " 00");
  }
  factory.second.replace(factory.second.size() - 5, 5, "00 00");
  factory.third.replace(6, 5, "00 00");
  read(factory);
  EXPECT_THAT(map_.takeWrites(table_, true), IsEmpty());
  EXPECT_THAT(map_.whyNot(table_), HasSubstr("set the drive, or configure_map: true"));
  MapUse configuring(mx2_, configuring_);
  EXPECT_THAT(configuring.takeWrites(table_, false), IsEmpty()) << "while the motor turns";
  EXPECT_THAT(configuring.takeWrites(table_, true),
              ElementsAre(Pair("P201", 0x1005U), Pair("P202", 0x1006U), Pair("P301", 0x1E01U), Pair("P302", 0x1F01U),
                          Pair("P200", 1U)));
  EXPECT_THAT(configuring.takeWrites(table_, true), IsEmpty());
  configuring.restart();
  EXPECT_THAT(configuring.takeWrites(table_, true), IsEmpty()) << "each write wears the EEPROM";
}

TEST_F(Mx2Map, inOtherUseIsToldOnceWithBothTables)
{
  Answers other;
  other.first.replace(12, 5, "40 01");
  read(other);
  EXPECT_EQ("", map_.takeRefusal(table_));
  MapUse configuring(mx2_, configuring_);
  EXPECT_THAT(configuring.takeWrites(table_, true), IsEmpty());
  EXPECT_THAT(configuring.takeRefusal(table_), HasSubstr("it has P201 = 0x4001; wanted: P201 = 0x1005"));
  EXPECT_EQ("", configuring.takeRefusal(table_));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

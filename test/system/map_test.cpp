// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The status of an MX2 through its register map (contract, 8.17), on a whole bus in virtual time. The simulated drive has its
// mapping from the manuals, not from the profile.

#include <gmock/gmock.h>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// 03H, six registers from 1001h: wire 1000h.
const char* const MAPPED = "01 03 10 00 00 06";
const char* const COILS = "01 01 00 00 00 18";
const char* const FITS = "P200: 1, P201: 0x1005, P301: 0x1E01, P202: 0x1006, P302: 0x1F01";

/// One MX2, with \p keys of its entry, \p parameters as set at its panel before it was switched on, and \p more of the
/// simulation.
std::string belt(const std::string& keys, const std::string& parameters, const std::string& more = "")
{
  return "port: /dev/virtual\nbaud_rate: 19200\nscan_list:\n  - {name: belt, node: 1, drive: omron_mx2" + keys +
         "}\nsimulation:\n  belt: {" + more + "parameters: {F002: 1, F003: 1" + (parameters.empty() ? "" : ", ") +
         parameters + "}}\n";
}

const char* const CONFIRMED = ", confirm: [register_map]";

/// The next \p seconds bring mapped reads, and no plain ones of the coils.
void expectMapped(VirtualBus& bus, double duration)
{
  bus.clearFrames();
  bus.run(duration);
  EXPECT_GT(bus.count(MAPPED), 5U);
  EXPECT_EQ(0U, bus.count(COILS));
}

/// They bring plain reads only.
void expectPlain(VirtualBus& bus, double duration)
{
  bus.clearFrames();
  bus.run(duration);
  EXPECT_EQ(0U, bus.count(MAPPED));
  EXPECT_GT(bus.count(COILS), 5U);
}

TEST(Map, isUsedWhereTheDriveHasItAndBringsTheWholeStatus)
{
  VirtualBus bus(belt(CONFIRMED, FITS));
  bus.settleIn();
  bus.run(3.0);
  expectMapped(bus, 1.0);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("register map = in use"));
  EXPECT_TRUE(bus.status(0).monitor.ready.value_or(false));
  EXPECT_FALSE(bus.status(0).monitor.running.value_or(true));

  bus.stream(0, 40.0, 0.1, 8.0);
  bus.run(4.0);
  expectMapped(bus, 1.0);
  const drive::Monitor& monitor = bus.status(0).monitor;
  EXPECT_TRUE(monitor.running.value_or(false));
  EXPECT_TRUE(monitor.operation.value_or(false));
  EXPECT_TRUE(monitor.run_seen.value_or(false));
  EXPECT_TRUE(monitor.at_speed.value_or(false));
  EXPECT_FALSE(monitor.faulted.value_or(true));
  EXPECT_EQ(1, monitor.direction.value_or(0));
  EXPECT_DOUBLE_EQ(40.0, monitor.output_frequency.value_or(0.0));
  EXPECT_NEAR(bus.motor("belt", "current"), monitor.output_current.value_or(0.0), 0.01);
  EXPECT_EQ(0x00080001U, monitor.raw_status.value_or(0) & 0x00080001U) << "bit 0: RUN, bit 19: FA1";

  bus.run(5.0);
  EXPECT_FALSE(bus.status(0).monitor.running.value_or(true)) << "the command watchdog stopped it";
  bus.world("belt trip 12");
  bus.run(1.0);
  EXPECT_TRUE(bus.status(0).monitor.faulted.value_or(false));
  EXPECT_EQ(12, bus.status(0).monitor.fault_code.value_or(0));
}

TEST(Map, isNotEvenReadUntilItIsConfirmed)
{
  VirtualBus bus(belt("", FITS));
  bus.settleIn();
  bus.run(3.0);
  expectPlain(bus, 1.0);
  EXPECT_EQ(0U, bus.count("01 03 16")) << "P200";
  EXPECT_THAT(bus.diagnostics(0), Not(HasSubstr("register map")));
}

TEST(Map, eachWordIsProvenBeforeItIsUsedWithRunOffAndWithRunOn)
{
  VirtualBus bus(belt(CONFIRMED, FITS));
  bus.settleIn();
  bus.run(2.0);
  expectMapped(bus, 0.5);
  bus.clearFrames();
  bus.stream(0, 40.0, 0.1, 5.0);
  bus.run(3.0);
  const auto requests = bus.requests();
  const auto run = std::find(requests.begin(), requests.end(), "01 05 00 00 FF 00");
  ASSERT_NE(run, requests.end());
  const auto mapped = std::find(run, requests.end(), MAPPED);
  ASSERT_NE(mapped, requests.end());
  EXPECT_EQ(1, std::count(run, mapped, COILS)) << "a plain read before the first mapped one with RUN on";
  EXPECT_EQ(COILS, *(mapped + 1)) << "and one after it";
}

TEST(Map, thatIsNotInEffectIsFoundOutAndNotTrusted)
{
  // Written and stored, but the drive was not switched off and on since: 1005h and 1006h are still d004.
  VirtualBus bus(belt(CONFIRMED, ""));
  for (const char* set :
       { "belt set P201 4101", "belt set P301 7681", "belt set P202 4102", "belt set P302 7937", "belt set P200 1" })
  {
    bus.world(set);
  }
  bus.settleIn();
  bus.stream(0, 40.0, 0.1, 6.0);
  bus.run(5.0);
  expectPlain(bus, 0.5);
  EXPECT_TRUE(bus.status(0).monitor.running.value_or(false));
  EXPECT_THAT(bus.diagnostics(0),
              AllOf(HasSubstr("not in effect: switch the drive off and on"), HasSubstr("register map = not used")));
  // It counts after a power cycle, and is used after the return.
  bus.run(3.0);
  bus.world("belt power_cycle 6");
  bus.run(12.0);
  EXPECT_FALSE(bus.status(0).communication_error);
  bus.run(3.0);
  expectMapped(bus, 1.0);
}

TEST(Map, ofAnotherWordIsFoundOutWhenRunComesOnThoughAtRestItReadsAlike)
{
  // The table was changed after the last power-on. In effect is status A (0003h, 2 at rest) over 1005h: bit 1, as if ready.
  VirtualBus bus(belt(CONFIRMED, "P200: 1, P201: 0x1005, P301: 0x0003, P202: 0x1006, P302: 0x1F01"));
  bus.world("belt set P301 7681");
  bus.settleIn();
  bus.run(3.0);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("register map = in use"));
  bus.stream(0, 40.0, 0.1, 6.0);
  bus.run(5.0);
  EXPECT_TRUE(bus.status(0).monitor.running.value_or(false));
  EXPECT_FALSE(bus.status(0).locked);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("not in effect"));
  expectPlain(bus, 0.5);
}

TEST(Map, thatContradictsTheFrequencyIsNotBelieved)
{
  VirtualBus bus(belt(CONFIRMED, "P200: 1, P201: 0x1005, P301: 0x0003, P202: 0x1006, P302: 0x1F01"));
  bus.world("belt set P301 7681");
  bus.settleIn();
  bus.run(3.0);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("register map = in use"));
  bus.world("belt panel 20");
  bus.run(2.0);
  EXPECT_TRUE(bus.status(0).monitor.running.value_or(false)) << "status A = 3 has no bit for it";
  EXPECT_DOUBLE_EQ(20.0, bus.status(0).monitor.output_frequency.value_or(0.0));
  expectPlain(bus, 0.5);
}

TEST(Map, aRunWordThatIsAnotherIsFoundOutBeforeItIsBelieved)
{
  // At rest the trip counter (0011h) reads as 1F01h does: 0.
  VirtualBus bus(belt(CONFIRMED, "P200: 1, P201: 0x1005, P301: 0x1E01, P202: 0x1006, P302: 0x0011"));
  bus.world("belt set P302 7937");
  bus.settleIn();
  bus.run(3.0);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("register map = in use"));
  bus.stream(0, 40.0, 0.1, 4.0);
  bus.run(3.0);
  EXPECT_TRUE(bus.status(0).monitor.run_seen.value_or(false));
  EXPECT_FALSE(bus.status(0).locked) << "as if RUN were lost";
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("not in effect"));
}

TEST(Map, aRefusedReadEndsItsUseUntilTheNextConnect)
{
  VirtualBus bus(belt(CONFIRMED, FITS, "mapped_reads_in_blocks: false, "));
  bus.settleIn();
  bus.run(4.0);
  EXPECT_FALSE(bus.status(0).communication_error);
  expectPlain(bus, 1.0);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("the drive refuses the read"));
}

TEST(Map, aReadThatIsRefusedWhileItIsUsedLosesNoStatus)
{
  VirtualBus bus(belt(CONFIRMED, FITS));
  bus.settleIn();
  bus.run(3.0);
  expectMapped(bus, 0.5);
  bus.world("belt exception 0x32 function 0x03 count 1");
  bus.run(1.0);
  EXPECT_FALSE(bus.status(0).communication_error);
  expectPlain(bus, 1.0);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("the drive refuses the read"));
  bus.world("belt power_cycle 4");
  bus.run(14.0);
  expectMapped(bus, 0.5);
}

TEST(Map, aLostExchangeHasItProvenAnew)
{
  VirtualBus bus(belt(CONFIRMED, FITS));
  bus.settleIn();
  bus.run(3.0);
  expectMapped(bus, 0.5);
  bus.clearFrames();
  bus.world("belt lost_reply");
  bus.run(0.5);
  EXPECT_GE(bus.count(COILS), 2U) << "before and after";
  bus.run(0.5);
  expectMapped(bus, 0.5);
}

TEST(Map, slowValuesStayWhenTheReadsChange)
{
  VirtualBus bus(belt(CONFIRMED, FITS));
  bus.settleIn();
  bus.run(3.0);
  for (int step = 0; step < 200; ++step)
  {
    if (step == 100)
    {
      bus.world("belt lost_reply");
    }
    bus.run(0.02);
    ASSERT_TRUE(bus.status(0).monitor.temperature.has_value()) << step;
  }
}

// The goal of one exchange for the whole status: 5 drives at 19200 take at most 0.75 of a loop that reads coils and registers with
// gaps of 0.24 ms, which no drive's manual allows.
TEST(Map, makesTheRefreshOfFiveDrivesShorterThanThePlainLoop)
{
  std::string yaml = "port: /dev/virtual\nbaud_rate: 19200\nscan_list:\n";
  std::string simulation = "simulation:\n";
  for (int node = 1; node <= 5; ++node)
  {
    const std::string name = "belt_" + std::to_string(node);
    yaml += "  - {name: " + name + ", node: " + std::to_string(node) +
            ", drive: omron_mx2, confirm: [register_map], skip: [output_voltage, dc_voltage, torque, temperature, "
            "warning_code]}\n";
    simulation += "  " + name + ": {turnaround: 0.00318, parameters: {" + FITS + "}}\n";
  }
  VirtualBus bus(yaml + simulation);
  bus.settleIn();
  bus.run(5.0);
  std::vector<double> periods;
  TimePoint last = bus.status(0).stamp;
  bus.runUntil(10.0, [&] {
    if (bus.status(0).stamp != last)
    {
      periods.push_back(toSeconds(bus.status(0).stamp - last));
      last = bus.status(0).stamp;
    }
    return false;
  });
  ASSERT_GT(periods.size(), 50U);
  std::sort(periods.begin(), periods.end());
  const double median = periods[periods.size() / 2];
  // 37 characters of ten bits, two turnarounds of 5 ms and two gaps.
  const double plain_loop = 5 * (37 * 10 / 19200.0 + 2 * 0.005 + 2 * 0.00024);
  RecordProperty("ratio", std::to_string(median / plain_loop));
  EXPECT_LT(median / plain_loop, 0.70) << "and 7.5 % for slow values";
}

TEST(ConfigureMap, writesWhatDiffersOnceStoresItAndSaysThatAPowerCycleIsNeeded)
{
  VirtualBus bus(belt(std::string(CONFIRMED) + ", configure_map: true", ""));
  bus.settleIn();
  bus.run(5.0);
  EXPECT_THAT(bus.logTexts(),
              Contains("belt: configure_map: writing 5 parameters and storing them in the drive's EEPROM, once"));
  EXPECT_THAT(bus.logTexts(), Contains(AllOf(HasSubstr("belt: configure_map: stored in the EEPROM"),
                                             HasSubstr("switch the drive off and on"))));
  EXPECT_EQ("ok P201 ram=4101 eeprom=4101", bus.world("belt get P201"));
  EXPECT_EQ("ok P302 ram=7937 eeprom=7937", bus.world("belt get P302"));
  EXPECT_EQ("ok P200 ram=1 eeprom=1", bus.world("belt get P200"));
  EXPECT_EQ("ok P221 ram=1.000 eeprom=1.000", bus.world("belt get P221"));
  EXPECT_EQ(1.0, bus.motor("belt", "eeprom_writes"));
  expectPlain(bus, 1.0);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("switch the drive off and on"));

  bus.world("belt power_cycle 4");
  bus.run(15.0);
  expectMapped(bus, 1.0);
  EXPECT_EQ(1.0, bus.motor("belt", "eeprom_writes")) << "once";
}

TEST(ConfigureMap, neverWritesOver1006h)
{
  VirtualBus bus(belt(std::string(CONFIRMED) + ", configure_map: true", FITS));
  bus.settleIn();
  bus.stream(0, 40.0, 0.1, 3.0);
  bus.run(6.0);
  for (const std::string& request : bus.requests())
  {
    EXPECT_THAT(request, Not(testing::MatchesRegex("01 (06|10|17) 10 0[45].*"))) << "wire 1004h, 1005h";
  }
  EXPECT_EQ(0.0, bus.motor("belt", "eeprom_writes")) << "it fits already";
}

TEST(ConfigureMap, leavesAMapAloneThatIsInOtherUse)
{
  VirtualBus bus(belt(std::string(CONFIRMED) + ", configure_map: true", "P200: 1, P201: 0x4001, P301: 0x1212"));
  bus.settleIn();
  bus.run(5.0);
  EXPECT_EQ(0.0, bus.motor("belt", "eeprom_writes"));
  EXPECT_EQ(0U, bus.count("01 06 16"));
  EXPECT_THAT(bus.logTexts(),
              Contains(AllOf(HasSubstr("in other use"), HasSubstr("P201 = 0x4001"), HasSubstr("P301 = 0x1212"),
                             HasSubstr("P201 = 0x1005"), HasSubstr("P301 = 0x1E01"))));
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("in other use"));
  expectPlain(bus, 0.5);
}

TEST(ConfigureMap, writesNothingWhileTheMotorTurns)
{
  VirtualBus bus(belt(std::string(CONFIRMED) + ", configure_map: true", ""));
  bus.world("belt panel 20");
  bus.run(8.0);
  EXPECT_EQ(0.0, bus.motor("belt", "eeprom_writes"));
  EXPECT_EQ(0U, bus.count("01 06 16"));
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("it is written while the motor is at rest"));
}

TEST(ConfigureMap, isNotUsedBeforeSomebodyConfirmsTheRead)
{
  VirtualBus bus(belt(", configure_map: true", FITS));
  bus.settleIn();
  bus.run(4.0);
  expectPlain(bus, 0.5);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("confirm: [register_map]"));
}
}  // namespace
}  // namespace inverter_bus

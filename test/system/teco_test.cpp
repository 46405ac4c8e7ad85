// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// TECO 7200MA on a whole bus in virtual time: what is missing, the broadcast stop, the drive's own time-out.

#include <gmock/gmock.h>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
using ::testing::HasSubstr;
using ::testing::Not;

const char* const AS_SHIPPED = R"(
port: /dev/virtual
baud_rate: 9600
parity: even
scan_list:
  - {name: mixer, node: 3, drive: teco_7200ma}
)";

const char* const ARMED = R"(
port: /dev/virtual
baud_rate: 9600
parity: even
defaults:
  drive: teco_7200ma
  confirm: [run_forward, fault_reset, frequency_scale, monitor_layout, fault_coding]
  overrides: {reverse_word: 2, monitor_base: 0x0020}
scan_list:
  - {name: mixer, node: 3}
)";

const char* const THREE_ARMED = R"(
port: /dev/virtual
baud_rate: 9600
parity: even
defaults:
  drive: teco_7200ma
  confirm: [run_forward, fault_reset, frequency_scale]
  overrides: {reverse_word: 2, monitor_base: 0x0020}
scan_list:
  - {name: mixer_1, node: 3}
  - {name: mixer_2, node: 4}
  - {name: mixer_3, node: 5}
)";

// 7200MA application manual, table 1; the check sum is left out.
constexpr const char* BROADCAST_STOP = "00 10 00 00 00 01 02 00 00";
constexpr const char* STOP = "03 10 00 00 00 01 02 00 00";
constexpr const char* FORWARD = "03 10 00 00 00 01 02 00 01";
constexpr const char* SET_FREQUENCY = "03 10 00 01";
constexpr const char* LOOP_BACK = "03 08";
constexpr const char* REVERSE = "03 10 00 00 00 01 02 00 02";

TEST(Teco, asShippedItTellsNothingAndRunsNothing)
{
  VirtualBus bus(AS_SHIPPED);
  bus.run(3.0);
  ASSERT_TRUE(bus.hasStatus(0));
  EXPECT_FALSE(bus.status(0).communication_error);
  EXPECT_FALSE(bus.status(0).monitor.output_frequency);
  EXPECT_FALSE(bus.status(0).monitor.running);
  EXPECT_FALSE(bus.status(0).monitor.faulted);
  bus.clearFrames();
  EXPECT_EQ(bus.command(0, 10.0), bus::ERROR_NOT_ARMED);
  bus.run(0.5);
  EXPECT_EQ(bus.count("03 10"), 0U);
  EXPECT_THAT(bus.status(0).error_text, HasSubstr("run_forward"));
  EXPECT_THAT(bus.status(0).error_text, HasSubstr("frequency_scale"));
  EXPECT_EQ(bus.command(0, -10.0), bus::ERROR_NOT_ARMED);
  bus.run(0.5);
  EXPECT_THAT(bus.status(0).error_text, HasSubstr("reverse_word"));
}

TEST(Teco, asShippedTheRestIsRefusedAndNamed)
{
  VirtualBus bus(AS_SHIPPED);
  bus.run(3.0);
  EXPECT_EQ(bus.wait(bus.reset(0)).error_id, bus::ERROR_NOT_ARMED);
  EXPECT_EQ(bus.wait(bus.readParameter(0, "Sn-36")).error_id, bus::ERROR_NOT_ARMED);
  EXPECT_EQ(bus.wait(bus.readParameter(0, "Un-02")).error_id, bus::ERROR_NOT_ARMED);
  EXPECT_EQ(bus.wait(bus.writeParameter(0, "Cn-27", 2.0, true)).error_id, bus::ERROR_NOT_ARMED);
  EXPECT_EQ(bus.wait(bus.readFaults(0)).error_id, bus::ERROR_NOT_OFFERED);
  for (const char* name :
       { "run_forward", "run_reverse", "reverse_word", "fault_reset", "frequency_scale", "monitor_base" })
  {
    EXPECT_THAT(bus.diagnostics(0), HasSubstr(name));
  }
}

TEST(Teco, aDriveThatCantTellIsStoppedAtStartUpToBeSure)
{
  VirtualBus bus(AS_SHIPPED);
  bus.world("bus foreign 03 10 00 01 00 01 02 07 D0");
  bus.pass(0.5);
  bus.world("bus foreign 03 10 00 00 00 01 02 00 01");
  bus.pass(0.5);
  ASSERT_EQ(bus.motor("mixer", "run_command"), 1.0);
  bus.run(3.0);
  EXPECT_EQ(bus.motor("mixer", "run_command"), 0.0);
  EXPECT_EQ(bus.count(STOP), 1U);
}

TEST(Teco, stopWorksAsShipped)
{
  VirtualBus bus(AS_SHIPPED);
  bus.run(3.0);
  const auto answer = bus.wait(bus.stop(0));
  EXPECT_TRUE(answer.success) << answer.message;
}

TEST(Teco, aLateReplyToARunFrameConfirmsNoStop)
{
  // The replies to all writes of 0000H look alike, and nobody can ask this drive whether RUN is on.
  VirtualBus bus(ARMED);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 5.0);
  ASSERT_TRUE(bus.runUntil(3.0, [&] { return bus.count(SET_FREQUENCY) == 1; }));
  // It executes the RUN, and is deaf until it has answered: the stop's frame is lost.
  bus.world("mixer late 0.13 count 1 function 0x10");
  ASSERT_TRUE(bus.runUntil(3.0, [&] { return bus.count(FORWARD) == 1; }));
  const auto answer = bus.stop(0);
  ASSERT_TRUE(bus.runUntil(3.0, [&] { return bus.count(STOP) == 1; }));
  ASSERT_EQ(bus.motor("mixer", "run_command"), 1.0) << "the stop's first frame was not lost";
  EXPECT_TRUE(bus.wait(answer).success);
  EXPECT_EQ(bus.motor("mixer", "run_command"), 0.0);
  EXPECT_GE(bus.count(STOP), 2U);
  EXPECT_GE(bus.count(LOOP_BACK), 1U) << "only a loop-back shows that no other reply can be on its way";
}

TEST(Teco, withWhatTheUserSuppliesEverythingWorks)
{
  VirtualBus bus(ARMED);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 30.0);
  bus.run(30.0);
  EXPECT_EQ(bus.count(FORWARD), 1U);
  EXPECT_NEAR(bus.motor("mixer", "frequency"), 20.0, 0.01);
  EXPECT_NEAR(*bus.status(0).monitor.output_frequency, 20.0, 0.01);
  EXPECT_EQ(bus.status(0).monitor.direction, 1);
  ASSERT_TRUE(bus.status(0).monitor.output_current);
  EXPECT_NEAR(*bus.status(0).monitor.output_current, bus.motor("mixer", "current"), 0.06);
  bus.stream(0, -10.0, 0.1, 30.0);
  bus.run(30.0);
  EXPECT_EQ(bus.count(REVERSE), 1U);
  EXPECT_EQ(bus.status(0).monitor.direction, -1);
  EXPECT_NEAR(*bus.status(0).monitor.output_frequency, 10.0, 0.01);
  EXPECT_TRUE(bus.wait(bus.stop(0)).success);
  bus.run(30.0);
  EXPECT_EQ(bus.motor("mixer", "frequency"), 0.0);
}

TEST(Teco, tripsAreShownAndResetAndNothingRunsAfterwards)
{
  VirtualBus bus(ARMED);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 3.0);
  bus.run(3.0);
  bus.world("mixer trip 20");
  EXPECT_TRUE(bus.runUntil(2.0, [&] { return bus.status(0).monitor.faulted.value_or(false); }));
  EXPECT_EQ(bus.status(0).monitor.fault_code, 20);
  bus.run(1.0);
  const auto answer = bus.wait(bus.reset(0));
  EXPECT_TRUE(answer.success) << answer.message;
  bus.clearFrames();
  bus.run(3.0);
  EXPECT_EQ(bus.motor("mixer", "tripped"), 0.0);
  EXPECT_EQ(bus.motor("mixer", "run_command"), 0.0);
  EXPECT_EQ(bus.count(FORWARD), 0U);
}

TEST(Teco, aStopOfAllGoesToEveryDriveInOneFrameFirst)
{
  VirtualBus bus(THREE_ARMED);
  bus.settleIn();
  for (std::size_t index = 0; index < 3; ++index)
  {
    bus.stream(index, 20.0, 0.2, 5.0);
  }
  bus.run(5.0);
  bus.clearFrames();
  const auto answer = bus.wait(bus.stop(std::nullopt));
  EXPECT_TRUE(answer.success) << answer.message;
  const auto requests = bus.requests();
  const auto broadcast = std::find(requests.begin(), requests.end(), BROADCAST_STOP);
  ASSERT_NE(broadcast, requests.end());
  // At most the exchange that was on the wire came before it.
  EXPECT_LE(broadcast - requests.begin(), 1);
  EXPECT_EQ(bus.count("00"), 1U);
  for (const char* name : { "mixer_1", "mixer_2", "mixer_3" })
  {
    EXPECT_EQ(bus.motor(name, "run_command"), 0.0) << name;
  }
  bus.clearFrames();
  EXPECT_TRUE(bus.wait(bus.stop(1)).success);
  EXPECT_EQ(bus.count("00"), 0U) << "the stop of one drive is none of all";
}

TEST(Teco, aStopOfAllOnAMixedBusTouchesNoOtherRegister)
{
  VirtualBus bus(R"(
port: /dev/virtual
baud_rate: 9600
parity: even
scan_list:
  - {name: belt, node: 1, drive: omron_mx2}
  - {name: pump, node: 2, drive: toshiba_vfs15}
  - {name: mixer, node: 3, drive: teco_7200ma}
)");
  bus.run(10.0);
  bus.world("pump set AU1 2");
  const double writes = bus.motor("pump", "eeprom_writes");
  bus.clearFrames();
  const auto answer = bus.wait(bus.stop(std::nullopt));
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(bus.count("00"), 0U);
  EXPECT_THAT(bus.world("pump get AU1"), HasSubstr("ram=2"));
  EXPECT_EQ(bus.motor("pump", "eeprom_writes"), writes);
}

TEST(Teco, theAlarmNeverComesWhileTheBudgetAllowsIt)
{
  VirtualBus bus(THREE_ARMED);
  bus.settleIn();
  bus.stream(0, 20.0, 0.3, 60.0);
  for (int call = 0; call < 100; ++call)
  {
    bus.at(0.5 * call, [&bus] { bus.readParameter(1, "0x0020"); });
  }
  bus.run(60.0);
  for (const char* name : { "mixer_1", "mixer_2", "mixer_3" })
  {
    EXPECT_EQ(bus.motor(name, "alarms"), 0.0) << name;
  }
}

TEST(Teco, commandsGetThroughWhereSomeDriveIsAlwaysDue)
{
  std::string yaml = R"(
port: /dev/virtual
baud_rate: 9600
parity: even
defaults:
  drive: teco_7200ma
  confirm: [run_forward, fault_reset, frequency_scale, monitor_layout, fault_coding]
  overrides: {reverse_word: 2, monitor_base: 0x0020}
scan_list:
)";
  for (int node = 1; node <= 7; ++node)
  {
    yaml += "  - {name: mixer_" + std::to_string(node) + ", node: " + std::to_string(node) + "}\n";
  }
  VirtualBus bus(yaml);
  bus.settleIn(15.0);
  for (std::size_t index = 0; index < 7; ++index)
  {
    bus.stream(index, 10.0 + static_cast<double>(index), 0.1, 8.0);
  }
  bus.run(6.0);
  for (int node = 1; node <= 7; ++node)
  {
    EXPECT_EQ(bus.motor("mixer_" + std::to_string(node), "run_command"), 1.0) << node;
  }
}

TEST(Teco, theBudgetSaysWhenADriveCantBeServedInTime)
{
  std::string yaml = "port: /dev/virtual\nbaud_rate: 1200\nparity: even\ndefaults: {drive: teco_7200ma}\nscan_list:\n";
  for (int node = 1; node <= 8; ++node)
  {
    yaml += "  - {name: mixer_" + std::to_string(node) + ", node: " + std::to_string(node) + "}\n";
  }
  VirtualBus bus(yaml);
  std::string warnings;
  for (const bus::Finding& finding : bus.coordinator().budget())
  {
    warnings += finding.level == bus::Level::Warn ? finding.text + "\n" : "";
  }
  EXPECT_THAT(warnings, HasSubstr("mixer_1: its own communication time-out of 1000.0 ms"));
}

TEST(Teco, loopBackIsTheProbeOfAnOfflineDrive)
{
  VirtualBus bus(ARMED);
  bus.settleIn();
  bus.world("mixer offline");
  ASSERT_TRUE(bus.runUntil(10.0, [&] { return bus.status(0).communication_error; }));
  bus.clearFrames();
  bus.run(5.0);
  EXPECT_GT(bus.count("03 08 00 00"), 0U);
  bus.world("mixer online");
  EXPECT_TRUE(bus.runUntil(3.0, [&] { return !bus.status(0).communication_error; }));
}

TEST(Teco, thirtyOneStationsAreServed)
{
  std::string yaml = "port: /dev/virtual\nbaud_rate: 9600\nparity: even\ndefaults: {drive: teco_7200ma}\nscan_list:\n";
  for (int node = 1; node <= 31; ++node)
  {
    yaml += "  - {name: mixer_" + std::to_string(node) + ", node: " + std::to_string(node) + "}\n";
  }
  VirtualBus bus(yaml);
  const bool all = bus.runUntil(60.0, [&] {
    for (std::size_t index = 0; index < 31; ++index)
    {
      if (!bus.hasStatus(index) || bus.status(index).communication_error || bus.status(index).locked)
      {
        return false;
      }
    }
    return true;
  });
  EXPECT_TRUE(all);
  EXPECT_TRUE(bus.wait(bus.stop(std::nullopt), 60.0).success);
}
}  // namespace
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// 3G3JE over CompoWay/F on a whole bus in virtual time: the same scheduler, other frames.

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
protocol: compoway_f
baud_rate: 9600
scan_list:
  - {name: fan, node: 1, drive: omron_3g3je}
)";

/// The codes are those that the simulated drive was given; the manual's own are not public.
const char* const ARMED = R"(
port: /dev/virtual
protocol: compoway_f
baud_rate: 9600
defaults:
  drive: omron_3g3je
  confirm: [current_scale, controller_status_meaning]
  overrides:
    operation_codes: {run_forward: "1101", run_reverse: "1102", stop: "1100", fault_reset: "1201", ram_write_mode: "1401",
                      setup_area_0: "1700", setup_area_1: "1701"}
scan_list:
  - {name: fan_1, node: 0}
  - {name: fan_2, node: 2}
)";

/// Command texts that the master has sent to a node.
std::size_t sent(const VirtualBus& bus, const std::string& text)
{
  std::size_t count = 0;
  for (const auto& frame : bus.frames())
  {
    const std::string bytes(frame.bytes.begin(), frame.bytes.end());
    count += frame.source == simulation::FrameRecord::Source::Master && bytes.find(text) != std::string::npos ? 1 : 0;
  }
  return count;
}

TEST(Compoway, asShippedItReadsAndSendsNoOperation)
{
  VirtualBus bus(AS_SHIPPED);
  bus.run(5.0);
  ASSERT_TRUE(bus.hasStatus(0));
  EXPECT_FALSE(bus.status(0).communication_error);
  ASSERT_TRUE(bus.status(0).monitor.output_frequency);
  EXPECT_EQ(*bus.status(0).monitor.output_frequency, 0.0);
  EXPECT_EQ(bus.status(0).model, "3G3JE202BF");
  EXPECT_EQ(bus.command(0, 10.0), bus::ERROR_NOT_ARMED);
  bus.run(0.5);
  EXPECT_THAT(bus.status(0).error_text, HasSubstr("run_forward"));
  EXPECT_THAT(bus.status(0).error_text, HasSubstr("I548"));
  EXPECT_THAT(bus.status(0).error_text, HasSubstr("2-14"));
  EXPECT_EQ(bus.wait(bus.reset(0)).error_id, bus::ERROR_NOT_ARMED);
  EXPECT_EQ(bus.wait(bus.readFaults(0)).error_id, bus::ERROR_NOT_OFFERED);
  EXPECT_EQ(bus.wait(bus.stop(0)).error_id, bus::ERROR_NOT_ARMED);
  EXPECT_EQ(sent(bus, "3005"), 0U);
}

TEST(Compoway, asShippedParametersAreReadButNotWritten)
{
  VirtualBus bus(AS_SHIPPED);
  bus.run(5.0);
  const auto read = bus.wait(bus.readParameter(0, "P06"));
  EXPECT_TRUE(read.success) << read.message;
  EXPECT_DOUBLE_EQ(read.value, 60.0);
  EXPECT_EQ(read.unit, "Hz");
  const auto by_place = bus.wait(bus.readParameter(0, "C3/0005"));
  EXPECT_DOUBLE_EQ(by_place.value, 60.0) << by_place.message;
  for (const bool persist : { false, true })
  {
    const auto write = bus.wait(bus.writeParameter(0, "P06", 70.0, persist));
    EXPECT_EQ(write.error_id, bus::ERROR_NOT_ARMED) << write.message;
  }
  const auto beyond = bus.wait(bus.readParameter(0, "C3/0FFF"));
  EXPECT_EQ(beyond.error_id, 0x1103) << beyond.message;
  EXPECT_THAT(beyond.message, HasSubstr("1103"));
}

TEST(Compoway, runsChangesReversesAndStops)
{
  VirtualBus bus(ARMED);
  bus.settleIn();
  bus.stream(0, 20.0, 0.2, 30.0);
  bus.run(30.0);
  EXPECT_NEAR(std::abs(bus.motor("fan_1", "frequency")), 20.0, 0.05);
  EXPECT_NEAR(*bus.status(0).monitor.output_frequency, 20.0, 0.05);
  EXPECT_EQ(bus.motor("fan_1", "direction"), 1);
  EXPECT_EQ(bus.motor("fan_2", "frequency"), 0.0);
  bus.stream(0, -30.0, 0.2, 30.0);
  bus.run(30.0);
  EXPECT_NEAR(std::abs(bus.motor("fan_1", "frequency")), 30.0, 0.05);
  EXPECT_EQ(bus.motor("fan_1", "direction"), -1);
  const auto answer = bus.wait(bus.stop(0));
  EXPECT_TRUE(answer.success) << answer.message;
  bus.run(30.0);
  EXPECT_EQ(bus.motor("fan_1", "frequency"), 0.0);
}

TEST(Compoway, ramModeIsSetAtConnectAndAfterEveryReturn)
{
  VirtualBus bus(ARMED);
  bus.settleIn();
  for (double velocity = 10.0; velocity < 20.0; velocity += 1.0)
  {
    bus.command(0, velocity);
    bus.run(0.4);
  }
  EXPECT_EQ(bus.motor("fan_1", "eeprom_writes"), 0.0);
  bus.world("fan_1 power_cycle 3");
  bus.run(15.0);
  bus.command(0, 0.0);
  bus.clearFrames();
  for (double velocity = 10.0; velocity < 15.0; velocity += 1.0)
  {
    bus.command(0, velocity);
    bus.run(0.4);
  }
  EXPECT_GT(bus.motor("fan_1", "frequency"), 0.0);
  EXPECT_EQ(bus.motor("fan_1", "eeprom_writes"), 0.0);
}

TEST(Compoway, withoutRamModeWritesAreCountedAndAWarningSaysSo)
{
  VirtualBus bus(R"(
port: /dev/virtual
protocol: compoway_f
baud_rate: 9600
scan_list:
  - {name: fan, node: 1, drive: omron_3g3je, overrides: {operation_codes: {run_forward: "1101", stop: "1100"}}}
)");
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 5.0);
  bus.run(4.0);
  EXPECT_EQ(bus.motor("fan", "eeprom_writes"), 1.0) << "written only when it changes";
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("EEPROM (1 writes so far)"));
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("ram_write_mode"));
}

TEST(Compoway, parametersAreWrittenThroughTheSetupAreaAtStandstillOnly)
{
  VirtualBus bus(ARMED);
  bus.settleIn();
  bus.stream(0, 20.0, 0.2, 5.0);
  bus.run(4.0);
  EXPECT_EQ(bus.wait(bus.writeParameter(0, "P06", 70.0, false)).error_id, bus::ERROR_NOT_OFFERED);
  EXPECT_TRUE(bus.wait(bus.stop(0)).success);
  bus.run(30.0);
  const auto answer = bus.wait(bus.writeParameter(0, "P06", 70.0, false));
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_DOUBLE_EQ(bus.wait(bus.readParameter(0, "P06")).value, 70.0);
  EXPECT_EQ(bus.motor("fan_1", "setup_area"), 0.0);
  const auto outside = bus.wait(bus.writeParameter(0, "P06", 700.0, false));
  EXPECT_EQ(outside.error_id, bus::ERROR_OUT_OF_RANGE);
}

TEST(Compoway, aDriveThatIsSetToItsTerminalsIsNamed)
{
  VirtualBus bus(AS_SHIPPED);
  bus.world("fan set P10 1");
  bus.run(10.0);
  EXPECT_THAT(bus.diagnostics(0), HasSubstr("not commanded by the bus"));
}

TEST(Compoway, aResetIsSentOnlyAfterAConfirmedStop)
{
  VirtualBus bus(ARMED);
  bus.settleIn();
  bus.stream(0, 20.0, 0.2, 3.0);
  bus.run(3.0);
  bus.world("fan_1 trip 3");
  bus.run(1.0);
  bus.clearFrames();
  const auto answer = bus.wait(bus.reset(0));
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(sent(bus, "30051201"), 1U);
  EXPECT_EQ(bus.motor("fan_1", "tripped"), 0.0);
  EXPECT_EQ(bus.motor("fan_1", "run_command"), 0.0);
  bus.run(10.0);
  EXPECT_EQ(bus.motor("fan_1", "frequency"), 0.0);
}

TEST(Compoway, aLostReplyIsFollowedByAnEchobackTest)
{
  VirtualBus bus(ARMED);
  bus.settleIn();
  bus.world("fan_1 late 0.5 count 1");
  bus.run(3.0);
  EXPECT_GT(sent(bus, "0801"), 0U);
  EXPECT_FALSE(bus.status(0).communication_error);
}

TEST(Compoway, anotherModelGetsNoCommand)
{
  VirtualBus bus(R"(
port: /dev/virtual
protocol: compoway_f
baud_rate: 9600
scan_list:
  - name: fan
    node: 1
    drive: omron_3g3je
    overrides: {identity: [{model: 3G3XX}], operation_codes: {run_forward: "1101", stop: "1100"}}
)");
  bus.run(5.0);
  EXPECT_EQ(bus.command(0, 10.0), bus::ERROR_NOT_ARMED);
  bus.run(1.0);
  EXPECT_THAT(bus.status(0).error_text, HasSubstr("wrong drive"));
  EXPECT_EQ(bus.motor("fan", "run_command"), 0.0);
}
}  // namespace
}  // namespace inverter_bus

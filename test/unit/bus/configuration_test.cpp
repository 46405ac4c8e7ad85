// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/bus/configuration.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// The profiles as shipped; CMake tells where.
const std::string PROFILES = std::string(INVERTER_BUS_ROOT) + "/config/drives";

/// A scan list file that is gone after the test.
class ScanListFile
{
public:
  explicit ScanListFile(const std::string& text)
    : path_(testing::TempDir() + "bus_configuration_test_" + std::to_string(getpid()) + ".yaml")
  {
    std::ofstream(path_) << text;
  }
  ~ScanListFile()
  {
    std::remove(path_.c_str());
  }
  const std::string& path() const
  {
    return path_;
  }

private:
  std::string path_;
};

Configuration read(const std::string& text)
{
  const ScanListFile file(text);
  return readConfiguration(readYamlFile(file.path()), "~", PROFILES);
}

/// The message that \p text is refused with; empty: it was accepted.
std::string refusal(const std::string& text)
{
  try
  {
    read(text);
  }
  catch (const drive::ConfigurationError& error)
  {
    return error.what();
  }
  return "";
}

const std::string ONE = "scan_list: [{name: belt, node: 1, drive: omron_mx2}]\n";

/// A scan list of one MX2 with \p more in its entry.
std::string entry(const std::string& more)
{
  return "scan_list: [{name: belt, node: 1, drive: omron_mx2, " + more + "}]\n";
}

TEST(ConfigurationTest, defaultsAreThoseOfTheContract)
{
  const Configuration configuration = read(ONE);
  const BusConfig& bus = configuration.bus;
  EXPECT_EQ("/dev/ttyUSB0", bus.port);
  EXPECT_EQ(19200U, bus.serial.baud_rate);
  EXPECT_EQ(wire::Parity::None, bus.serial.parity);
  EXPECT_EQ(8U, bus.serial.data_bits);
  EXPECT_EQ(1U, bus.serial.stop_bits);
  EXPECT_EQ(wire::Rs485::Auto, bus.serial.rs485);
  EXPECT_DOUBLE_EQ(0.0, bus.interval);
  EXPECT_DOUBLE_EQ(0.1, bus.response_timeout);
  EXPECT_EQ(1, bus.retries);
  EXPECT_EQ(3, bus.offline_after);
  EXPECT_TRUE(bus.exclusive);
  EXPECT_TRUE(bus.serial.exclusive);
  EXPECT_EQ(0, bus.realtime_priority);
  EXPECT_EQ(1, bus.idle_divisor);
  EXPECT_FALSE(bus.parameters_read_only);
  EXPECT_EQ("~/.ros/inverter_bus", bus.trace_directory);
  ASSERT_EQ(1U, bus.inverters.size());
  EXPECT_DOUBLE_EQ(1.0, bus.inverters[0].hz_per_unit);
  EXPECT_DOUBLE_EQ(0.0, bus.inverters[0].min_velocity);
  EXPECT_DOUBLE_EQ(0.5, bus.inverters[0].command_timeout);
  EXPECT_FALSE(bus.inverters[0].stop_unexpected_motion);
  EXPECT_FALSE(bus.inverters[0].release_on_exit);
  EXPECT_FALSE(bus.inverters[0].configure_block);
  EXPECT_EQ((std::vector<int>{ 1, 2, 3, 4, 14 }), bus.inverters[0].block_read);
}

TEST(ConfigurationTest, allKeysOfTheBusAreRead)
{
  const BusConfig bus = read(
                            "port: /dev/ttyS3\nprotocol: modbus_rtu\nbaud_rate: 9600\nparity: even\ndata_bits: 8\n"
                            "stop_bits: 1\nrs485: rts_low\ninterval: 2\nresponse_timeout: 0.25\nretries: 0\n"
                            "offline_after: 5\nexclusive: false\nrealtime_priority: 10\nidle_divisor: 4\n"
                            "parameter_access: read_only\ntrace_directory: /tmp/traces\nsimulation: {seed: 1}\n" +
                            ONE)
                            .bus;
  EXPECT_EQ("/dev/ttyS3", bus.port);
  EXPECT_EQ("/dev/ttyS3", bus.serial.device);
  EXPECT_EQ(9600U, bus.serial.baud_rate);
  EXPECT_EQ(wire::Parity::Even, bus.serial.parity);
  EXPECT_EQ(wire::Rs485::RtsLow, bus.serial.rs485);
  EXPECT_DOUBLE_EQ(2.0, bus.interval);
  EXPECT_DOUBLE_EQ(0.25, bus.response_timeout);
  EXPECT_EQ(0, bus.retries);
  EXPECT_EQ(5, bus.offline_after);
  EXPECT_FALSE(bus.serial.exclusive);
  EXPECT_EQ(10, bus.realtime_priority);
  EXPECT_EQ(4, bus.idle_divisor);
  EXPECT_TRUE(bus.parameters_read_only);
  EXPECT_EQ("/tmp/traces", bus.trace_directory);
}

TEST(ConfigurationTest, aBaudRateNeedNotBeOneOfTheUsualOnes)
{
  // C071 = 09 of an MX2.
  EXPECT_EQ(76800U, read("baud_rate: 76800\n" + ONE).bus.serial.baud_rate);
}

TEST(ConfigurationTest, thePauseInAReplyGoesIntoTheTiming)
{
  const auto pause = [](const std::string& keys) { return toSeconds(makeTiming(read(keys + ONE).bus).patience(0.0)); };
  EXPECT_NEAR(0.025, pause(""), 1e-9);
  EXPECT_NEAR(0.075, pause("baud_rate: 2400\n"), 1e-9);
  EXPECT_NEAR(0.1, pause("port: tcp://10.0.0.7\n"), 1e-9);
  EXPECT_NEAR(0.3, pause("response_timeout: 0.5\npause_in_reply: 0.3\n"), 1e-9);
  EXPECT_NEAR(0.3, pause("port: tcp://10.0.0.7\nresponse_timeout: 0.5\npause_in_reply: 0.3\n"), 1e-9);
}

TEST(ConfigurationTest, invertersComeInNodeOrderWithTheirDrives)
{
  const Configuration configuration = read(
      "scan_list:\n"
      "  - {name: last, node: 9, drive: omron_rx}\n"
      "  - {name: first, node: 2, drive: omron_mx2}\n");
  ASSERT_EQ(2U, configuration.bus.inverters.size());
  ASSERT_EQ(2U, configuration.drives.size());
  EXPECT_EQ("first", configuration.bus.inverters[0].name);
  EXPECT_EQ("omron_mx2", configuration.drives[0].profile().name);
  EXPECT_EQ(9, configuration.bus.inverters[1].node);
  EXPECT_EQ("omron_rx", configuration.drives[1].profile().name);
}

TEST(ConfigurationTest, anEntryGoesBeforeTheDefaults)
{
  const BusConfig bus = read(
                            "defaults: {drive: omron_mx2, command_timeout: 1, hz_per_unit: 2.0}\n"
                            "scan_list: [{name: a, node: 1}, {name: b, node: 2, command_timeout: 0.0}]\n")
                            .bus;
  EXPECT_DOUBLE_EQ(1.0, bus.inverters[0].command_timeout);
  EXPECT_DOUBLE_EQ(0.0, bus.inverters[1].command_timeout);
  EXPECT_DOUBLE_EQ(2.0, bus.inverters[1].hz_per_unit);
}

TEST(ConfigurationTest, theResponseTimeoutOfTheEntryGoesBeforeDefaultsAndBus)
{
  const std::string bus = "response_timeout: 0.3\n";
  const std::string defaults = "defaults: {response_timeout: 0.2}\n";
  EXPECT_DOUBLE_EQ(0.3, read(bus + ONE).bus.inverters[0].response_timeout);
  EXPECT_DOUBLE_EQ(0.2, read(bus + defaults + ONE).bus.inverters[0].response_timeout);
  EXPECT_DOUBLE_EQ(0.4, read(bus + defaults + entry("response_timeout: 0.4")).bus.inverters[0].response_timeout);
}

TEST(ConfigurationTest, theMaximumVelocityIsThatOfTheDrive)
{
  const Configuration configuration = read(entry("hz_per_unit: -4.0"));
  const double maximum = configuration.drives[0].profile().maximum_frequency;
  EXPECT_DOUBLE_EQ(maximum / 4.0, configuration.bus.inverters[0].max_velocity);
  // Written by hand, the same maximum must not fail by rounding.
  EXPECT_EQ("", refusal(entry("hz_per_unit: 0.3, max_velocity: " + std::to_string(maximum / 0.3))));
}

struct Mask
{
  std::string text;
  std::vector<int> nodes;
};

class MaskTest : public testing::TestWithParam<Mask>
{
};

TEST_P(MaskTest, namesItsStations)
{
  const BusConfig bus = read("defaults: {drive: omron_mx2}\nscan_list: " + GetParam().text + "\n").bus;
  ASSERT_EQ(GetParam().nodes.size(), bus.inverters.size());
  for (std::size_t i = 0; i < bus.inverters.size(); ++i)
  {
    EXPECT_EQ(GetParam().nodes[i], bus.inverters[i].node);
    EXPECT_EQ("inverter_" + std::to_string(GetParam().nodes[i]), bus.inverters[i].name);
  }
}

INSTANTIATE_TEST_SUITE_P(Forms, MaskTest,
                         testing::Values(Mask{ "2", { 1 } }, Mask{ "7", { 1, 2 } }, Mask{ "-2147483646", { 1, 31 } },
                                         Mask{ "'0x80000002'", { 1, 31 } }, Mask{ "'#80000002'", { 1, 31 } },
                                         Mask{ "'#0000000A'", { 1, 3 } }));

/// A wrong configuration and what the message must name.
struct Wrong
{
  std::string name;
  std::string text;
  std::vector<std::string> parts;
};

class RefusalTest : public testing::TestWithParam<Wrong>
{
};

TEST_P(RefusalTest, namesKeyValuePlaceAndWhatIsAllowed)
{
  const std::string message = refusal(GetParam().text);
  ASSERT_NE("", message) << "was accepted";
  EXPECT_EQ(std::string::npos, message.find('\n')) << message;
  for (const std::string& part : GetParam().parts)
  {
    EXPECT_THAT(message, HasSubstr(part));
  }
}

const std::string ALLOWED = "allowed:";
const std::string BELT = "~scan_list[0] (belt)";
const std::string FAN = "scan_list: [{name: fan, node: 1, drive: omron_3g3je}]\n";

INSTANTIATE_TEST_SUITE_P(
    Bus, RefusalTest,
    testing::Values(
        Wrong{ "unknownKey", "baudrate: 9600\n" + ONE, { "~:", "'baudrate'", "9600", "baud_rate", ALLOWED } },
        Wrong{ "emptyPort", "port: ''\n" + ONE, { "'port'", "''", ALLOWED } },
        Wrong{ "portNumber", "port: 5\n" + ONE, { "'port'", "5", "not a text", ALLOWED } },
        Wrong{
            "unknownNetwork", "port: udp://gateway\n" + ONE, { "'port'", "udp://gateway", "unknown kind", ALLOWED } },
        Wrong{ "tunnelWithoutPort", "port: rtu+tcp://gateway\n" + ONE, { "'port'", "rtu+tcp://gateway", ALLOWED } },
        Wrong{ "gatewayWithoutHost", "port: 'tcp://:502'\n" + ONE, { "'port'", "tcp://:502", ALLOWED } },
        Wrong{ "gatewayPortNumber", "port: 'tcp://plc:70000'\n" + ONE, { "'port'", "tcp://plc:70000", ALLOWED } },
        Wrong{ "compowayFOverTcp",
               "protocol: compoway_f\nport: tcp://gateway\n" + FAN,
               { "'protocol'", "compoway_f", "tcp://gateway", "modbus_rtu" } },
        Wrong{ "compowayFOverATunnel",
               "protocol: compoway_f\nport: rtu+tcp://gateway:4001\n" + FAN,
               { "'protocol'", "compoway_f", "rtu+tcp://gateway:4001" } },
        Wrong{ "modbusDriveOnCompowayF",
               "protocol: compoway_f\n" + ONE,
               { BELT, "'drive'", "omron_mx2", "compoway_f", ALLOWED } },
        Wrong{ "compowayFDriveOnModbus", FAN, { "(fan)", "'drive'", "omron_3g3je", "modbus_rtu", ALLOWED } },
        Wrong{ "modbusKeyOfACompowayFDrive",
               "protocol: compoway_f\nscan_list: [{name: fan, node: 0, drive: omron_3g3je, block_read: [1, 2, 3, 4, "
               "5]}]\n",
               { "(fan)", "'block_read'", "Modbus", ALLOWED } },
        Wrong{ "modbusOverrideOfACompowayFDrive",
               "protocol: compoway_f\nscan_list: [{name: fan, node: 1, drive: omron_3g3je, overrides: {limits: "
               "{functions: "
               "[3]}}}]\n",
               { "(fan)", "limits.functions", ALLOWED } },
        Wrong{ "stationHundredOfA3G3JE",
               "protocol: compoway_f\nscan_list: [{name: fan, node: 100, drive: omron_3g3je}]\n",
               { "(fan)", "'node'", "100", "from 0 to 99" } },
        Wrong{
            "runWithoutStopOfA3G3JE",
            "protocol: compoway_f\nscan_list: [{name: fan, node: 1, drive: omron_3g3je, overrides: {operation_codes: "
            "{run_forward: '1101'}}}]\n",
            { "(fan)", "'overrides'", "run without stop", ALLOWED } },
        Wrong{
            "operationCodeWithoutQuotes",
            "protocol: compoway_f\nscan_list: [{name: fan, node: 1, drive: omron_3g3je, overrides: {operation_codes: "
            "{stop: 1100}}}]\n",
            { "(fan)", "operation_codes.stop", "four hexadecimal digits in quotes" } },
        Wrong{ "stationThirtyTwoOfA7200MA",
               "baud_rate: 9600\nparity: even\nscan_list: [{name: fan, node: 32, drive: teco_7200ma}]\n",
               { "(fan)", "'node'", "32", "from 1 to 31" } },
        Wrong{ "oneStopBitWithoutParityOfA7200MA",
               "baud_rate: 9600\nscan_list: [{name: fan, node: 3, drive: teco_7200ma}]\n",
               { "'stop_bits'", "8N1", "fan", "8E1, 8N2, 8O1" } },
        Wrong{ "seventeenRegistersOfA7200MA",
               "baud_rate: 9600\nparity: even\nscan_list: [{name: fan, node: 3, drive: teco_7200ma, overrides: "
               "{limits: {read_registers: 170}}}]\n",
               { "(fan)", "limits.read_registers", "170", ALLOWED } },
        Wrong{ "unknownProtocol", "protocol: modbus\n" + ONE, { "'protocol'", "'modbus'", "allowed: modbus_rtu" } },
        Wrong{ "unknownBaudRate", "baud_rate: 19201\n" + ONE, { "'baud_rate'", "19201", "19200", ALLOWED } },
        Wrong{ "baudRateTooLow", "baud_rate: 49\n" + ONE, { "'baud_rate'", "49", "50 to 4000000", ALLOWED } },
        Wrong{ "baudRateTooHigh", "baud_rate: 4000001\n" + ONE, { "'baud_rate'", "50 to 4000000", ALLOWED } },
        Wrong{ "baudRateText", "baud_rate: '9600'\n" + ONE, { "'baud_rate'", "'9600'", ALLOWED } },
        Wrong{ "baudRateOfNoDrive", "baud_rate: 300\n" + ONE, { "'baud_rate'", "300", "belt", "omron_mx2", ALLOWED } },
        Wrong{ "unknownParity", "parity: mark\n" + ONE, { "'parity'", "'mark'", "none, even, odd" } },
        Wrong{ "sevenBits", "data_bits: 7\n" + ONE, { "'data_bits'", "7", "modbus_rtu", "allowed: 8" } },
        Wrong{ "fiveBits", "data_bits: 5\n" + ONE, { "'data_bits'", "5", "7, 8" } },
        Wrong{ "threeStopBits", "stop_bits: 3\n" + ONE, { "'stop_bits'", "3", "1, 2" } },
        Wrong{ "unknownRs485", "rs485: rts\n" + ONE, { "'rs485'", "'rts'", "auto, kernel, rts_high, rts_low" } },
        Wrong{ "negativeInterval", "interval: -0.1\n" + ONE, { "'interval'", "-0.1", "from 0 to 655.35 s" } },
        Wrong{ "negativeSlowInterval", "slow_interval: -1\n" + ONE, { "'slow_interval'", "-1", "from 0 to 3600 s" } },
        Wrong{ "slowIntervalNotANumber",
               "slow_interval: .nan\n" + ONE,
               { "'slow_interval'", "nan", "not finite", ALLOWED } },
        Wrong{ "longInterval", "interval: 655.36\n" + ONE, { "'interval'", "655.36", "from 0 to 655.35 s" } },
        Wrong{ "intervalText", "interval: fast\n" + ONE, { "'interval'", "'fast'", ALLOWED } },
        Wrong{ "intervalTruth", "interval: true\n" + ONE, { "'interval'", "true", "not a number", ALLOWED } },
        Wrong{ "intervalNotANumber", "interval: .nan\n" + ONE, { "'interval'", "nan", "not finite", ALLOWED } },
        Wrong{ "intervalInfinite", "interval: .inf\n" + ONE, { "'interval'", "inf", "not finite", ALLOWED } },
        Wrong{ "noResponseTimeout", "response_timeout: 0\n" + ONE, { "'response_timeout'", "= 0", "above 0", "10 s" } },
        Wrong{ "longResponseTimeout", "response_timeout: 10.5\n" + ONE, { "'response_timeout'", "10.5", "10 s" } },
        Wrong{ "negativeRetries", "retries: -1\n" + ONE, { "'retries'", "-1", "from 0 to 10" } },
        Wrong{ "manyRetries", "retries: 11\n" + ONE, { "'retries'", "11", "from 0 to 10" } },
        Wrong{ "brokenRetries", "retries: 1.5\n" + ONE, { "'retries'", "1.5", "whole number", "from 0 to 10" } },
        Wrong{ "offlineAfterNothing", "offline_after: 0\n" + ONE, { "'offline_after'", "0", "from 1 to 100" } },
        Wrong{ "exclusiveNumber", "exclusive: 1\n" + ONE, { "'exclusive'", "1", "true or false" } },
        Wrong{ "highPriority", "realtime_priority: 100\n" + ONE, { "'realtime_priority'", "100", "from 0 to 99" } },
        Wrong{ "idleDivisorZero", "idle_divisor: 0\n" + ONE, { "'idle_divisor'", "0", "from 1 to 1000" } },
        Wrong{ "parameterAccess", "parameter_access: none\n" + ONE, { "'parameter_access'", "read_write, read_only" } },
        Wrong{ "traceDirectoryNumber", "trace_directory: 5\n" + ONE, { "'trace_directory'", "5", ALLOWED } }),
    [](const testing::TestParamInfo<Wrong>& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    ScanList, RefusalTest,
    testing::Values(
        Wrong{ "missingList", "port: /dev/ttyS0\n", { "~:", "'scan_list' is missing", ALLOWED } },
        Wrong{ "emptyList", "scan_list: []\n", { "'scan_list'", "is empty", ALLOWED } },
        Wrong{ "listMap", "scan_list: {belt: {node: 1}}\n", { "'scan_list'", "neither", ALLOWED } },
        Wrong{ "listOfNumbers", "scan_list: [1, 2]\n", { "~scan_list[0]", "1", "not a map", ALLOWED } },
        Wrong{ "emptyMask", "scan_list: 0\n", { "'scan_list'", "= 0", "no station", ALLOWED } },
        Wrong{ "maskOfBitZero", "scan_list: '#00000001'\n", { "'scan_list'", "#00000001", "no station", ALLOWED } },
        Wrong{
            "longMask", "scan_list: 4294967296\n", { "'scan_list'", "4294967296", "32 bits", "in quotes", ALLOWED } },
        Wrong{
            "wideMask", "scan_list: 0x80000002\n", { "'scan_list'", "2147483650", "32 bits", "in quotes", ALLOWED } },
        Wrong{ "longTextMask", "scan_list: '0x100000002'\n", { "'scan_list'", "0x100000002", ALLOWED } },
        Wrong{ "wordMask", "scan_list: all\n", { "'scan_list'", "'all'", ALLOWED } },
        Wrong{ "maskWithoutDrive", "scan_list: 2\n", { "'drive' is missing", "station 1", ALLOWED } },
        Wrong{ "defaultsList", "defaults: [1]\n" + ONE, { "~defaults", "[1]", "not a map", ALLOWED } },
        Wrong{ "defaultsName", "defaults: {name: x}\n" + ONE, { "~defaults", "'name'", "'x'", ALLOWED } },
        Wrong{ "defaultsNode", "defaults: {node: 1}\n" + ONE, { "~defaults", "'node'", ALLOWED } },
        Wrong{ "badDefault",
               "defaults: {command_timeout: -1}\n" + ONE,
               { "~defaults", "'command_timeout'", "-1", ALLOWED } },
        Wrong{ "unknownEntryKey", entry("nod: 2"), { BELT, "'nod'", "2", ALLOWED } },
        Wrong{ "missingName",
               "scan_list: [{node: 1, drive: omron_mx2}]\n",
               { "~scan_list[0]", "'name' is missing", ALLOWED } },
        Wrong{ "missingNode", "scan_list: [{name: belt, drive: omron_mx2}]\n", { BELT, "'node' is missing", ALLOWED } },
        Wrong{ "missingDrive", "scan_list: [{name: belt, node: 1}]\n", { BELT, "'drive' is missing", ALLOWED } },
        Wrong{ "duplicateName",
               "defaults: {drive: omron_mx2}\nscan_list: [{name: a, node: 1}, {name: a, node: 2}]\n",
               { "~scan_list[1] (a)", "'name'", "'a'", "twice", ALLOWED } },
        Wrong{ "duplicateNode",
               "defaults: {drive: omron_mx2}\nscan_list: [{name: a, node: 1}, {name: b, node: 1}]\n",
               { "~scan_list[1] (b)", "'node'", "1", "a has it too", ALLOWED } }),
    [](const testing::TestParamInfo<Wrong>& info) { return info.param.name; });

std::string named(const std::string& name)
{
  return "scan_list: [{name: " + name + ", node: 1, drive: omron_mx2}]\n";
}

std::string numbered(const std::string& node)
{
  return "scan_list: [{name: belt, node: " + node + ", drive: omron_mx2}]\n";
}

std::string driven(const std::string& drive)
{
  return "scan_list: [{name: belt, node: 1, drive: " + drive + "}]\n";
}

INSTANTIATE_TEST_SUITE_P(
    Entry, RefusalTest,
    testing::Values(
        Wrong{ "emptyName", named("''"), { "'name'", "''", ALLOWED } },
        Wrong{ "numericName", named("5"), { "'name'", "5", ALLOWED } },
        Wrong{ "nameWithDigitFirst", named("1belt"), { "'name'", "'1belt'", "ROS name", ALLOWED } },
        Wrong{ "nameWithHyphen", named("belt-1"), { "'name'", "'belt-1'", "ROS name", ALLOWED } },
        Wrong{ "nameWithSlash", named("a/b"), { "'name'", "'a/b'", "ROS name", ALLOWED } },
        Wrong{ "nameWithNewline", named("\"a\\nb\""), { "'name'", "'a b'", "ROS name", ALLOWED } },
        Wrong{ "reservedBus", named("bus"), { "'name'", "'bus'", "reserved", ALLOWED } },
        Wrong{ "reservedCommand", named("command"), { "'name'", "'command'", "reserved", ALLOWED } },
        Wrong{ "reservedStop", named("stop"), { "'name'", "'stop'", "reserved", ALLOWED } },
        Wrong{ "reservedBusStatus", named("bus_status"), { "'name'", "'bus_status'", "reserved", ALLOWED } },
        Wrong{ "reservedDumpTrace", named("dump_trace"), { "'name'", "'dump_trace'", "reserved", ALLOWED } },
        Wrong{ "nodeZero", numbered("0"), { BELT, "'node'", "= 0", "from 1 to" } },
        Wrong{ "nodeBeyond", numbered("248"), { BELT, "'node'", "248", "to 247" } },
        Wrong{ "unitBeyond", "port: tcp://plc\n" + numbered("256"), { BELT, "'node'", "256", "from 0 to 255" } },
        Wrong{ "unitOfAnRtuTunnel", "port: rtu+tcp://plc:4001\n" + numbered("255"), { BELT, "'node'", "to 247" } },
        Wrong{ "unitZeroBesideOthers",
               "port: tcp://plc\ndefaults: {drive: omron_mx2}\nscan_list: [{name: a, node: 1}, {name: b, node: 0}]\n",
               { "~scan_list[1] (b)", "'node'", "= 0", "single entry" } },
        Wrong{ "unit255BesideOthers",
               "port: tcp://plc\ndefaults: {drive: omron_mx2}\nscan_list: [{name: b, node: 255}, {name: a, node: 1}]\n",
               { "~scan_list[0] (b)", "'node'", "255", "single entry" } },
        Wrong{ "nodeText", numbered("one"), { BELT, "'node'", "'one'", "whole number" } },
        Wrong{ "nodeBroken", numbered("1.0"), { BELT, "'node'", "whole number" } },
        Wrong{ "unknownDrive", driven("omron_mx3"), { BELT, "'drive'", "'omron_mx3'", "omron_mx2", ALLOWED } },
        Wrong{ "driveOutside", driven("../drives/omron_mx2"), { BELT, "'drive'", "../drives/omron_mx2", ALLOWED } },
        Wrong{ "missingProfile", driven("/nonexistent.yaml"), { BELT, "'drive'", "/nonexistent.yaml" } },
        Wrong{ "hzPerUnitZero", entry("hz_per_unit: 0"), { BELT, "'hz_per_unit'", "= 0", "never 0" } },
        Wrong{ "hzPerUnitZeroFloat", entry("hz_per_unit: -0.0"), { BELT, "'hz_per_unit'", "never 0" } },
        Wrong{ "hzPerUnitText", entry("hz_per_unit: one"), { BELT, "'hz_per_unit'", "'one'", ALLOWED } },
        Wrong{ "hzPerUnitNotANumber", entry("hz_per_unit: .nan"), { BELT, "'hz_per_unit'", "nan", ALLOWED } },
        Wrong{
            "fastVelocity", entry("max_velocity: 100001"), { BELT, "'max_velocity'", "100001", "maximum", ALLOWED } },
        Wrong{ "negativeVelocity", entry("max_velocity: -1"), { BELT, "'max_velocity'", "-1", ALLOWED } },
        Wrong{
            "minimumAboveMaximum", entry("max_velocity: 5, min_velocity: 6"), { BELT, "'min_velocity'", "6", "to 5" } },
        Wrong{
            "negativeCommandTimeout", entry("command_timeout: -0.5"), { BELT, "'command_timeout'", "-0.5", ALLOWED } },
        Wrong{ "noEntryTimeout", entry("response_timeout: 0.0"), { BELT, "'response_timeout'", "above 0" } },
        Wrong{ "ratedCurrent", entry("rated_current: 0"), { BELT, "'rated_current'", "above 0" } },
        Wrong{ "ratedVoltage", entry("rated_voltage: high"), { BELT, "'rated_voltage'", "'high'" } },
        Wrong{ "configureBlock", entry("configure_block: 1"), { BELT, "'configure_block'", "true or false" } },
        Wrong{ "configureMap", entry("configure_map: 1"), { BELT, "'configure_map'", "true or false" } },
        Wrong{ "configureMapOfADriveWithoutOne",
               "scan_list: [{name: fan, node: 1, drive: omron_rx, configure_map: true}]\n",
               { "(fan)", "'configure_map'", "omron_rx has none", ALLOWED } },
        Wrong{ "configureMapReadOnly",
               "parameter_access: read_only\n" + entry("configure_map: true"),
               { BELT, "'configure_map'", "read_only", ALLOWED } },
        Wrong{ "shortBlock", entry("block_read: [1, 2]"), { BELT, "'block_read'", "[1, 2]", "five codes" } },
        Wrong{ "blockCode", entry("block_read: [1, 2, 3, 4, 15]"), { BELT, "'block_read'", "15", "0 to 14" } },
        Wrong{ "unexpectedMotion",
               entry("stop_unexpected_motion: please"),
               { BELT, "'stop_unexpected_motion'", ALLOWED } },
        Wrong{ "releaseOnExit", entry("release_on_exit: 0"), { BELT, "'release_on_exit'", "true or false" } },
        Wrong{ "overridesList", entry("overrides: [1]"), { BELT, "'overrides'", "[1]", ALLOWED } },
        Wrong{ "unknownOverride", entry("overrides: {no_such_key: 1}"), { BELT, "no_such_key" } },
        Wrong{ "skipText", entry("skip: torque"), { BELT, "'skip'", ALLOWED } },
        Wrong{ "skipNumber", entry("skip: [1]"), { BELT, "'skip'", ALLOWED } },
        Wrong{ "skipUnknown",
               entry("skip: [torque, torqe]"),
               { BELT, "'skip'", "'torqe'", "not a status field", "dc_voltage" } },
        Wrong{ "skipVelocity", entry("skip: [velocity]"), { BELT, "'skip'", "'velocity'", "dc_voltage" } },
        Wrong{ "skipRun",
               entry("skip: [run_seen]"),
               { BELT, "'skip'", "'run_seen'", "which the driver needs", "torque" } },
        Wrong{ "skipFault",
               entry("skip: [faulted]"),
               { BELT, "'skip'", "'faulted'", "which the driver needs", "torque" } },
        Wrong{ "skipCode", entry("skip: [fault_code]"), { BELT, "'skip'", "'fault_code'", "which the driver needs" } },
        Wrong{ "skipFrequency", entry("skip: [output_frequency]"), { BELT, "'skip'", "'output_frequency'" } },
        Wrong{ "skipInDefaults",
               "defaults: {skip: [direction]}\n" + ONE,
               { "~defaults", "'skip'", "'direction'", "which the driver needs" } },
        Wrong{ "confirmNumber", entry("confirm: [1]"), { BELT, "'confirm'", "[1]", ALLOWED } },
        Wrong{ "unknownConfirm", entry("confirm: [no_such_item]"), { BELT, "confirm", "no_such_item" } }),
    [](const testing::TestParamInfo<Wrong>& info) { return info.param.name; });

TEST(ConfigurationTest, aDriveWithItsOwnPortMayHaveAnyUnit)
{
  for (const int unit : { 0, 1, 247, 248, 255 })
  {
    const BusConfig bus = read("port: tcp://plc\n" + numbered(std::to_string(unit))).bus;
    EXPECT_EQ(unit, bus.inverters[0].node);
    EXPECT_EQ(unit == 0 || unit > 247, bus.inverters[0].ownPort());
  }
  const BusConfig two =
      read("port: tcp://plc\ndefaults: {drive: omron_mx2}\nscan_list: [{name: a, node: 1}, {name: b, node: 254}]\n")
          .bus;
  EXPECT_FALSE(two.inverters[0].ownPort());
  EXPECT_TRUE(two.inverters[1].ownPort());
  EXPECT_FALSE(read(ONE).bus.inverters[0].ownPort());
}

TEST(ConfigurationTest, skippedFieldsReachTheDrive)
{
  const Configuration configuration = read(
      "defaults: {skip: [dc_voltage]}\nscan_list:\n"
      "  - {name: a, node: 1, drive: toshiba_vfs15}\n"
      "  - {name: b, node: 2, drive: toshiba_vfs15, skip: []}\n");
  EXPECT_EQ(std::vector<std::string>{ "dc_voltage" }, configuration.bus.inverters[0].skip);
  EXPECT_TRUE(configuration.drives[0].unconfirmedText().empty());
  EXPECT_FALSE(configuration.drives[1].unconfirmedText().empty());
}

TEST(ConfigurationTest, aFileWithoutAMapIsRefused)
{
  EXPECT_THAT(refusal("- 1\n"), AllOf(HasSubstr("~"), HasSubstr("not a map"), HasSubstr(ALLOWED)));
  EXPECT_THAT(refusal(""), AllOf(HasSubstr("is empty"), HasSubstr(ALLOWED)));
}

TEST(ConfigurationTest, aFileIsNamedAsThePlace)
{
  const ScanListFile file("scan_list: [{name: belt, node: 0, drive: omron_mx2}]\n");
  try
  {
    readConfiguration(readYamlFile(file.path()), "line.yaml", PROFILES);
    FAIL() << "was accepted";
  }
  catch (const drive::ConfigurationError& error)
  {
    EXPECT_THAT(error.what(), HasSubstr("line.yaml: scan_list[0] (belt): key 'node' = 0"));
  }
}

TEST(ConfigurationTest, malformedYamlIsReportedWithFileAndLine)
{
  EXPECT_THAT(refusal("port: /dev/ttyS0\nscan_list: [\n"), AllOf(HasSubstr(".yaml:"), HasSubstr("valid YAML")));
  EXPECT_THAT(refusal("retries: 1\nretries: 2\n" + ONE), AllOf(HasSubstr(".yaml:2:"), HasSubstr("'retries'")));
}

TEST(ConfigurationTest, longTextsAreCutAndWhatIsAllowedStillThere)
{
  const std::string huge(300000, 'x');
  for (const std::string& text :
       { "scan_list: [{name: " + huge + ", node: 1, drive: omron_mx2}]\n",
         "scan_list: [{name: a, node: " + huge + ", drive: omron_mx2}]\n",
         "scan_list: [{name: " + huge + ", node: 1000, drive: omron_mx2}]\n",
         "scan_list: [{name: a, node: 1, drive: " + huge + "}]\n", "port: 'tcp://" + huge + "'\n" + ONE,
         "port: 'tcp://host:" + huge + "'\n" + ONE,
         "scan_list: [{name: a, node: 1, drive: omron_mx2, ? " + huge + " : 1}]\n",
         "scan_list: [{name: a, node: 1, drive: omron_mx2, confirm: [" + huge + "]}]\n", "scan_list: " + huge + "\n" })
  {
    const std::string message = refusal(text);
    EXPECT_LT(message.size(), 2100U) << message.substr(0, 200);
    EXPECT_THAT(message, AllOf(HasSubstr("xxx"), HasSubstr(ALLOWED)));
  }
}

TEST(ConfigurationTest, aMessageIsOneLineOfPrintableText)
{
  EXPECT_THAT(refusal("scan_list: [{name: \"a\\e[2J\\nb\", node: 1, drive: omron_mx2}]\n"),
              AllOf(Not(HasSubstr("\x1B")), Not(HasSubstr("\n")), HasSubstr("a [2J b")));
}

TEST(ConfigurationTest, aMissingFileIsNamed)
{
  EXPECT_THROW(readYamlFile("/nonexistent/scan_list.yaml"), drive::ConfigurationError);
}

TEST(ConfigurationTest, anUnknownDriveIsNamedOnce)
{
  const std::string message = refusal(driven("omron_mx3"));
  EXPECT_THAT(message, StartsWith(BELT + ": key 'drive': value 'omron_mx3': " + ALLOWED));
  EXPECT_EQ(message.find(BELT), message.rfind(BELT));
}

TEST(ConfigurationTest, aMalformedProfileIsReportedWithFileAndLine)
{
  const std::string path = testing::TempDir() + "bus_configuration_test_profile.yaml";
  std::ofstream(path) << "title: broken\nnonsense: [\n";
  EXPECT_THAT(refusal(driven(path)), AllOf(HasSubstr(BELT), HasSubstr("'drive'"), HasSubstr(path + ":")));
  std::remove(path.c_str());
}

TEST(ConfigurationTest, valuesHaveTheTypesOfTheParameterServer)
{
  const ScanListFile file("{a: 1, b: 1.0, c: '1', d: true, e: 0x10, f: 1.0e+3, g: text, h: 1e3, i: off, j: -3}\n");
  const Value value = readYamlFile(file.path());
  EXPECT_EQ(Value::Type::Integer, value.find("a")->type);
  EXPECT_EQ(Value::Type::Number, value.find("b")->type);
  EXPECT_EQ(Value::Type::Text, value.find("c")->type);
  EXPECT_EQ(Value::Type::Boolean, value.find("d")->type);
  EXPECT_EQ(16, value.find("e")->integer);
  EXPECT_DOUBLE_EQ(1000.0, value.find("f")->number);
  EXPECT_EQ("text", value.find("g")->text);
  EXPECT_EQ(Value::Type::Text, value.find("h")->type);
  EXPECT_FALSE(value.find("i")->boolean);
  EXPECT_EQ(-3, value.find("j")->integer);
}

TEST(ConfigurationTest, whatTheParameterServerWouldHideIsRefusedInAFile)
{
  EXPECT_THAT(refusal(numbered("010")),
              AllOf(HasSubstr(".yaml:1:"), HasSubstr("scan_list[0].node"), HasSubstr("8 or 10")));
  EXPECT_THAT(refusal(numbered("1:30")), AllOf(HasSubstr("scan_list[0].node"), HasSubstr("is 90")));
  EXPECT_THAT(refusal(numbered("1, node: 2")), AllOf(HasSubstr("scan_list[0].node"), HasSubstr("duplicate")));
  EXPECT_THAT(refusal("parity:\n" + ONE), AllOf(HasSubstr(".yaml:1:"), HasSubstr("'parity'"), HasSubstr("no value")));
  EXPECT_THAT(refusal(entry("overrides: {faults: {table: {99: x}}}")),
              AllOf(HasSubstr("faults.table.99"), HasSubstr("'99' in quotes"), HasSubstr(ALLOWED)));
}

TEST(ConfigurationTest, integerKeysOfOverridesAreTexts)
{
  const Configuration configuration = read(entry("overrides: {faults: {table: {'99': over there}}}"));
  EXPECT_EQ("over there", configuration.drives[0].profile().faults.at(99));
}

TEST(ConfigurationTest, mergeKeysBringWhatAnEntryDoesNotSay)
{
  const BusConfig bus = read(
                            "scan_list:\n  - &belt {name: a, node: 1, drive: omron_mx2, max_velocity: 50.0}\n"
                            "  - {<<: *belt, name: b, node: 2}\n")
                            .bus;
  ASSERT_EQ(2U, bus.inverters.size());
  EXPECT_EQ("omron_mx2", bus.inverters[1].drive);
  EXPECT_DOUBLE_EQ(50.0, bus.inverters[1].max_velocity);
}

TEST(ConfigurationTest, hintsSayWhatToWrite)
{
  EXPECT_THAT(refusal(numbered("08")), AllOf(HasSubstr("'08'"), HasSubstr("write 8, without leading zeros")));
  EXPECT_THAT(refusal(numbered("'1'")), HasSubstr("write 1 without quotes"));
  EXPECT_THAT(refusal(numbered("1.0")), HasSubstr("without a decimal point"));
  EXPECT_THAT(refusal("retries: 1e0\n" + ONE), HasSubstr("write 1.0"));
  EXPECT_THAT(refusal("baud_rate: '9600'\n" + ONE), HasSubstr("write 9600 without quotes"));
  EXPECT_THAT(refusal("exclusive: 'true'\n" + ONE), HasSubstr("write true without quotes"));
  EXPECT_THAT(refusal(entry("hz_per_unit: '100'")), HasSubstr("write 100 without quotes"));
  EXPECT_THAT(refusal(entry("hz_per_unit: 0,5")), Not(IsEmpty()));
}

TEST(ConfigurationTest, aNumberThatIsATextToYamlIsTakenWithAHint)
{
  // The parameter server can't tell '1e2' from 1e2, so both mean the same.
  for (const char* number : { "1e2", "'1e2'" })
  {
    const Configuration configuration = read(entry("hz_per_unit: " + std::string(number)));
    EXPECT_DOUBLE_EQ(100.0, configuration.bus.inverters[0].hz_per_unit);
    EXPECT_THAT(configuration.warnings, ElementsAre(AllOf(HasSubstr(BELT), HasSubstr("'hz_per_unit'"),
                                                          HasSubstr("'1e2'"), HasSubstr("write 100.0"))));
  }
  const Configuration configuration = read("interval: 5e-3\ndefaults: {command_timeout: 5e-1}\n" + ONE);
  EXPECT_DOUBLE_EQ(0.005, configuration.bus.interval);
  EXPECT_DOUBLE_EQ(0.5, configuration.bus.inverters[0].command_timeout);
  EXPECT_EQ(2U, configuration.warnings.size());
  EXPECT_DOUBLE_EQ(0.005, read("interval: 5.0e-3\n" + ONE).bus.interval);
  EXPECT_DOUBLE_EQ(1.0, read(ONE).bus.slow_interval);
  EXPECT_DOUBLE_EQ(0.0, read("slow_interval: 0\n" + ONE).bus.slow_interval);
}

TEST(ConfigurationTest, whatIsMeantForOthersIsIgnoredWithAWarning)
{
  for (const char* foreign : { "rate: 10\n", "teleop: {scale: 2.0}\n", "publish_rate: 5.0\n", "frame_id: base\n" })
  {
    const Configuration configuration = read(foreign + ONE);
    const std::string key = std::string(foreign).substr(0, std::string(foreign).find(':'));
    EXPECT_THAT(configuration.warnings, ElementsAre(AllOf(HasSubstr("'" + key + "'"), HasSubstr("ignored"))))
        << foreign;
  }
  EXPECT_THAT(read("diagnostic_period: 0.5\n" + ONE).warnings, IsEmpty());
  const std::string huge(300000, 'x');
  EXPECT_LT(read("? " + huge + "\n: 1\n" + ONE).warnings.at(0).size(), 2100U);
}

TEST(ConfigurationTest, whatResemblesAKeyAtAnyLevelIsRefused)
{
  const std::vector<std::pair<std::string, std::string>> cases{ { "baudrate", "'baud_rate'" },
                                                                { "baud", "'baud_rate'" },
                                                                { "timeout", "'response_timeout'" },
                                                                { "max_velocty", "'max_velocity'" },
                                                                { "commandTimeout", "'command_timeout'" },
                                                                { "PORT", "'port'" },
                                                                { "ports", "'port'" },
                                                                { "scan-list", "'scan_list'" },
                                                                { "velocity_limit", "'" },
                                                                { "command_timeout",
                                                                  "belongs in scan_list or defaults" },
                                                                { "name", "belongs in scan_list or defaults" },
                                                                { "turnaround", "belongs in simulation" },
                                                                { "in_service", "later version" },
                                                                { "parameters", "later version" },
                                                                { "parameters_on_difference", "later version" } };
  for (const auto& one : cases)
  {
    EXPECT_THAT(refusal(one.first + ": 1\n" + ONE),
                AllOf(HasSubstr("'" + one.first + "'"), HasSubstr(one.second), HasSubstr(ALLOWED)))
        << one.first;
  }
  EXPECT_THAT(refusal(entry("teleop: 1")), AllOf(HasSubstr(BELT), HasSubstr("'teleop'"), HasSubstr(ALLOWED)));
  EXPECT_THAT(refusal(entry("retries: 1")), AllOf(HasSubstr(BELT), HasSubstr("belongs to the bus")));
  EXPECT_THAT(refusal("defaults: {rate: 1}\n" + ONE), AllOf(HasSubstr("~defaults"), HasSubstr("'rate'")));
}

TEST(ConfigurationTest, aWrongConfirmOrOverrideIsNamedWhereItStands)
{
  const std::string list = "defaults: {drive: omron_rx}\nscan_list: [{name: a, node: 1}, {name: b, node: 2, ";
  EXPECT_THAT(
      refusal(list + "confirm: [no_such_item]}]\n"),
      AllOf(StartsWith("~scan_list[1] (b): key 'confirm'"), HasSubstr("no_such_item"), Not(HasSubstr("~defaults"))));
  EXPECT_THAT(refusal(list + "overrides: {no_such_key: 1}}]\n"),
              AllOf(StartsWith("~scan_list[1] (b): key 'no_such_key'"), Not(HasSubstr("~defaults"))));
  EXPECT_THAT(refusal("defaults: {drive: omron_rx, confirm: [no_such_item]}\nscan_list: [{name: a, node: 1}]\n"),
              StartsWith("~defaults: key 'confirm'"));
  EXPECT_THAT(refusal("defaults: {drive: omron_rx, overrides: {status: {running: {bit: 1}}}}\n"
                      "scan_list: [{name: a, node: 1, confirm: [no_such_item]}]\n"),
              StartsWith("~scan_list[0] (a): key 'confirm'"));
}

TEST(ConfigurationTest, theShippedScanListsAreAccepted)
{
  for (const char* name :
       { "conveyor_line", "diff_drive_robot", "mixed_brands", "compoway_fans", "pump_station_gateway" })
  {
    const std::string path = std::string(INVERTER_BUS_ROOT) + "/config/" + name + ".yaml";
    EXPECT_NO_THROW(readConfiguration(readYamlFile(path), path, PROFILES)) << path;
  }
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The simulator's programs refuse what the driver refuses, and play a drive of which only a profile tells.
#include "bench/scan_list.h"

#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/yaml.h"
#include "drive/profile/problems.h"
#include "inverter_bus/bus/configuration.h"
#include "simulation/drives/motor.h"
#include "support/simulation_test_bus.h"

namespace inverter_bus
{
namespace bench
{
namespace
{
using simulation::Bytes;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string PROFILES = std::string(INVERTER_BUS_ROOT) + "/config/drives";
const std::string ONE = "scan_list: [{name: a, node: 1, drive: omron_mx2}]\n";

config::Value valueOf(const std::string& text)
{
  drive::Problems problems;
  const auto tree = config::readYaml(text, "line.yaml", config::Purpose::Parameters, problems);
  EXPECT_TRUE(tree && problems.empty()) << text;
  return tree.value_or(config::Value());
}

std::string refusal(const std::string& text)
{
  try
  {
    readScanList(valueOf(text), "line.yaml", PROFILES);
  }
  catch (const std::runtime_error& error)
  {
    return error.what();
  }
  return "";
}

std::string refusalOfTheDriver(const std::string& text)
{
  try
  {
    bus::readConfiguration(valueOf(text), "line.yaml", PROFILES);
  }
  catch (const drive::ConfigurationError& error)
  {
    return error.what();
  }
  return "";
}

TEST(BenchScanList, refusesWhatTheDriverRefusesInItsWords)
{
  for (const std::string& text :
       { "baudrate: 9600\n" + ONE, "exclusive: 1\n" + ONE, "parity: N\n" + ONE, "max_velocty: 1\n" + ONE,
         std::string("scan_list: [{name: stop, node: 1, drive: omron_mx2}]\n"),
         std::string("scan_list: [{name: belt-2, node: 1, drive: omron_mx2}]\n"),
         std::string("scan_list: [{name: a, node: '1', drive: omron_mx2}]\n"),
         std::string("scan_list: [{name: a, node: 1.0, drive: omron_mx2}]\n"),
         std::string("scan_list: [{name: a, node: 08, drive: omron_mx2}]\n"),
         std::string("scan_list: [{name: a, node: 1, drive: omron_mx2, command_timeout: -1}]\n"),
         std::string("scan_list: [{name: a, node: 1, drive: omron_mx2, max_velocty: 1}]\n"),
         std::string("scan_list: [{name: a, node: 1, drive: omron_mx2, confirm: [nothing]}]\n"),
         std::string("scan_list: [{name: a, node: 1, drive: omron_mx2}, {name: b, node: 1, drive: omron_mx2}]\n"),
         std::string("port: /dev/ttyS0\n") })
  {
    EXPECT_NE("", refusal(text)) << text;
    EXPECT_EQ(refusalOfTheDriver(text), refusal(text)) << text;
  }
}

TEST(BenchScanList, hasTheDriversWarningsAndItsOwnRefusals)
{
  EXPECT_THAT(readScanList(valueOf(ONE), "line.yaml", PROFILES).warnings, IsEmpty());
  EXPECT_THAT(readScanList(valueOf("rate: 5\n" + ONE), "line.yaml", PROFILES).warnings,
              ElementsAre(HasSubstr("'rate'")));
  EXPECT_THAT(refusal(ONE + "simulation: {a: {nonsense: 1}}\n"), HasSubstr("unknown key"));
  EXPECT_THAT(refusal(ONE + "simulation: {a: {load: 5}}\n"), HasSubstr("line.yaml:2: simulation.a.load: 5 (allowed:"));
  EXPECT_THAT(refusal("scan_list: [{name: a, node: 1, drive: hitachi_wj200}]\n"), HasSubstr("can't be simulated"));
  EXPECT_THAT(refusal(ONE + "simulation: {b: {model: profile, station: 2}}\n"), HasSubstr("simulation.b.model"));
}

TEST(BenchScanList, findsThePackageAsRoslaunchDoes)
{
  const std::string text =
      "scan_list: [{name: a, node: 1, drive: $(find inverter_bus)/config/drives/omron_mx2.yaml}]\n"
      "simulation: {a: {model: omron_mx2}}\n";
  EXPECT_EQ("omron_mx2", readScanList(valueOf(text), "line.yaml", PROFILES).config.drives.at(0).model);
}

TEST(BenchScanList, serialOptionsAreThoseOfTheDrives)
{
  simulation::SerialOptions options;
  options.baud_rate = 9600;
  options.parity = simulation::Parity::Even;
  const auto config = readScanList(valueOf(ONE), "line.yaml", PROFILES, options).config;
  EXPECT_EQ("19200 baud 8N1", config.line.text());
  EXPECT_EQ("9600 baud 8E1", config.drives.at(0).options.line.text());
}

/// A drive that nobody simulates: one command word, a status word, monitors.
const char* const PROFILE = R"(drive: acme
title: Acme
protocol: modbus_rtu
numbering: {register_offset: 0}
stations: {first: 1, last: 99}
serial: {baud_rates: [9600, 19200], data_bits: [8], parity: [none, even], stop_bits: [1]}
limits: {functions: [0x03, 0x10], read_registers: 8, write_registers: 8}
frequency: {maximum: 60.0}
points:
  command: {register: 0x2000}
  frequency: {register: 0x2001, resolution: 0.1, unit: Hz}
sequences:
  forward: [{frequency: setpoint}, {command: 1}]
  reverse: [{frequency: setpoint}, {command: 2}]
  stop: [{command: 0}]
  reset: [{command: 8, pause: 0.1}, {command: 0}]
writes: eeprom
status:
  run_seen: {register: 0x2000, values: {0: 0, 1: 1, 2: 1, 8: 0}}
  running: {register: 0x2100, bit: 0}
  direction: {register: 0x2100, mask: 0x0003, values: {0: 0, 1: 1, 2: 0, 3: -1}}
  faulted: {register: 0x2100, bit: 7}
  ready: {register: 0x2100, bit: 8}
  fault_code: {register: 0x2101, when: faulted}
  output_frequency: {register: 0x2102, resolution: 0.1, unit: Hz}
faults:
  table: {1: overcurrent}
parameters:
  T01: {register: 0x0105, resolution: 0.1, unit: s, range: [0.1, 600.0]}
  C01: {register: 0x0300, resolution: 0.1, unit: s, range: [0, 60]}
  C02: {register: 0x0301, range: [0, 1]}
  K01: {register: 0x0400, range: [0, 9]}
command_source:
  - {parameter: K01, accept: [3], advice: set K01 to 3}
communication_loss:
  timeout_parameter: C01
  action_parameter: C02
  runs_on: [0]
  advice: set C01 to 1 s and C02 to 1
)";

class ProfileDriveTest : public testing::Test
{
protected:
  ProfileDriveTest()
    : path_(testing::TempDir() + "bench_scan_list_test_" + std::to_string(getpid()) + ".yaml")
    , start_(simulation::TimePoint() + std::chrono::hours(1))
  {
    std::ofstream(path_) << PROFILE;
    play("");
  }
  ~ProfileDriveTest() override
  {
    std::remove(path_.c_str());
  }

  void play(const std::string& simulation)
  {
    const std::string text = "scan_list: [{name: m, node: 5, drive: " + path_ + "}]\n" + simulation;
    now_ = start_;
    bus_ = std::make_unique<simulation::SimulatedBus>(readScanList(valueOf(text), "line.yaml", PROFILES).config,
                                                      simulation::LineOptions(), now_);
  }

  /// The reply's bytes as text without its CRC.
  std::string ask(const std::string& hex)
  {
    bus_->send(simulation::withModbusCrc(*simulation::fromHex(hex)), now_);
    Bytes heard;
    for (auto next = bus_->nextEvent(); next; next = bus_->nextEvent())
    {
      now_ = std::max(now_, *next);
      bus_->advance(now_);
      for (const simulation::Delivery& delivery : bus_->takeOutput(now_))
      {
        heard.insert(heard.end(), delivery.bytes.begin(), delivery.bytes.end());
      }
    }
    now_ += std::chrono::milliseconds(5);
    if (heard.size() > 2 && simulation::modbusCrcFits(heard))
    {
      heard.resize(heard.size() - 2);
    }
    return simulation::toHex(heard);
  }

  void wait(double time)
  {
    now_ += simulation::seconds(time);
    bus_->advance(now_);
  }

  double frequency()
  {
    bus_->advance(now_);
    bus_->drive("m")->advance(now_);
    return bus_->drive("m")->motor().frequency();
  }

  std::string command(const std::string& line)
  {
    return bus_->command(line, now_);
  }

  const std::string path_;
  const simulation::TimePoint start_;
  simulation::TimePoint now_;
  std::unique_ptr<simulation::SimulatedBus> bus_;
};

const char* const WORD_1 = "05 10 20 00 00 01 02 00 01";
const char* const WORD_2 = "05 10 20 00 00 01 02 00 02";
const char* const WORD_0 = "05 10 20 00 00 01 02 00 00";
const char* const WORD_8 = "05 10 20 00 00 01 02 00 08";
const char* const SPEED_30 = "05 10 20 01 00 01 02 01 2C";
const char* const STATUS = "05 03 21 00 00 01";

TEST_F(ProfileDriveTest, runsReversesAndStopsByItsSequences)
{
  EXPECT_EQ("05 10 20 01 00 01", ask(SPEED_30));
  EXPECT_DOUBLE_EQ(0.0, frequency());
  EXPECT_EQ("05 10 20 00 00 01", ask(WORD_1));
  wait(10.0);
  EXPECT_NEAR(30.0, frequency(), 1e-6);
  EXPECT_EQ("05 03 02 01 01", ask(STATUS));               // ready, running, forward
  EXPECT_EQ("05 03 02 01 2C", ask("05 03 21 02 00 01"));  // 30.0 Hz
  EXPECT_EQ("05 03 02 00 01", ask("05 03 20 00 00 01"));  // the word as written
  ask(WORD_2);
  wait(20.0);
  EXPECT_NEAR(-30.0, frequency(), 1e-6);
  EXPECT_EQ("05 03 02 01 03", ask(STATUS));
  ask(WORD_0);
  wait(10.0);
  EXPECT_DOUBLE_EQ(0.0, frequency());
  EXPECT_EQ("05 03 02 01 00", ask(STATUS));
}

TEST_F(ProfileDriveTest, aTripCutsTheMotorUntilResetAndRunOff)
{
  ask(SPEED_30);
  ask(WORD_1);
  wait(10.0);
  EXPECT_THAT(command("m trip 1"), HasSubstr("ok"));
  EXPECT_DOUBLE_EQ(0.0, frequency());
  EXPECT_EQ("05 03 04 00 80 00 01", ask("05 03 21 00 00 02"));  // faulted, code 1
  ask(WORD_1);
  wait(10.0);
  EXPECT_DOUBLE_EQ(0.0, frequency());
  ask(WORD_8);
  ask(WORD_0);
  EXPECT_EQ("05 03 02 01 00", ask(STATUS));
  ask(WORD_1);
  wait(10.0);
  EXPECT_NEAR(30.0, frequency(), 1e-6);
}

TEST_F(ProfileDriveTest, hasTheRegistersOfItsProfileAndNoOthers)
{
  EXPECT_EQ("05 83 02", ask("05 03 21 03 00 01"));
  EXPECT_EQ("05 90 02", ask("05 10 00 01 00 01 02 00 00"));
  EXPECT_EQ("05 86 01", ask("05 06 20 00 00 01"));           // not among its functions
  EXPECT_EQ("05 90 03", ask("05 10 04 00 00 01 02 00 0A"));  // K01 above its range
  EXPECT_EQ("05 03 02 00 03", ask("05 03 04 00 00 01"));     // commissioned as the profile wants it
  EXPECT_EQ("", ask("06 03 21 00 00 01"));
}

TEST_F(ProfileDriveTest, itsTimeOutStopsItUnlessTheProfileSaysThatItRunsOn)
{
  for (const bool runs_on : { false, true })
  {
    play("simulation: {m: {parameters: {C01: 1.0, C02: " + std::string(runs_on ? "0" : "1") + "}}}\n");
    ask(SPEED_30);
    ask(WORD_1);
    wait(0.9);
    EXPECT_GT(frequency(), 1.0);
    wait(10.0);
    EXPECT_NEAR(runs_on ? 30.0 : 0.0, frequency(), 1e-6);
  }
}

TEST_F(ProfileDriveTest, refusesParametersAndStationsThatItsProfileLacks)
{
  EXPECT_THROW(play("simulation: {m: {parameters: {X99: 1}}}\n"), simulation::ConfigError);
  EXPECT_THROW(play("simulation: {m: {station: 100}}\n"), simulation::ConfigError);
}
}  // namespace
}  // namespace bench
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// The scan list as the simulator reads it.

#include <gtest/gtest.h>

#include "inverter_bus/simulation/bus_config.h"

using namespace inverter_bus::simulation;

namespace
{
BusConfig read(const std::string& yaml)
{
  return busConfigFromText(yaml);
}

std::string errorOf(const std::string& yaml)
{
  try
  {
    const BusConfig config = read(yaml);
    for (const DriveConfig& drive : config.drives)
    {
      makeDrive(drive);
    }
  }
  catch (const ConfigError& error)
  {
    return error.what();
  }
  return "no error";
}
}  // namespace

TEST(SimulatedBusConfig, listWithDefaults)
{
  const BusConfig config = read(
      "port: /dev/ttyUSB0\nbaud_rate: 9600\nparity: even\nstop_bits: 2\ninterval: 0.1\n"
      "defaults: {drive: omron_rx, rated_current: 9.5}\n"
      "scan_list: [{name: a, node: 3, max_velocity: 1}, {name: b, node: 4, drive: omron_mx2}]");
  EXPECT_EQ(9600, config.line.baud_rate);
  EXPECT_EQ(Parity::Even, config.line.parity);
  EXPECT_EQ(2, config.line.stop_bits);
  ASSERT_EQ(2U, config.drives.size());
  EXPECT_EQ("omron_rx", config.drives[0].model);
  EXPECT_EQ("a", config.drives[0].options.name);
  EXPECT_EQ(3, config.drives[0].options.station);
  EXPECT_DOUBLE_EQ(9.5, config.drives[1].options.rated_current);
  EXPECT_EQ("omron_mx2", config.drives[1].model);
}

TEST(SimulatedBusConfig, bitMask)
{
  for (const char* mask : { "-2147483646", "\"0x80000002\"", "\"#80000002\"" })
  {
    const BusConfig config = read(std::string("defaults: {drive: omron_mx2}\nscan_list: ") + mask);
    ASSERT_EQ(2U, config.drives.size()) << mask;
    EXPECT_EQ("inverter_1", config.drives[0].options.name);
    EXPECT_EQ(31, config.drives[1].options.station);
  }
}

TEST(SimulatedBusConfig, details)
{
  const BusConfig config = read(
      "scan_list: [{name: a, node: 1, drive: /home/me/mine.yaml}]\n"
      "simulation: {a: {model: omron_rx, turnaround: 0.005, parameters: {C077: 1.5}}}");
  EXPECT_EQ("omron_rx", config.drives[0].model);
  EXPECT_DOUBLE_EQ(0.005, config.drives[0].options.turnaround);
  EXPECT_DOUBLE_EQ(1.5, config.drives[0].options.parameters.at("C077"));
}

TEST(SimulatedBusConfig, errorsNameKeyValueAndWhatIsAllowed)
{
  EXPECT_EQ("parity: strange (allowed: none, even, odd)",
            errorOf("parity: strange\nscan_list: [{name: a, node: 1, drive: omron_mx2}]"));
  EXPECT_EQ("stop_bits: 3 (allowed: 1, 2)", errorOf("stop_bits: 3\nscan_list: 2"));
  EXPECT_EQ("scan_list: nothing (allowed: a list of inverters, or a bit mask with at least one of the bits 1-31)",
            errorOf("baud_rate: 9600"));
  EXPECT_EQ("scan_list: 1 (allowed: a list of inverters, or a bit mask with at least one of the bits 1-31)",
            errorOf("defaults: {drive: omron_mx2}\nscan_list: 1"));
  EXPECT_EQ("scan_list: node 1 of b is taken (allowed: each station once)",
            errorOf("scan_list: [{name: a, node: 1, drive: omron_mx2}, {name: b, node: 1, drive: omron_mx2}]"));
  std::string models;
  for (const std::string& model : driveModels())
  {
    models += model + ", ";
  }
  EXPECT_NE(std::string::npos, models.find("omron_mx2, omron_rx, "));
  EXPECT_EQ(
      "drive: foo of a can't be simulated (allowed: " + models + "or one of them, or profile, as simulation.a.model)",
      errorOf("scan_list: [{name: a, node: 1, drive: foo}]"));
  EXPECT_EQ("simulation.a.load: 5 (allowed: a number from 0 to 3)",
            errorOf("scan_list: [{name: a, node: 1, drive: omron_mx2}]\nsimulation: {a: {load: 5}}"));
  EXPECT_EQ("scan_list[0].node: nothing (allowed: an integer from 0 to 255)",
            errorOf("scan_list: [{name: a, drive: omron_mx2}]"));
  EXPECT_EQ("a: omron_rx has no station 33 (1-32)", errorOf("scan_list: [{name: a, node: 33, drive: omron_rx}]"));
  EXPECT_EQ("a: omron_rx has no baud rate 38400 (2400-19200)",
            errorOf("baud_rate: 38400\nscan_list: [{name: a, node: 1, drive: omron_rx}]"));
  EXPECT_EQ("a: omron_mx2 has no parameter C999",
            errorOf("scan_list: [{name: a, node: 1, drive: omron_mx2}]\nsimulation: {a: {parameters: {C999: 1}}}"));
  EXPECT_EQ("a: value out of range for C077 (0.00-99.99)",
            errorOf("scan_list: [{name: a, node: 1, drive: omron_mx2}]\nsimulation: {a: {parameters: {C077: 100}}}"));
}

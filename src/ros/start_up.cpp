// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/start_up.h"

#include <chrono>
#include <sstream>

#include <ros/master.h>

#include "ros/log.h"
#include "ros/trace_files.h"
#include "util/text.h"

namespace inverter_bus
{
namespace ros_node
{
namespace
{
constexpr Duration MASTER_PERIOD = std::chrono::milliseconds(200);

const char* rs485Text(wire::Rs485 mode)
{
  switch (mode)
  {
    case wire::Rs485::Kernel:
      return "kernel";
    case wire::Rs485::RtsHigh:
      return "rts_high";
    case wire::Rs485::RtsLow:
      return "rts_low";
    default:
      return "auto";
  }
}

std::string busLine(const bus::BusConfig& config)
{
  std::ostringstream line;
  line << "port " << config.port << ", " << config.protocol << ", " << config.serial.baud_rate << " baud "
       << config.serial.data_bits << wire::parityLetter(config.serial.parity) << config.serial.stop_bits << ", rs485 "
       << rs485Text(config.serial.rs485) << (config.exclusive ? ", exclusive" : ", shared") << ", interval "
       << util::numberText(config.interval) << " s, slow_interval " << util::numberText(config.slow_interval)
       << " s, response_timeout " << util::numberText(config.response_timeout) << " s, retries " << config.retries
       << ", offline_after " << config.offline_after << ", idle_divisor " << config.idle_divisor
       << ", realtime_priority " << config.realtime_priority << ", parameter_access "
       << (config.parameters_read_only ? "read_only" : "read_write") << ", trace_directory "
       << expandHome(config.trace_directory);
  return line.str();
}

std::string inverterLine(const bus::InverterConfig& config)
{
  std::ostringstream line;
  line << config.name << ": station " << static_cast<int>(config.node) << ", " << config.drive << ", "
       << util::numberText(config.hz_per_unit) << " Hz per unit, velocity " << util::numberText(config.min_velocity)
       << " to " << util::numberText(config.max_velocity) << ", command_timeout "
       << util::numberText(config.command_timeout) << " s"
       << (config.command_timeout > 0.0 ? "" : " (never stopped by silence)") << ", response_timeout "
       << util::numberText(config.response_timeout) << " s";
  line << (config.stop_unexpected_motion ? ", stop_unexpected_motion" : "")
       << (config.release_on_exit ? ", release_on_exit" : "")
       << (config.changes.overrides.map.empty() ? "" : ", with overrides");
  for (const std::string& name : config.changes.confirm)
  {
    line << ", confirmed: " << name;
  }
  for (const std::string& field : config.skip)
  {
    line << ", skipped: " << field;
  }
  return line.str();
}
}  // namespace

bool waitForMaster(const util::SteadyEvent& end)
{
  bool said = false;
  while (!ros::master::check())
  {
    if (!said)
    {
      log(bus::Level::Warn, "waiting for the ROS master at " + ros::master::getURI() + ": start roscore or roslaunch");
      said = true;
    }
    if (end.waitFor(MASTER_PERIOD))
    {
      return false;
    }
  }
  return !end.isSet();
}

std::vector<std::string> effectiveConfiguration(const bus::BusConfig& config)
{
  std::vector<std::string> lines{ busLine(config) };
  for (const bus::InverterConfig& inverter : config.inverters)
  {
    lines.push_back(inverterLine(inverter));
  }
  return lines;
}
}  // namespace ros_node
}  // namespace inverter_bus

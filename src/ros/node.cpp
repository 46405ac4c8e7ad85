// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/node.h"

#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>

#include "inverter_bus/bus/bus.h"
#include "inverter_bus/wire/serial_port.h"
#include "ros/commands.h"
#include "ros/diagnostics.h"
#include "ros/log.h"
#include "ros/master_watch.h"
#include "ros/parameters.h"
#include "ros/publishing.h"
#include "ros/services.h"
#include "ros/start_up.h"
#include "ros/trace_files.h"
#include "util/text.h"

namespace inverter_bus
{
namespace ros_node
{
namespace
{
constexpr Duration WATCH_PERIOD = std::chrono::milliseconds(100);
constexpr Duration ANSWER_TIME = std::chrono::seconds(1);

std::optional<bus::Configuration> readNodeConfiguration()
{
  try
  {
    return bus::readConfiguration(readParameters(), "~", drive::shippedProfileDirectory());
  }
  catch (const drive::ConfigurationError& error)
  {
    ROS_FATAL_STREAM("wrong configuration: " << error.what());
    return std::nullopt;
  }
}

/// Several inverters may have the same profile: each mistake is logged once.
void logMistakes(const std::vector<drive::Drive>& drives)
{
  std::set<std::string> logged;
  for (const drive::Drive& drive : drives)
  {
    for (const std::string& mistake : drive.profile().mistakes)
    {
      if (logged.insert(mistake).second)
      {
        log(bus::Level::Warn, mistake);
      }
    }
  }
}

void logStart(const bus::Configuration& configuration, const bus::Bus& bus)
{
  for (const std::string& warning : configuration.warnings)
  {
    log(bus::Level::Warn, warning);
  }
  for (const std::string& line : effectiveConfiguration(configuration.bus))
  {
    log(bus::Level::Ok, line);
  }
  logMistakes(configuration.drives);
  for (const bus::Finding& finding : bus.budget())
  {
    log(finding.level, finding.text);
  }
}

/// Waits until the node shall end. Returns its exit status.
int watch(const Lifetime& lifetime, const bus::Bus& bus)
{
  while (!lifetime.waitForEnd(WATCH_PERIOD))
  {
    if (bus.portInUse())
    {
      return 1;
    }
  }
  return 0;
}

void logEnd(int status, const bus::BusConfig& config, const std::vector<std::string>& unconfirmed)
{
  const std::string names = util::joined(unconfirmed, "; ");
  if (!names.empty())
  {
    log(bus::Level::Error, "shutdown: NOT confirmed as stopped, check them: " + names);
  }
  else if (status != 0)
  {
    log(bus::Level::Error, "port " + config.port +
                               " is in use by another program, tried for 30 s: end that program "
                               "or choose another port");
  }
  else
  {
    log(bus::Level::Ok, "shutdown: every motor that this node may have started is confirmed as stopped");
  }
}
}  // namespace

int runNode(Lifetime& lifetime)
{
  ros::NodeHandle node("~");
  lifetime.takeOverKill();
  const std::optional<bus::Configuration> configuration = readNodeConfiguration();
  if (!configuration)
  {
    return 1;
  }
  const bus::BusConfig& config = configuration->bus;
  TraceFiles traces(config.trace_directory, ros::this_node::getName(),
                    [](bus::Level level, const std::string& text) { log(level, text); });
  Publishing publishing(node, *configuration, traces);
  bus::Bus bus(*configuration, bus::makePort(config), publishing);
  logStart(*configuration, bus);
  Services services(node, config, bus, traces);
  Commands commands(node, config, bus);
  MasterWatch master_watch;
  Diagnostics diagnostics(*configuration, bus, commands, master_watch, traces);
  // Nothing that may wait for the master follows: from here on this function decides when the node ends.
  lifetime.busIsRunning();
  bus.start();
  commands.start();
  const int status = watch(lifetime, bus);

  const std::vector<std::string> unconfirmed = bus.shutdown();
  lifetime.finishSoon(status);
  services.drain(ANSWER_TIME);
  commands.stop();
  diagnostics.stop();
  master_watch.stop();
  traces.stop();
  publishing.stop();
  logEnd(status, config, unconfirmed);
  return status;
}
}  // namespace ros_node
}  // namespace inverter_bus

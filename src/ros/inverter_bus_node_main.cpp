// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <cstdio>
#include <exception>

#include <ros/init.h>

#include "ros/command_line.h"
#include "ros/lifetime.h"
#include "ros/node.h"
#include "ros/start_up.h"

namespace
{
const char* const USAGE =
    "usage: inverter_bus_node [--help] [__name:=NAME] [_PARAMETER:=VALUE] [FROM:=TO]...\n"
    "Drives the frequency inverters of one bus. It needs the parameter scan_list, best loaded by a launch file:\n"
    "  roslaunch inverter_bus bus.launch config:=/path/to/scan_list.yaml name:=conveyor\n"
    "Parameters, topics and services are described in the package's README.md.\n";
}  // namespace

int main(int argc, char** argv)
{
  using namespace inverter_bus::ros_node;
  if (const auto status = answerCommandLine(argc, argv, USAGE))
  {
    return *status;
  }
  // rosconsole writes to both stdout and stderr: without this, a log that takes both has its lines out of order.
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try
  {
    Lifetime lifetime;
    ros::init(argc, argv, "inverter_bus_node", ros::init_options::NoSigintHandler);
    if (!waitForMaster(lifetime.end()))
    {
      return 0;
    }
    const int status = runNode(lifetime);
    ros::shutdown();
    return status;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "inverter_bus_node: %s\n", error.what());
    return 1;
  }
}

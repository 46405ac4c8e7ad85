// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/log.h"

#include <cstdio>

#include <ros/console.h>
#include <ros/init.h>

namespace inverter_bus
{
namespace ros_node
{
// NOLINTNEXTLINE(readability-function-cognitive-complexity): it is in the macros of rosconsole
void log(bus::Level level, const std::string& text)
{
  if (ros::isShuttingDown())
  {
    std::fprintf(stderr, "%s\n", text.c_str());
    return;
  }
  switch (level)
  {
    case bus::Level::Ok:
      ROS_INFO_STREAM(text);
      break;
    case bus::Level::Warn:
      ROS_WARN_STREAM(text);
      break;
    case bus::Level::Error:
      ROS_ERROR_STREAM(text);
      break;
  }
}
}  // namespace ros_node
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_LOG_H
#define INVERTER_BUS_ROS_LOG_H

#include <string>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace ros_node
{
/// Writes a line to the log of ROS; to stderr where ROS went down by itself, since rosconsole is silent then. May block.
void log(bus::Level level, const std::string& text);
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_LOG_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_NODE_H
#define INVERTER_BUS_ROS_NODE_H

#include "inverter_bus/bus/configuration.h"
#include "ros/lifetime.h"

namespace inverter_bus
{
namespace ros_node
{
/// Runs the node from start to end: reads the parameters, starts the bus and all that depends on it, waits for the
/// end and stops the motors.
/// \return the exit status: 0, or 1 for a wrong configuration or a port that is in use
int runNode(Lifetime& lifetime);
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_NODE_H

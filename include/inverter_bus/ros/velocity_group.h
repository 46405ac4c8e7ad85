// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_VELOCITY_GROUP_H
#define INVERTER_BUS_ROS_VELOCITY_GROUP_H

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <inverter_bus/VelocityCommand.h>

namespace inverter_bus
{
namespace ros_node
{
/// A group command with its names resolved.
struct VelocityGroup
{
  /// Empty, or why the group as a whole is refused.
  std::string problem;
  /// Inverters and velocities; of a refused group the zeros only, since a 0 is never refused.
  std::vector<std::pair<std::size_t, double>> targets;
  /// Every inverter that the message names, once.
  std::vector<std::size_t> named;
};

VelocityGroup resolve(const VelocityCommand& message, const std::map<std::string, std::size_t>& index_by_name);
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_VELOCITY_GROUP_H

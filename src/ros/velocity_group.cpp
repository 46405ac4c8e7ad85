// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/ros/velocity_group.h"

#include <algorithm>
#include <set>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
using Target = std::pair<std::size_t, double>;

/// Of a refused group: the zeros, each inverter once.
std::vector<Target> zerosOf(const std::vector<Target>& targets)
{
  std::set<std::size_t> stopped;
  std::vector<Target> zeros;
  for (const Target& target : targets)
  {
    if (target.second == 0.0 && stopped.insert(target.first).second)
    {
      zeros.push_back(target);
    }
  }
  return zeros;
}
}  // namespace

VelocityGroup resolve(const VelocityCommand& message, const std::map<std::string, std::size_t>& index_by_name)
{
  VelocityGroup group;
  if (message.name.size() != message.velocity.size())
  {
    group.problem = "the group has " + std::to_string(message.name.size()) + " names and " +
                    std::to_string(message.velocity.size()) + " velocities; allowed: as many of both";
  }
  std::set<std::size_t> seen;
  for (std::size_t i = 0; i < message.name.size(); ++i)
  {
    const auto found = index_by_name.find(message.name[i]);
    if (found == index_by_name.end())
    {
      group.problem = "the group names '" + message.name[i] + "', which is not in the scan list";
      continue;
    }
    if (!seen.insert(found->second).second)
    {
      group.problem = "the group names '" + message.name[i] + "' twice";
    }
    if (i < message.velocity.size())
    {
      group.targets.emplace_back(found->second, message.velocity[i]);
    }
  }
  group.named.assign(seen.begin(), seen.end());
  if (!group.problem.empty())
  {
    group.targets = zerosOf(group.targets);
  }
  return group;
}
}  // namespace ros_node
}  // namespace inverter_bus

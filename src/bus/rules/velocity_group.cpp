// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/rules/velocity_group.h"

#include <algorithm>
#include <set>

#include "util/printable.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using Target = std::pair<std::size_t, double>;

/// Of a refused group: what stops, each inverter once. An exact 0 goes before one near it, since only it unlocks.
std::vector<Target> stopsOf(std::vector<Target> targets, const IsStop& stops)
{
  std::stable_partition(targets.begin(), targets.end(), [](const Target& target) { return target.second == 0.0; });
  std::set<std::size_t> stopped;
  std::vector<Target> stopping;
  for (const Target& target : targets)
  {
    if (stops(target.first, target.second) && stopped.insert(target.first).second)
    {
      stopping.push_back(target);
    }
  }
  return stopping;
}

/// The first problem is reported: the others would add nothing, and a message may have a million.
void complain(VelocityGroup& group, const std::string& name, const char* why)
{
  if (group.problem.empty())
  {
    group.problem = "the group names '" + util::printable(name) + "'" + why;
  }
}
}  // namespace

VelocityGroup resolveGroup(const std::vector<std::string>& names, const std::vector<double>& velocities,
                           const std::map<std::string, std::size_t>& index_by_name, const IsStop& stops)
{
  VelocityGroup group;
  if (names.size() != velocities.size())
  {
    group.problem = "the group has " + std::to_string(names.size()) + " names and " +
                    std::to_string(velocities.size()) + " velocities; allowed: as many of both";
  }
  std::set<std::size_t> seen;
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    const auto found = index_by_name.find(names[i]);
    if (found == index_by_name.end())
    {
      complain(group, names[i], ", which is not in the scan list");
      continue;
    }
    if (!seen.insert(found->second).second)
    {
      complain(group, names[i], " twice");
    }
    if (i < velocities.size())
    {
      group.targets.emplace_back(found->second, velocities[i]);
    }
  }
  group.named.assign(seen.begin(), seen.end());
  if (!group.problem.empty())
  {
    group.targets = stopsOf(group.targets, stops);
  }
  return group;
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_VELOCITY_GROUP_H
#define INVERTER_BUS_BUS_VELOCITY_GROUP_H

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace inverter_bus
{
namespace bus
{
/// A group command with its names resolved.
struct VelocityGroup
{
  /// Empty, or why the group as a whole is refused.
  std::string problem;
  /// Inverters and velocities; of a refused group those that stop only, since a stop is never refused.
  std::vector<std::pair<std::size_t, double>> targets;
  /// Every inverter that the message names, once.
  std::vector<std::size_t> named;
};

/// Whether a velocity takes an inverter's RUN off: 0, or near it.
using IsStop = std::function<bool(std::size_t inverter, double velocity)>;

/// \p names and \p velocities as a message brought them, of any content and length.
VelocityGroup resolveGroup(const std::vector<std::string>& names, const std::vector<double>& velocities,
                           const std::map<std::string, std::size_t>& index_by_name, const IsStop& stops);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_VELOCITY_GROUP_H

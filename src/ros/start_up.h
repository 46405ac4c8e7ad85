// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_START_UP_H
#define INVERTER_BUS_ROS_START_UP_H

#include <string>
#include <vector>

#include "inverter_bus/bus/configuration.h"
#include "util/steady_event.h"

namespace inverter_bus
{
namespace ros_node
{
/// Returns true when the ROS master answers, false when \p end comes first. Nothing in roscpp waits for the master and can
/// be interrupted.
bool waitForMaster(const util::SteadyEvent& end);

/// The configuration as it is in force, defaults resolved, a line for the bus and one per inverter.
std::vector<std::string> effectiveConfiguration(const bus::BusConfig& config);
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_START_UP_H

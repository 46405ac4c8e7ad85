// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_STATUS_CONVERSION_H
#define INVERTER_BUS_ROS_STATUS_CONVERSION_H

#include <string>

#include <inverter_bus/BusStatus.h>
#include <inverter_bus/Fault.h>
#include <inverter_bus/InverterStatus.h>
#include <ros/time.h>

#include "inverter_bus/bus/configuration.h"
#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace ros_node
{
/// One moment on both clocks, to turn steady time into ROS time.
struct Moment
{
  TimePoint steady;
  ros::Time ros;

  /// Both clocks now.
  static Moment now();
};

/// ROS time of \p time; 0 where ROS time does not reach back that far (simulated time that has just begun, or none yet).
ros::Time toRosTime(TimePoint time, const Moment& moment);

/// The status as the user sees it: signs by the sign of hz_per_unit, NaN and a cleared bit of `known` for what the drive
/// can't tell.
InverterStatus toMessage(const bus::InverterStatus& status, const bus::InverterConfig& config,
                         const drive::Drive& drive, const Moment& moment);

BusStatus toMessage(const bus::BusStatus& status, const std::string& port, const Moment& moment);

Fault toMessage(const drive::FaultRecord& record);
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_STATUS_CONVERSION_H

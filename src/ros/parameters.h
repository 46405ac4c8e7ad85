// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_PARAMETERS_H
#define INVERTER_BUS_ROS_PARAMETERS_H

#include <xmlrpcpp/XmlRpcValue.h>

#include "inverter_bus/bus/configuration.h"

namespace inverter_bus
{
namespace ros_node
{
/// A value of the parameter server; types that no key has (dates, binary) become an empty value.
bus::Value toValue(XmlRpc::XmlRpcValue value);

/// The node's private parameters as a map; an empty map if there are none.
bus::Value readParameters();
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_PARAMETERS_H

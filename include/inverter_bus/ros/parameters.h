// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_PARAMETERS_H
#define INVERTER_BUS_ROS_PARAMETERS_H

#include <string>

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

/// The folder with the drives' profiles: environment variable INVERTER_BUS_DRIVES, or where the package is installed, or its
/// source.
std::string profileDirectory();
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_PARAMETERS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/parameters.h"

#include <ros/param.h>
#include <ros/this_node.h>

namespace inverter_bus
{
namespace ros_node
{
bus::Value toValue(XmlRpc::XmlRpcValue value)
{
  bus::Value result;
  switch (value.getType())
  {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return bus::Value::ofBoolean(static_cast<bool&>(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return bus::Value::ofInteger(static_cast<int&>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return bus::Value::ofNumber(static_cast<double&>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return bus::Value::ofText(static_cast<std::string&>(value));
    case XmlRpc::XmlRpcValue::TypeArray:
      result.type = bus::Value::Type::List;
      for (int i = 0; i < value.size(); ++i)
      {
        result.list.push_back(toValue(value[i]));
      }
      break;
    case XmlRpc::XmlRpcValue::TypeStruct:
      result.type = bus::Value::Type::Map;
      for (auto& entry : value)
      {
        result.map.push_back({ entry.first, toValue(entry.second) });
      }
      break;
    default:
      break;
  }
  return result;
}

bus::Value readParameters()
{
  XmlRpc::XmlRpcValue parameters;
  if (!ros::param::get(ros::this_node::getName(), parameters))
  {
    return bus::Value::ofMap({});
  }
  return toValue(parameters);
}
}  // namespace ros_node
}  // namespace inverter_bus

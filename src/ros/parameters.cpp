// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/parameters.h"

#include <ros/param.h>
#include <ros/this_node.h>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
bus::Value toList(XmlRpc::XmlRpcValue& value)
{
  bus::Value list;
  list.type = bus::Value::Type::List;
  for (int i = 0; i < value.size(); ++i)
  {
    list.list.push_back(toValue(value[i]));
  }
  return list;
}

bus::Value toMap(XmlRpc::XmlRpcValue& value)
{
  bus::Value map;
  map.type = bus::Value::Type::Map;
  for (auto& entry : value)
  {
    map.map[entry.first] = toValue(entry.second);
  }
  return map;
}

bus::Value toScalar(XmlRpc::XmlRpcValue& value)
{
  bus::Value scalar;
  switch (value.getType())
  {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      scalar.type = bus::Value::Type::Boolean;
      scalar.boolean = static_cast<bool&>(value);
      break;
    case XmlRpc::XmlRpcValue::TypeInt:
      scalar.type = bus::Value::Type::Integer;
      scalar.integer = static_cast<int&>(value);
      break;
    case XmlRpc::XmlRpcValue::TypeDouble:
      scalar.type = bus::Value::Type::Number;
      scalar.number = static_cast<double&>(value);
      break;
    case XmlRpc::XmlRpcValue::TypeString:
      scalar.type = bus::Value::Type::Text;
      scalar.text = static_cast<std::string&>(value);
      break;
    default:
      break;
  }
  return scalar;
}
}  // namespace

bus::Value toValue(XmlRpc::XmlRpcValue value)
{
  switch (value.getType())
  {
    case XmlRpc::XmlRpcValue::TypeArray:
      return toList(value);
    case XmlRpc::XmlRpcValue::TypeStruct:
      return toMap(value);
    default:
      return toScalar(value);
  }
}

bus::Value readParameters()
{
  XmlRpc::XmlRpcValue parameters;
  if (!ros::param::get(ros::this_node::getName(), parameters))
  {
    bus::Value empty;
    empty.type = bus::Value::Type::Map;
    return empty;
  }
  return toValue(parameters);
}
}  // namespace ros_node
}  // namespace inverter_bus

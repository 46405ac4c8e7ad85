// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/connections.h"

#include <iterator>

#include <ros/master.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcException.h>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
std::string field(const ros::M_string& header, const std::string& name)
{
  const auto entry = header.find(name);
  return entry == header.end() ? std::string() : entry->second;
}

std::set<std::string> names(XmlRpc::XmlRpcValue& list)
{
  std::set<std::string> result;
  for (int i = 0; i < list.size(); ++i)
  {
    result.insert(static_cast<std::string&>(list[i]));
  }
  return result;
}
}  // namespace

void Connections::setThereBefore(const std::set<std::string>& there_before)
{
  there_before_ = there_before;
}

bus::Publisher Connections::identify(const boost::shared_ptr<ros::M_string>& header)
{
  bus::Publisher publisher;
  if (!header)
  {
    return publisher;
  }
  forgetClosed();
  publisher.name = field(*header, "callerid");
  publisher.latched = field(*header, "latching") == "1";
  const auto found = connections_.find(header.get());
  publisher.first_on_connection = found == connections_.end();
  Connection& connection = connections_[header.get()];
  if (publisher.first_on_connection)
  {
    connection.header = header;
    // Only the first connection of a name is the one from before; a node that comes again is a new one.
    connection.before_start = there_before_.erase(publisher.name) != 0;
  }
  publisher.before_start = connection.before_start;
  return publisher;
}

void Connections::forgetClosed()
{
  for (auto connection = connections_.begin(); connection != connections_.end();)
  {
    connection = connection->second.header.expired() ? connections_.erase(connection) : std::next(connection);
  }
}

std::map<std::string, std::set<std::string>> publishersByTopic()
{
  XmlRpc::XmlRpcValue arguments;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue state;
  arguments[0] = ros::this_node::getName();
  std::map<std::string, std::set<std::string>> publishers;
  if (!ros::master::execute("getSystemState", arguments, response, state, false))
  {
    return publishers;
  }
  try
  {
    XmlRpc::XmlRpcValue& topics = state[0];
    for (int i = 0; i < topics.size(); ++i)
    {
      publishers[static_cast<std::string&>(topics[i][0])] = names(topics[i][1]);
    }
  }
  catch (const XmlRpc::XmlRpcException&)
  {
    publishers.clear();
  }
  return publishers;
}
}  // namespace ros_node
}  // namespace inverter_bus

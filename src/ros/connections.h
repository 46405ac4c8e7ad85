// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_CONNECTIONS_H
#define INVERTER_BUS_ROS_CONNECTIONS_H

#include <map>
#include <set>
#include <string>

#include <ros/datatypes.h>
#include <boost/shared_ptr.hpp>
#include <boost/weak_ptr.hpp>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace ros_node
{
/// Knows the connections of one topic by their headers, and so what a message means: a latched publisher's first message on
/// a connection may be old. One thread only.
class Connections
{
public:
  /// \param there_before names of the nodes that published the topic when we subscribed
  void setThereBefore(const std::set<std::string>& there_before);

  /// The publisher of the message that came with \p header.
  bus::Publisher identify(const boost::shared_ptr<ros::M_string>& header);

private:
  struct Connection
  {
    /// roscpp keeps one header per connection, so its address stands for the connection as long as it lives.
    boost::weak_ptr<ros::M_string> header;
    bool before_start = false;
  };
  void forgetClosed();

  std::map<const ros::M_string*, Connection> connections_;
  std::set<std::string> there_before_;
};

/// Nodes that the master lists as publishers, by topic (resolved names). Empty when the master can't be asked.
std::map<std::string, std::set<std::string>> publishersByTopic();
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_CONNECTIONS_H

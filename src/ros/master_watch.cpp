// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/master_watch.h"

#include <chrono>

#include <ros/master.h>
#include <ros/this_node.h>

#include "ros/log.h"

namespace inverter_bus
{
namespace ros_node
{
namespace
{
constexpr Duration PERIOD = std::chrono::seconds(2);
}  // namespace

MasterWatch::MasterWatch()
{
  thread_ = std::thread([this] { work(); });
}

MasterWatch::~MasterWatch()
{
  stop();
  if (thread_.joinable())
  {
    thread_.join();
  }
}

void MasterWatch::stop()
{
  stopping_.set();
}

std::optional<bus::Finding> MasterWatch::finding() const
{
  return findingOf(state_);
}

void MasterWatch::work()
{
  while (!stopping_.waitFor(PERIOD))
  {
    const State state = look();
    if (state_.exchange(state) == state || stopping_.isSet())
    {
      continue;
    }
    const std::optional<bus::Finding> finding = findingOf(state);
    log(finding ? finding->level : bus::Level::Ok,
        finding ? finding->text : "the ROS master is back and knows this node");
  }
}

MasterWatch::State MasterWatch::look()
{
  if (!ros::master::check())
  {
    return State::NoMaster;
  }
  XmlRpc::XmlRpcValue arguments;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue address;
  arguments[0] = ros::this_node::getName();
  arguments[1] = ros::this_node::getName();
  const bool known = ros::master::execute("lookupNode", arguments, response, address, false);
  // Without a response the master ended just now.
  return known ? State::Known : (response.valid() ? State::Unknown : State::NoMaster);
}

std::optional<bus::Finding> MasterWatch::findingOf(State state)
{
  switch (state)
  {
    case State::NoMaster:
      return bus::Finding{ bus::Level::Warn, "the ROS master at " + ros::master::getURI() +
                                                 " does not answer: no new node can connect; connected nodes can still "
                                                 "command, and the command watchdog and stops work as before" };
    case State::Unknown:
      return bus::Finding{ bus::Level::Warn,
                           "the ROS master was restarted and does not know this node: restart the node; until then "
                           "only nodes that were connected before can command it" };
    case State::Known:
      break;
  }
  return std::nullopt;
}
}  // namespace ros_node
}  // namespace inverter_bus

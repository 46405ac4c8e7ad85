// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_COMMANDS_H
#define INVERTER_BUS_ROS_COMMANDS_H

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <inverter_bus/VelocityCommand.h>
#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <std_msgs/Float64.h>

#include "inverter_bus/bus/bus.h"
#include "ros/connections.h"

namespace inverter_bus
{
namespace ros_node
{
/// Hands velocity commands from the topics to the bus, in the order of their arrival, on a queue and a thread of their own.
class Commands
{
public:
  /// Subscribes to `<inverter>/command` and `command` in \p node; nothing is handed on before start().
  Commands(ros::NodeHandle node, const bus::BusConfig& config, bus::Bus& bus);
  /// As stop().
  ~Commands();

  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;

  /// Starts handing commands on, in a thread of its own.
  void start();
  /// No command reaches the bus afterwards.
  void stop();

  /// Publishers on the command topic of an inverter. Any thread.
  std::uint32_t publishers(std::size_t index) const;
  /// Publishers on the group's topic. Any thread.
  std::uint32_t groupPublishers() const;

private:
  void askForPublishers();
  void work();
  void onCommand(std::size_t index, const ros::MessageEvent<std_msgs::Float64 const>& event);
  void onGroup(const ros::MessageEvent<VelocityCommand const>& event);

  bus::Bus& bus_;
  std::map<std::string, std::size_t> index_by_name_;
  ros::CallbackQueue queue_;
  std::vector<ros::Subscriber> subscribers_;  ///< by inverter
  std::vector<Connections> connections_;      ///< by inverter; command thread only
  ros::Subscriber group_subscriber_;
  Connections group_connections_;  ///< command thread only
  std::atomic<bool> stopping_{ false };
  std::thread thread_;
};
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_COMMANDS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_SERVICES_H
#define INVERTER_BUS_ROS_SERVICES_H

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <inverter_bus/ReadFaults.h>
#include <inverter_bus/ReadParameter.h>
#include <inverter_bus/Reset.h>
#include <inverter_bus/Stop.h>
#include <inverter_bus/WriteParameter.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Trigger.h>

#include "inverter_bus/bus/bus.h"
#include "ros/elastic_queue.h"
#include "ros/trace_files.h"

namespace inverter_bus
{
namespace ros_node
{
/// The services of the node. Each waits for the bus's answer, but not longer than the bus's bound; each callback returns
/// true, so that the caller always gets the reason. Stops have a queue of their own.
class Services
{
public:
  Services(ros::NodeHandle node, const bus::BusConfig& config, bus::Bus& bus, TraceFiles& traces);
  /// As stop().
  ~Services();

  Services(const Services&) = delete;
  Services& operator=(const Services&) = delete;

  /// Waits until the calls that are under way are answered (at most \p timeout).
  void drain(Duration timeout);
  /// Withdraws the services.
  void stop();

private:
  void advertiseFor(ros::NodeHandle& node, std::size_t index, const std::string& name);
  template <typename Service>
  void advertise(ros::NodeHandle& node, const std::string& name, ElasticQueue& queue,
                 std::function<void(const typename Service::Request&, typename Service::Response&)> handler);

  void answerStop(std::optional<std::size_t> index, const Stop::Request& request, Stop::Response& response);
  void answerReset(std::size_t index, Reset::Response& response);
  void answerReadFaults(std::size_t index, ReadFaults::Response& response);
  void answerReadParameter(std::size_t index, const ReadParameter::Request& request, ReadParameter::Response& response);
  void answerWriteParameter(std::size_t index, const WriteParameter::Request& request,
                            WriteParameter::Response& response);
  void answerDumpTrace(std_srvs::Trigger::Response& response);

  bus::Bus& bus_;
  TraceFiles& traces_;
  const bus::ServiceBounds bounds_;
  std::atomic<std::size_t> waiting_stops_{ 0 };
  ElasticQueue stop_queue_;
  ElasticQueue queue_;
  std::vector<ros::ServiceServer> servers_;  ///< after the queues: they are withdrawn first
};
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_SERVICES_H

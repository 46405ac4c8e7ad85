// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_PUBLISHING_H
#define INVERTER_BUS_ROS_PUBLISHING_H

#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "inverter_bus/bus/configuration.h"
#include "inverter_bus/bus/types.h"
#include "ros/log_throttle.h"
#include "ros/status_conversion.h"
#include "ros/trace_files.h"
#include "util/steady_condition.h"

namespace inverter_bus
{
namespace ros_node
{
/// Takes what the bus reports and publishes and logs it from a thread of its own: whatever roscpp or the console wait for
/// (a slow subscriber, a full pipe), the bus thread does not.
class Publishing : public bus::Observer
{
public:
  /// Advertises `<inverter>/status` and `bus_status` in \p node, and starts the thread.
  Publishing(ros::NodeHandle& node, const bus::Configuration& configuration, TraceFiles& traces);
  /// As stop().
  ~Publishing() override;

  Publishing(const Publishing&) = delete;
  Publishing& operator=(const Publishing&) = delete;

  // Any thread; none blocks.
  void inverterStatus(const bus::InverterStatus& status) override;
  void busStatus(const bus::BusStatus& status) override;
  void log(const bus::Finding& finding) override;
  void trace(bus::TraceDump dump) override;

  /// Publishes and logs all that waits, and ends the thread. Nothing is published or logged afterwards.
  void stop();

private:
  using Item = std::variant<bus::InverterStatus, bus::BusStatus, bus::Finding>;

  void add(std::deque<Item>& queue, Item item);
  void work();
  void waitForWork(std::unique_lock<std::mutex>& lock);
  std::optional<Item> takeNext();
  void handle(const Item& item);
  void publish(const bus::InverterStatus& status);
  void publish(const bus::BusStatus& status);
  void publish(const bus::Finding& finding);
  void write(const bus::Finding& finding);
  const Moment& momentOf(const bus::InverterStatus& status);

  const bus::BusConfig config_;
  const std::vector<drive::Drive> drives_;
  TraceFiles& traces_;
  std::vector<ros::Publisher> inverter_publishers_;
  ros::Publisher bus_publisher_;
  LogThrottle throttle_;         ///< publisher thread only
  std::vector<Moment> moments_;  ///< of each inverter's last reply; publisher thread only

  std::mutex mutex_;
  util::SteadyCondition changed_;
  std::deque<Item> findings_;
  std::deque<Item> statuses_;
  bool stopping_ = false;
  std::thread thread_;
};
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_PUBLISHING_H

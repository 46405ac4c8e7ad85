// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/publishing.h"

#include <chrono>
#include <utility>

#include "ros/log.h"
#include "ros/status_conversion.h"

namespace inverter_bus
{
namespace ros_node
{
namespace
{
/// More waiting messages than this are out of date: the oldest goes.
constexpr std::size_t MOST_WAITING = 500;

constexpr std::uint32_t STATUS_QUEUE = 10;
}  // namespace

Publishing::Publishing(ros::NodeHandle& node, const bus::Configuration& configuration, TraceFiles& traces)
  : config_(configuration.bus), drives_(configuration.drives), traces_(traces)
{
  for (const bus::InverterConfig& inverter : config_.inverters)
  {
    inverter_publishers_.push_back(node.advertise<InverterStatus>(inverter.name + "/status", STATUS_QUEUE));
  }
  bus_publisher_ = node.advertise<BusStatus>("bus_status", 1, true);
  moments_.resize(config_.inverters.size());
  thread_ = std::thread([this] { work(); });
}

Publishing::~Publishing()
{
  stop();
}

void Publishing::inverterStatus(const bus::InverterStatus& status)
{
  add(statuses_, status);
}

void Publishing::busStatus(const bus::BusStatus& status)
{
  add(statuses_, status);
}

void Publishing::log(const bus::Finding& finding)
{
  add(findings_, finding);
}

void Publishing::trace(bus::TraceDump dump)
{
  traces_.writeSoon(std::move(dump));
}

void Publishing::stop()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notifyOne();
  if (thread_.joinable())
  {
    thread_.join();
  }
}

void Publishing::add(std::deque<Item>& queue, Item item)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (queue.size() >= MOST_WAITING)
    {
      queue.pop_front();
    }
    queue.push_back(std::move(item));
  }
  changed_.notifyOne();
}

void Publishing::work()
{
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_ || !findings_.empty() || !statuses_.empty())
  {
    waitForWork(lock);
    const std::optional<Item> item = takeNext();
    lock.unlock();
    if (item)
    {
      handle(*item);
    }
    for (const bus::Finding& finding : throttle_.takeDue(std::chrono::steady_clock::now()))
    {
      write(finding);
    }
    lock.lock();
  }
  for (const bus::Finding& finding : throttle_.takeHeld())
  {
    write(finding);
  }
}

void Publishing::waitForWork(std::unique_lock<std::mutex>& lock)
{
  const auto ready = [this] { return stopping_ || !findings_.empty() || !statuses_.empty(); };
  if (const std::optional<TimePoint> due = throttle_.nextDue())
  {
    changed_.waitUntil(lock, *due, ready);
    return;
  }
  changed_.wait(lock, ready);
}

/// Lines of the log go first.
std::optional<Publishing::Item> Publishing::takeNext()
{
  std::deque<Item>& queue = findings_.empty() ? statuses_ : findings_;
  if (queue.empty())
  {
    return std::nullopt;
  }
  std::optional<Item> item = std::move(queue.front());
  queue.pop_front();
  return item;
}

void Publishing::handle(const Item& item)
{
  std::visit([this](const auto& report) { publish(report); }, item);
}

/// A reply keeps the ROS time that it got when its status was published first, however often it is shown again.
const Moment& Publishing::momentOf(const bus::InverterStatus& status)
{
  Moment& moment = moments_[status.index];
  if (status.has_stamp && moment.steady != status.stamp)
  {
    moment = Moment{ status.stamp, toRosTime(status.stamp, Moment::now()) };
  }
  return moment;
}

void Publishing::publish(const bus::InverterStatus& status)
{
  if (status.index < inverter_publishers_.size())
  {
    inverter_publishers_[status.index].publish(
        toMessage(status, config_.inverters[status.index], drives_[status.index], momentOf(status)));
  }
}

void Publishing::publish(const bus::BusStatus& status)
{
  bus_publisher_.publish(toMessage(status, config_.port, Moment::now()));
}

void Publishing::publish(const bus::Finding& finding)
{
  if (throttle_.admit(finding, std::chrono::steady_clock::now()))
  {
    write(finding);
  }
}

void Publishing::write(const bus::Finding& finding)
{
  const std::size_t suppressed = throttle_.takeSuppressed();
  const std::string more = suppressed == 0 ? "" : " (" + std::to_string(suppressed) + " repeated lines left out)";
  ros_node::log(finding.level, finding.text + more);
}
}  // namespace ros_node
}  // namespace inverter_bus

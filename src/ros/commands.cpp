// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/commands.h"

#include <utility>

#include <ros/subscribe_options.h>
#include <ros/transport_hints.h>
#include <boost/function.hpp>

#include "bus/rules/velocity_group.h"

namespace inverter_bus
{
namespace ros_node
{
namespace
{
/// Not 1: a queue of 1 keeps the newest only, and a 0 between two velocities stops the motor and must not get lost.
constexpr std::uint32_t QUEUE_SIZE = 100;

/// How soon the thread sees that it shall end.
const ros::WallDuration PATIENCE(0.1);

template <typename Message>
ros::Subscriber subscribe(ros::NodeHandle& node, const std::string& topic,
                          const boost::function<void(const ros::MessageEvent<Message const>&)>& callback)
{
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const ros::MessageEvent<Message const>&>(topic, QUEUE_SIZE, callback);
  // Else the kernel may hold a small message back for 40 ms.
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return node.subscribe(options);
}
}  // namespace

Commands::Commands(ros::NodeHandle node, const bus::BusConfig& config, bus::Bus& bus)
  : bus_(bus), connections_(config.inverters.size())
{
  node.setCallbackQueue(&queue_);
  for (std::size_t i = 0; i < config.inverters.size(); ++i)
  {
    const std::string& name = config.inverters[i].name;
    index_by_name_[name] = i;
    subscribers_.push_back(subscribe<std_msgs::Float64>(
        node, name + "/command",
        [this, i](const ros::MessageEvent<std_msgs::Float64 const>& event) { onCommand(i, event); }));
  }
  group_subscriber_ = subscribe<VelocityCommand>(
      node, "command", [this](const ros::MessageEvent<VelocityCommand const>& event) { onGroup(event); });
  askForPublishers();
}

Commands::~Commands()
{
  stop();
}

void Commands::start()
{
  thread_ = std::thread([this] { work(); });
}

void Commands::stop()
{
  stopping_ = true;
  if (thread_.joinable())
  {
    thread_.join();
  }
  queue_.disable();
  queue_.clear();
}

std::uint32_t Commands::publishers(std::size_t index) const
{
  return subscribers_[index].getNumPublishers();
}

std::uint32_t Commands::groupPublishers() const
{
  return group_subscriber_.getNumPublishers();
}

/// After subscribing and before the first callback: a publisher that is not listed now came later than this node.
void Commands::askForPublishers()
{
  const std::map<std::string, std::set<std::string>> publishers = publishersByTopic();
  const auto of = [&publishers](const ros::Subscriber& subscriber) {
    const auto found = publishers.find(subscriber.getTopic());
    return found == publishers.end() ? std::set<std::string>() : found->second;
  };
  for (std::size_t i = 0; i < subscribers_.size(); ++i)
  {
    connections_[i].setThereBefore(of(subscribers_[i]));
  }
  group_connections_.setThereBefore(of(group_subscriber_));
}

void Commands::work()
{
  while (!stopping_)
  {
    queue_.callAvailable(PATIENCE);
  }
}

void Commands::onCommand(std::size_t index, const ros::MessageEvent<std_msgs::Float64 const>& event)
{
  bus::VelocityCommand command;
  command.targets.emplace_back(index, event.getConstMessage()->data);
  command.publisher = connections_[index].identify(event.getConnectionHeaderPtr());
  command.publisher.topic = "inverter";
  bus_.command(command);
}

void Commands::onGroup(const ros::MessageEvent<VelocityCommand const>& event)
{
  const VelocityCommand& message = *event.getConstMessage();
  const auto stops = [this](std::size_t index, double velocity) { return bus_.stops(index, velocity); };
  bus::VelocityGroup group = bus::resolveGroup(message.name, message.velocity, index_by_name_, stops);
  bus::VelocityCommand command;
  command.targets = std::move(group.targets);
  command.grouped = true;
  command.publisher = group_connections_.identify(event.getConnectionHeaderPtr());
  command.publisher.topic = "group";
  if (!command.targets.empty())
  {
    bus_.command(command);
  }
  // After the zeros, whose acceptance would clear the error again.
  if (!group.problem.empty())
  {
    bus_.refuse(group.named, bus::ERROR_OUT_OF_RANGE, group.problem, true);
  }
}
}  // namespace ros_node
}  // namespace inverter_bus

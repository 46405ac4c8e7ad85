// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_MASTER_WATCH_H
#define INVERTER_BUS_ROS_MASTER_WATCH_H

#include <atomic>
#include <optional>
#include <thread>

#include "inverter_bus/bus/types.h"
#include "util/steady_event.h"

namespace inverter_bus
{
namespace ros_node
{
/// Looks whether the ROS master is there and knows this node. A master that was restarted does not, and roscpp never
/// registers again: the node goes on with the nodes that are connected, but no new one finds it. It says so.
class MasterWatch
{
public:
  MasterWatch();
  /// Waits for the question on its way: as long as the master takes.
  ~MasterWatch();

  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

  /// The finding, if anything is wrong. Any thread.
  std::optional<bus::Finding> finding() const;

  /// Says nothing more. Does not wait.
  void stop();

private:
  enum class State
  {
    Known,
    NoMaster,
    Unknown
  };

  void work();
  static State look();
  static std::optional<bus::Finding> findingOf(State state);

  std::atomic<State> state_{ State::Known };
  util::SteadyEvent stopping_;
  std::thread thread_;
};
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_MASTER_WATCH_H

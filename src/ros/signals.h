// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_SIGNALS_H
#define INVERTER_BUS_ROS_SIGNALS_H

#include <csignal>
#include <functional>
#include <string>
#include <thread>

namespace inverter_bus
{
namespace ros_node
{
/// Takes SIGINT, SIGTERM and SIGHUP as values instead of interruptions: blocked in every thread, read by one. A second Ctrl-C
/// is read and changes nothing.
class Signals
{
public:
  /// Blocks the signals in this thread and in all that it starts: make it first in main().
  Signals();
  /// Ends the thread; the signals stay blocked.
  ~Signals();

  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// \p callback is called from the thread of this object with the name of every signal that comes, from now on.
  void listen(std::function<void(const std::string&)> callback);

private:
  void work();

  sigset_t signals_;
  int file_ = -1;
  int wake_ = -1;
  std::function<void(const std::string&)> callback_;
  std::thread thread_;
};
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_SIGNALS_H

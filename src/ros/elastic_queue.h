// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_ELASTIC_QUEUE_H
#define INVERTER_BUS_ROS_ELASTIC_QUEUE_H

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <mutex>

#include <ros/callback_queue_interface.h>
#include <boost/thread/thread.hpp>

#include "inverter_bus/util/clock.h"
#include "util/steady_condition.h"

namespace inverter_bus
{
namespace ros_node
{
/// Runs every callback at once, on a thread of its own if all others are busy. A roscpp service call blocks its thread until
/// it is answered; on a queue with a fixed number of threads, that many waiting calls would delay the next one.
///
/// Callbacks run concurrently and in no order. Any thread may call any function; shutdown() and the destructor must not be
/// called by a callback of the queue.
class ElasticQueue : public ros::CallbackQueueInterface
{
public:
  /// \param most_threads callbacks beyond this number wait for one of them to end; at least 1
  explicit ElasticQueue(std::size_t most_threads);
  /// As shutdown().
  ~ElasticQueue() override;  // NOLINT(bugprone-exception-escape): see its definition

  ElasticQueue(const ElasticQueue&) = delete;
  ElasticQueue& operator=(const ElasticQueue&) = delete;

  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t owner_id = 0) override;
  /// Takes out the callbacks of \p owner_id that wait and returns when none of them runs any more. A callback may remove its
  /// own owner: it does not wait for itself.
  void removeByID(std::uint64_t owner_id) override;

  /// True when nothing waited or ran any more within \p timeout.
  bool waitIdle(Duration timeout);
  /// Drops waiting callbacks, takes no more, and returns when the running ones have ended.
  void shutdown();

  /// Threads that exist now.
  std::size_t threads() const;

private:
  struct Task
  {
    ros::CallbackInterfacePtr callback;
    std::uint64_t owner_id;
  };
  using Threads = std::list<boost::thread>;

  void grow();
  void dropWaiting(std::uint64_t owner_id);
  void work(Threads::iterator self);
  void run(Task task, std::unique_lock<std::mutex>& lock);
  void retire(Threads::iterator self);
  void joinRetired();
  bool idle() const;

  const std::size_t most_threads_;
  mutable std::mutex mutex_;
  util::SteadyCondition work_;     ///< for the threads of the pool
  util::SteadyCondition changed_;  ///< for the calls that wait for the end of something
  std::list<Task> waiting_;
  std::map<std::uint64_t, std::size_t> running_;  ///< callbacks by owner
  Threads threads_;
  Threads retired_;  ///< ended or about to; to be joined
  std::size_t free_threads_ = 0;
  bool stopping_ = false;
};
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_ELASTIC_QUEUE_H

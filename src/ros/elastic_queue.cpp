// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/elastic_queue.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
/// Threads that stay when there is nothing to do; a burst beyond them costs a thread start each.
constexpr std::size_t THREADS_KEPT = 4;

/// Enough for a service callback with logging, small enough for hundreds of threads.
constexpr std::size_t STACK_SIZE = std::size_t{ 512 } * 1024;

/// The callback that this thread executes, so that a callback that removes its own owner does not wait for itself.
thread_local const ElasticQueue* executing_queue = nullptr;
thread_local std::uint64_t executing_owner = 0;
}  // namespace

ElasticQueue::ElasticQueue(std::size_t most_threads) : most_threads_(std::max<std::size_t>(1, most_threads))
{
  // The first thread is made here, so that later failures to make one only delay.
  const std::lock_guard<std::mutex> lock(mutex_);
  grow();
}

// NOLINTNEXTLINE(bugprone-exception-escape): join() throws for interrupted threads, and none is ever interrupted
ElasticQueue::~ElasticQueue()
{
  shutdown();
}

void ElasticQueue::addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t owner_id)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stopping_)
    {
      return;
    }
    waiting_.push_back(Task{ callback, owner_id });
    if (free_threads_ < waiting_.size() && threads_.size() < most_threads_)
    {
      try
      {
        grow();
      }
      catch (const boost::thread_resource_error&)
      {
        // The system has no more threads: a running one takes it when it is free.
      }
    }
  }
  work_.notifyOne();
  joinRetired();
}

void ElasticQueue::removeByID(std::uint64_t owner_id)
{
  dropWaiting(owner_id);
  std::unique_lock<std::mutex> lock(mutex_);
  const std::size_t own = executing_queue == this && executing_owner == owner_id ? 1 : 0;
  changed_.wait(lock, [this, owner_id, own] {
    const auto running = running_.find(owner_id);
    return running == running_.end() || running->second <= own;
  });
}

bool ElasticQueue::waitIdle(Duration timeout)
{
  std::unique_lock<std::mutex> lock(mutex_);
  return changed_.waitFor(lock, timeout, [this] { return idle(); });
}

void ElasticQueue::dropWaiting(std::uint64_t owner_id)
{
  // Destroyed without the lock: a callback may hold the last reference to something that uses this queue.
  std::list<Task> dropped;
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto task = waiting_.begin(); task != waiting_.end();)
  {
    const auto next = std::next(task);
    if (task->owner_id == owner_id)
    {
      dropped.splice(dropped.end(), waiting_, task);
    }
    task = next;
  }
  changed_.notifyAll();
}

void ElasticQueue::shutdown()
{
  std::list<Task> dropped;
  {
    std::unique_lock<std::mutex> lock(mutex_);
    stopping_ = true;
    dropped.swap(waiting_);
    work_.notifyAll();
    changed_.wait(lock, [this] { return threads_.empty(); });
  }
  joinRetired();
}

std::size_t ElasticQueue::threads() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return threads_.size();
}

/// Mutex held.
void ElasticQueue::grow()
{
  boost::thread::attributes attributes;
  attributes.set_stack_size(STACK_SIZE);
  threads_.emplace_front();
  const Threads::iterator self = threads_.begin();
  try
  {
    *self = boost::thread(attributes, [this, self] { work(self); });
  }
  catch (...)
  {
    threads_.erase(self);
    throw;
  }
  ++free_threads_;
}

void ElasticQueue::work(Threads::iterator self)
{
  std::unique_lock<std::mutex> lock(mutex_);
  while (true)
  {
    work_.wait(lock, [this] { return stopping_ || !waiting_.empty() || free_threads_ > THREADS_KEPT; });
    if (waiting_.empty())
    {
      // Stopping, or more threads than are kept.
      retire(self);
      return;
    }
    Task task = std::move(waiting_.front());
    waiting_.pop_front();
    --free_threads_;
    run(std::move(task), lock);
    ++free_threads_;
  }
}

void ElasticQueue::run(Task task, std::unique_lock<std::mutex>& lock)
{
  const std::uint64_t owner_id = task.owner_id;
  ++running_[owner_id];
  lock.unlock();
  executing_queue = this;
  executing_owner = owner_id;
  const auto result = task.callback->ready() ? task.callback->call() : ros::CallbackInterface::TryAgain;
  executing_queue = nullptr;
  if (result != ros::CallbackInterface::TryAgain)
  {
    task.callback.reset();  // without the lock, as in dropWaiting()
  }
  lock.lock();
  if (result == ros::CallbackInterface::TryAgain && !stopping_)
  {
    waiting_.push_back(std::move(task));
  }
  if (--running_[owner_id] == 0)
  {
    running_.erase(owner_id);
  }
  changed_.notifyAll();
}

/// Mutex held. The caller's thread ends after this.
void ElasticQueue::retire(Threads::iterator self)
{
  --free_threads_;
  retired_.splice(retired_.begin(), threads_, self);
  changed_.notifyAll();
}

void ElasticQueue::joinRetired()
{
  Threads ended;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended.swap(retired_);
  }
  for (boost::thread& thread : ended)
  {
    thread.join();
  }
}

/// Mutex held.
bool ElasticQueue::idle() const
{
  return waiting_.empty() && running_.empty();
}
}  // namespace ros_node
}  // namespace inverter_bus

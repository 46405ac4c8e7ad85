// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/steady_event.h"

#include <ctime>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
timespec after(Duration timeout)
{
  constexpr long NANOSECONDS = 1000000000L;
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  time.tv_sec += static_cast<time_t>(timeout.count() / NANOSECONDS);
  time.tv_nsec += static_cast<long>(timeout.count() % NANOSECONDS);
  if (time.tv_nsec >= NANOSECONDS)
  {
    time.tv_nsec -= NANOSECONDS;
    ++time.tv_sec;
  }
  return time;
}
}  // namespace

SteadyEvent::SteadyEvent()
{
  pthread_condattr_t attributes;
  pthread_condattr_init(&attributes);
  pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
  pthread_cond_init(&condition_, &attributes);
  pthread_condattr_destroy(&attributes);
  pthread_mutex_init(&mutex_, nullptr);
}

SteadyEvent::~SteadyEvent()
{
  pthread_cond_destroy(&condition_);
  pthread_mutex_destroy(&mutex_);
}

void SteadyEvent::set()
{
  pthread_mutex_lock(&mutex_);
  set_ = true;
  pthread_cond_broadcast(&condition_);
  pthread_mutex_unlock(&mutex_);
}

bool SteadyEvent::isSet() const
{
  pthread_mutex_lock(&mutex_);
  const bool set = set_;
  pthread_mutex_unlock(&mutex_);
  return set;
}

bool SteadyEvent::waitFor(Duration timeout) const
{
  const timespec deadline = after(timeout < Duration::zero() ? Duration::zero() : timeout);
  pthread_mutex_lock(&mutex_);
  int result = 0;
  while (!set_ && result == 0)
  {
    result = pthread_cond_timedwait(&condition_, &mutex_, &deadline);
  }
  const bool set = set_;
  pthread_mutex_unlock(&mutex_);
  return set;
}
}  // namespace ros_node
}  // namespace inverter_bus

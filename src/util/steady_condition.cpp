// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "util/steady_condition.h"

#include <algorithm>
#include <ctime>

#include "util/timespec.h"

namespace inverter_bus
{
namespace util
{
// Boost's condition variable would be steady, too, but only as long as no macro of its configuration says otherwise;
// pthread_condattr_setclock() is sure with every compiler.
SteadyCondition::SteadyCondition()
{
  pthread_condattr_t attributes;
  pthread_condattr_init(&attributes);
  pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
  pthread_cond_init(&condition_, &attributes);
  pthread_condattr_destroy(&attributes);
}

SteadyCondition::~SteadyCondition()
{
  pthread_cond_destroy(&condition_);
}

void SteadyCondition::notifyOne()
{
  pthread_cond_signal(&condition_);
}

void SteadyCondition::notifyAll()
{
  pthread_cond_broadcast(&condition_);
}

TimePoint SteadyCondition::fromNow(Duration timeout)
{
  const TimePoint now = std::chrono::steady_clock::now();
  return now + std::min(std::max(timeout, Duration::zero()), Duration(TimePoint::max() - now));
}

void SteadyCondition::block(std::unique_lock<std::mutex>& lock)
{
  pthread_cond_wait(&condition_, lock.mutex()->native_handle());
}

bool SteadyCondition::blockUntil(std::unique_lock<std::mutex>& lock, TimePoint deadline)
{
  const timespec time = monotonicTime(deadline);
  return pthread_cond_timedwait(&condition_, lock.mutex()->native_handle(), &time) == 0;
}
}  // namespace util
}  // namespace inverter_bus

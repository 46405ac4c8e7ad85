// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_UTIL_STEADY_CONDITION_H
#define INVERTER_BUS_UTIL_STEADY_CONDITION_H

#include <pthread.h>

#include <mutex>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace util
{
/// A condition variable whose time-outs are on the steady clock. std::condition_variable of GCC 9 waits on the wall clock,
/// whatever clock it is given: a wall clock that is set back by an hour would hold the command watchdog up for an hour.
/// Every wait of this package goes through here or through SteadyClock (test/steady_waits_test.py).
class SteadyCondition
{
public:
  SteadyCondition();
  ~SteadyCondition();

  SteadyCondition(const SteadyCondition&) = delete;
  SteadyCondition& operator=(const SteadyCondition&) = delete;

  /// Any thread, with or without the mutex of the waiting threads held.
  void notifyOne();
  void notifyAll();

  /// Waits until \p ready() is true. \p lock must hold its mutex; it is given up while this waits, and held whenever \p ready
  /// is called. All threads that wait at the same time must use the same mutex.
  template <typename Ready>
  void wait(std::unique_lock<std::mutex>& lock, Ready ready)
  {
    while (!ready())
    {
      block(lock);
    }
  }

  /// As wait(), but no longer than until \p deadline.
  /// \return what \p ready() says at the end
  template <typename Ready>
  bool waitUntil(std::unique_lock<std::mutex>& lock, TimePoint deadline, Ready ready)
  {
    while (!ready())
    {
      if (!blockUntil(lock, deadline))
      {
        return ready();
      }
    }
    return true;
  }

  /// As waitUntil(), with \p timeout from now; one below 0 is 0, one beyond the clock's end is the end.
  template <typename Ready>
  bool waitFor(std::unique_lock<std::mutex>& lock, Duration timeout, Ready ready)
  {
    return waitUntil(lock, fromNow(timeout), ready);
  }

private:
  static TimePoint fromNow(Duration timeout);
  void block(std::unique_lock<std::mutex>& lock);
  /// False: the time is over.
  bool blockUntil(std::unique_lock<std::mutex>& lock, TimePoint deadline);

  pthread_cond_t condition_;
};
}  // namespace util
}  // namespace inverter_bus

#endif  // INVERTER_BUS_UTIL_STEADY_CONDITION_H

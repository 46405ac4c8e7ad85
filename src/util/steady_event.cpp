// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "util/steady_event.h"

namespace inverter_bus
{
namespace util
{
void SteadyEvent::set()
{
  const std::lock_guard<std::mutex> guard(mutex_);
  set_ = true;
  // With the mutex held: whoever waited may destroy this as soon as it gets the mutex.
  changed_.notifyAll();
}

bool SteadyEvent::isSet() const
{
  const std::lock_guard<std::mutex> guard(mutex_);
  return set_;
}

bool SteadyEvent::waitFor(Duration timeout) const
{
  std::unique_lock<std::mutex> lock(mutex_);
  return changed_.waitFor(lock, timeout, [this] { return set_; });
}
}  // namespace util
}  // namespace inverter_bus

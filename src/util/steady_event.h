// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_UTIL_STEADY_EVENT_H
#define INVERTER_BUS_UTIL_STEADY_EVENT_H

#include <mutex>

#include "util/steady_condition.h"

namespace inverter_bus
{
namespace util
{
/// Something that happens once, and can be waited for on the steady clock.
class SteadyEvent
{
public:
  /// Any thread, any number of times.
  void set();
  bool isSet() const;
  /// Returns at once when it has happened; false if it has not after \p timeout.
  bool waitFor(Duration timeout) const;

private:
  mutable std::mutex mutex_;
  mutable SteadyCondition changed_;
  bool set_ = false;
};
}  // namespace util
}  // namespace inverter_bus

#endif  // INVERTER_BUS_UTIL_STEADY_EVENT_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "util/timespec.h"

#include <algorithm>

namespace inverter_bus
{
namespace util
{
timespec monotonicTime(TimePoint time)
{
  const Duration since_start = std::max(Duration::zero(), Duration(time.time_since_epoch()));
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since_start);
  timespec result{};
  result.tv_sec = static_cast<time_t>(whole.count());
  result.tv_nsec = static_cast<long>((since_start - whole).count());
  return result;
}
}  // namespace util
}  // namespace inverter_bus

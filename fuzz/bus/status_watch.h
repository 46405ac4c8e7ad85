// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_STATUS_WATCH_H
#define INVERTER_BUS_FUZZ_STATUS_WATCH_H

#include <cstdint>
#include <string>

#include "fuzz/bus/checks.h"

namespace inverter_bus
{
namespace fuzz
{
/// Reports to the checks what the node publishes, and what it logs.
class StatusWatch
{
public:
  explicit StatusWatch(Checks& checks);

  void published(TimePoint now, const bus::InverterStatus& status);
  /// A line of the log.
  void logged(TimePoint now, const std::string& line) const;
  std::uint64_t statuses() const;

private:
  void takeOffline(TimePoint now, std::size_t index);
  void takeStatus(TimePoint now, const bus::InverterStatus& status);
  void takeTrip(TimePoint now, std::size_t index);
  void takeLock(TimePoint now, std::size_t index);

  Checks& checks_;
  std::uint64_t statuses_ = 0;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_STATUS_WATCH_H

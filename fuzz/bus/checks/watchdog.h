// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_WATCHDOG_H
#define INVERTER_BUS_FUZZ_CHECKS_WATCHDOG_H

#include <optional>

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rule 4.3: an inverter whose commands no longer come is stopped.
class Watchdog
{
public:
  explicit Watchdog(const Observed& observed);

  /// When the command watchdog of an inverter ran out, as seen by what is sent \p now; nothing: it has not. The node
  /// looks at its watchdogs before each exchange.
  std::optional<TimePoint> expired(TimePoint now, std::size_t index) const;
  void checkOverdue(TimePoint now, std::size_t index) const;

private:
  Duration timeout(std::size_t index) const;

  const Observed& observed_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_WATCHDOG_H

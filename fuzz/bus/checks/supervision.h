// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_SUPERVISION_H
#define INVERTER_BUS_FUZZ_CHECKS_SUPERVISION_H

#include <deque>
#include <functional>
#include <vector>

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rule 3.12: a running drive is served within its own communication time-out, as the drive itself sees it.
class Supervision
{
public:
  /// \p budget_warns the node itself warns that this cannot be met for an inverter.
  Supervision(const Observed& observed, std::function<bool(std::size_t)> budget_warns);

  void cameOnline(TimePoint now, std::size_t index);
  void ended(TimePoint now);
  /// A request has reached its drive, and the record does not know of it yet.
  void check(TimePoint now, std::size_t index) const;

private:
  bool isCalm(TimePoint from, std::size_t index) const;

  const Observed& observed_;
  std::function<bool(std::size_t)> budget_warns_;
  std::vector<TimePoint> online_since_;
  std::deque<TimePoint> unanswered_;  ///< exchanges of the last seconds
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_SUPERVISION_H

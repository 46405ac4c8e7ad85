// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_SLOW_READS_H
#define INVERTER_BUS_FUZZ_CHECKS_SLOW_READS_H

#include <cstddef>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "fuzz/bus/observed.h"
#include "fuzz/bus/recorder.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Contract, 8.3: slow values take at most 7.5 % of the wire over 10 s, and none is read more often than slow_interval.
class SlowReads
{
public:
  explicit SlowReads(const Observed& observed);

  /// A request goes.
  void begins(TimePoint now);
  void answered(TimePoint now, std::size_t index, const ReplyFacts& reply);
  /// Its exchange is over.
  void ended(TimePoint now);
  /// What was read of this one no longer counts: all is read again.
  void wentOffline(std::size_t index);

private:
  const Observed& observed_;
  /// End and cost of each in the window.
  std::deque<std::pair<TimePoint, Duration>> spent_;
  Duration sum_{ 0 };
  /// Last answer by address, of each inverter.
  std::vector<std::map<unsigned, TimePoint>> answered_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_SLOW_READS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_STOPS_H
#define INVERTER_BUS_FUZZ_CHECKS_STOPS_H

#include <cstdint>
#include <optional>
#include <vector>

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rules 3.1 and 4.3: a stop is the next frame on the wire, and its first byte goes within the exchange in flight plus
/// the gap.
class Stops
{
public:
  explicit Stops(const Observed& observed);

  /// Somebody has called the service.
  void requested(TimePoint now, std::size_t index);
  /// The command watchdog has run out at \p since.
  void watchdogExpired(TimePoint since, std::size_t index);
  /// It is not waited for any more: the drive or the port is gone, or the program ends.
  void drop(std::size_t index);
  void dropAll();
  /// A request is about to go: it must be a stop while one waits.
  void checkNextFrame(TimePoint now) const;
  /// The request that goes may be a stop.
  void sent(TimePoint now);
  /// An exchange is over.
  void ended();
  void checkOverdue(TimePoint now, std::size_t index) const;

  /// Not yet sent.
  bool waits(std::size_t index) const;
  std::uint64_t checked() const;
  Duration worst() const;

private:
  struct Lane
  {
    std::optional<TimePoint> due;
    bool measured = false;
    /// The time of its own RUN, which another inverter's stop may have given up: its own stop waits for it (8.4).
    TimePoint run_until;
    /// Stops in a row since its last RUN, none of them long after the one before.
    unsigned in_a_row = 0;
  };

  void measure(TimePoint now, TimePoint due, TimePoint sent_before);

  const Observed& observed_;
  std::vector<Lane> lanes_;
  TimePoint last_sent_;  ///< of any inverter
  std::uint64_t checked_ = 0;
  Duration worst_{ 0 };
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_STOPS_H

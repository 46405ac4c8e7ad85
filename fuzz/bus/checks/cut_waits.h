// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_CUT_WAITS_H
#define INVERTER_BUS_FUZZ_CHECKS_CUT_WAITS_H

#include <optional>
#include <vector>

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rule 8.4: a stop, and nothing else, ends the wait for another exchange, not before the drive has had its time and not
/// later, and not that for a reset, a write to the EEPROM, another stop or its own drive's RUN.
class CutWaits
{
public:
  explicit CutWaits(const Observed& observed);

  /// Somebody has called the service, or all wait for something else to end.
  void asked(TimePoint now, std::size_t index);
  /// 0, or near it, was commanded.
  void zeroCame();
  void dropAll();
  /// A request is about to go, and the record knows it.
  void begins(TimePoint now);
  /// An answer came to the exchange in flight; \p began: its first byte on the line.
  void answered(TimePoint began, bool good);
  void ended(TimePoint now);

  /// Stops whose time to the wire was judged.
  std::uint64_t checked() const;

private:
  struct Station
  {
    /// Of its replies to reads so far, by the line: the longest of the last ones, and of all [from the request's end].
    std::vector<Duration> last;
    std::size_t next = 0;
    Duration longest{ 0 };
  };
  /// An exchange that was in flight when a stop was asked for.
  struct Due
  {
    TimePoint at;
    TimePoint request_end;
    Duration patience{ 0 };
  };

  bool isLasting(const Exchange& exchange) const;
  bool mayBeCut(const Exchange& exchange) const;
  bool mayWear(const Exchange& exchange) const;
  bool insists() const;
  Duration shortest(std::size_t index) const;
  Duration longest(std::size_t index) const;
  Duration pause() const;
  void judgeCut(TimePoint now) const;
  void judgeLatency(TimePoint now);

  const Observed& observed_;
  std::vector<Station> stations_;
  std::vector<std::optional<Due>> due_;
  /// The exchange before, if it ended early.
  std::optional<Exchange> cut_;
  TimePoint heard_at_;
  /// A stop insisted when the exchange in flight was chosen.
  bool insisted_ = false;
  /// A 0 has come since, which a newer velocity may supersede before it can go.
  bool zero_came_ = false;
  std::uint64_t checked_ = 0;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_CUT_WAITS_H

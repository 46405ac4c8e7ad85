// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_REPLY_TIMES_H
#define INVERTER_BUS_BUS_REPLY_TIMES_H

#include <cstddef>
#include <vector>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace bus
{
/// How long one drive takes to begin its replies (contract, 8.4). Pure. Not thread safe; the bus guards it.
class ReplyTimes
{
public:
  ReplyTimes();

  /// A reply began \p time after the last byte of its request, and its first bytes were handed over after \p heard. Not
  /// that to a write that reaches the EEPROM, nor one that was no longer waited for.
  void replied(Duration time, Duration heard);
  /// Nothing came, although the full time was waited for.
  void missed();

  /// Silence after a request's last byte from which on a stop ends the wait. \p own_delay the drive's own (C078, F805),
  /// \p adapter how long an adapter may hold a byte back. Never before the first bytes of a reply have been handed over
  /// when that took longest: what is collected on the way has begun.
  Duration cutAfter(Duration own_delay, Duration adapter) const;
  /// Among its last 256 replies; 0: it was never heard.
  Duration longest() const;
  /// The last exchange was answered.
  bool answers() const;

private:
  /// Rings.
  std::vector<Duration> times_;
  std::vector<Duration> heard_;
  std::size_t next_ = 0;
  Duration longest_{ 0 };
  Duration latest_heard_{ 0 };
  bool answers_ = true;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_REPLY_TIMES_H

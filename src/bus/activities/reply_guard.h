// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_REPLY_GUARD_H
#define INVERTER_BUS_BUS_REPLY_GUARD_H

#include <optional>

#include "bus/activities/bus_state.h"
#include "bus/exchange.h"
#include "bus/line_view.h"

namespace inverter_bus
{
namespace bus
{
/// Rule 3.9: nothing goes that the late reply to an earlier request could answer.
class ReplyGuard
{
public:
  explicit ReplyGuard(BusState& bus);

  /// True: it may go, perhaps as a loop-back before it; false: it waits, and has been put off.
  bool makeSafe(TimePoint now, InFlight& current, const LineView& line);
  /// A read that no late reply can answer; nothing: this drive has none.
  std::optional<wire::Request> spareRead(TimePoint now, const Inverter& inverter, const LineView& line) const;

private:
  bool readBackSafely(TimePoint now, InFlight& current, const LineView& line) const;

  BusState& bus_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_REPLY_GUARD_H

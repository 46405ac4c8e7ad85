// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_LINE_WAITING_H
#define INVERTER_BUS_WIRE_LINE_WAITING_H

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>

#include "inverter_bus/wire/line.h"

namespace inverter_bus
{
namespace wire
{
/// An exchange whose request has been sent.
struct Line::Waiting
{
  Waiting(const Request& asked, const GiveWay& the_give_way) : request(asked), give_way(the_give_way)
  {
  }

  /// From when on a stop ends the wait if nothing more comes; \p last_byte_at the epoch: nothing has come yet.
  TimePoint cutFrom(TimePoint last_byte_at) const
  {
    const TimePoint without_reply = request_end + give_way.silence;
    const TimePoint after_last_byte = last_byte_at + give_way.pause;
    return begun ? after_last_byte : std::max(without_reply, after_last_byte);
  }

  const Request& request;
  const GiveWay& give_way;
  /// What the request is remembered by if it gets lost.
  std::string shape;
  TimePoint sent_at;
  TimePoint request_end;
  /// The first byte must have come by then.
  TimePoint first_byte_deadline;
  /// Everything must have.
  TimePoint last_deadline;
  std::size_t reply_length = 0;
  /// Estimated beginning of the bytes that are in the buffer, once there are any.
  std::optional<TimePoint> first_byte_at;
  /// When the port handed over the first of them.
  TimePoint heard_at;
  /// The awaited reply has begun.
  bool begun = false;
  /// A valid frame came that this node had not asked for.
  bool foreign = false;
  /// No further bytes will come: the beginning of a frame will not become one.
  bool over = false;
  /// A stop has ended the wait.
  bool cut = false;
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_LINE_WAITING_H

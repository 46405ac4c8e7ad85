// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_LINE_WAITING_H
#define INVERTER_BUS_WIRE_LINE_WAITING_H

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
  explicit Waiting(const Request& asked) : request(asked)
  {
  }

  const Request& request;
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
  /// The awaited reply has begun.
  bool begun = false;
  /// A valid frame came that nobody here had asked for.
  bool foreign = false;
  /// No further bytes will come: the beginning of a frame will not become one.
  bool over = false;
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_LINE_WAITING_H

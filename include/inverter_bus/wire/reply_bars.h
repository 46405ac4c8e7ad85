// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_REPLY_BARS_H
#define INVERTER_BUS_WIRE_REPLY_BARS_H

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace wire
{
/// Which requests are still owed a reply, and so must not be repeated yet (contract, rule 3.9).
///
/// A lost request bars its shape for one second. It is remembered somewhat longer, so that an even later reply is
/// counted as late and not as a frame of a second master.
class ReplyBars
{
public:
  /// What is remembered of a lost request.
  struct Lost
  {
    /// When it had left the line.
    TimePoint request_end;
    std::uint64_t ticket = 0;
  };
  /// The request that a late reply belongs to; empty where several lost ones could have got it.
  using Late = std::optional<Lost>;

  /// The request of \p shape got no valid reply.
  void add(const std::string& shape, std::uint8_t station, const Lost& lost, TimePoint now);
  /// End of the bar on \p shape; the clock's epoch if there is none.
  TimePoint barredUntil(const std::string& shape) const;
  /// True if a reply of \p shape (a beginning of shapes for an exception) may be the answer to a lost request.
  bool mayBeLate(const std::string& shape, TimePoint now) const;
  /// True while the bar of any lost request is up: its reply may still come.
  bool owes(TimePoint now) const;
  /// A reply of \p shape came that is not waited for. Lifts the bar of the request that it belongs to; empty if no lost
  /// request could have got it.
  std::optional<Late> take(const std::string& shape, TimePoint now);
  /// Lifts all bars of \p station set for requests before \p time: it has answered something newer since.
  void lift(std::uint8_t station, TimePoint time);
  void clear();

private:
  struct Bar
  {
    std::uint8_t station = 0;
    TimePoint until;
    /// The last one.
    Lost lost;
    /// Lost requests of this shape: a stop may be repeated despite the bar, and each may still be answered.
    std::size_t owed = 0;
  };
  using Bars = std::map<std::string, Bar>;

  void forgetOld(TimePoint now);

  /// Ordered, so that the shapes with a common beginning are neighbours.
  Bars bars_;
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_REPLY_BARS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_LINK_WATCH_H
#define INVERTER_BUS_BUS_LINK_WATCH_H

#include <optional>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace bus
{
/// A link that is up but mute: no drive answers any more, or none ever has since it was opened (contract, 8.10).
/// Reopening it is all that can be done from here: a gateway may have gone deaf on one connection, an adapter may have
/// lost its settings. Pure; bus thread only.
class LinkWatch
{
public:
  /// \p response_timeout the longest one of the bus.
  explicit LinkWatch(Duration response_timeout);

  void opened(TimePoint now);
  /// A drive has answered, or a gateway on behalf of one.
  void answered();
  /// A request that left at \p sent_at was not answered.
  void lost(TimePoint sent_at);

  /// For \p duration until now this node did not ask: that no drive answered meanwhile says nothing about the link.
  void notWatching(Duration duration);

  /// No answer has come for so long that the link, not a station, must be silent.
  bool wasSilent(TimePoint now) const;
  /// Time to reopen the link.
  bool mute(TimePoint now) const;
  /// It is about to be reopened because of that. Returns true if this is to be reported: the first time in a row.
  bool renewing(TimePoint now);
  /// No answer has come since it was reopened for lack of answers.
  bool inVain() const;

private:
  Duration patience_;
  TimePoint opened_at_;
  bool ever_answered_ = false;
  /// When the first request left that was not answered since the last answer, or since it was opened.
  std::optional<TimePoint> silent_since_;
  /// The same, however often it was reopened.
  std::optional<TimePoint> unanswered_since_;
  /// Until the next renewal, while no drive answers.
  Duration period_{ 0 };
  TimePoint renewed_at_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_LINK_WATCH_H

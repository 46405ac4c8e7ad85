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
/// A link that is up but mute: no drive answers any more, or nobody ever has since it was opened (contract, 8.10). Opening it
/// anew is all that can be done from here: a gateway may have gone deaf on one connection, an adapter may have lost its
/// settings. Pure; bus thread only.
class LinkWatch
{
public:
  /// \p response_timeout the longest one of the bus.
  explicit LinkWatch(Duration response_timeout);

  void opened(TimePoint now);
  /// Somebody has answered; a gateway for somebody else, too.
  void answered();
  /// A request that left at \p sent_at was not answered.
  void lost(TimePoint sent_at);

  /// For \p duration until now nobody here has asked: that nobody has answered meanwhile says nothing of the link.
  void notWatching(Duration duration);

  /// Nobody has answered for so long that it is the link, not a station, that is silent.
  bool wasSilent(TimePoint now) const;
  /// Time to open the link anew.
  bool mute(TimePoint now) const;
  /// It is about to be opened anew because of it. Returns true if that is to be said: the first time in a row.
  bool renewing(TimePoint now);
  /// Nobody has answered since it was opened anew because nobody answered.
  bool inVain() const;

private:
  Duration patience_;
  TimePoint opened_at_;
  bool ever_answered_ = false;
  /// When the first request left that was not answered since the last answer, or since it was opened.
  std::optional<TimePoint> silent_since_;
  /// The same, however often it was opened anew.
  std::optional<TimePoint> unanswered_since_;
  /// Until the next renewal, while nobody answers.
  Duration period_{ 0 };
  TimePoint renewed_at_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_LINK_WATCH_H

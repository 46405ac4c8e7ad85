// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_CONNECTION_WATCH_H
#define INVERTER_BUS_BUS_CONNECTION_WATCH_H

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace bus
{
/// Tells an orderly close of a TCP connection from a loss, and when to reconnect (contract, 8.9).
///
/// A gateway ends a connection for many reasons that concern no motor: it was idle, a station did not answer, a repeat of
/// its own failed. Such a connection is opened again at once and the motors run on, as long as that works: within half a
/// second, with a drive answering, and not again and again. Pure; bus thread only.
class ConnectionWatch
{
public:
  enum class Verdict
  {
    /// Open it again at once; nothing is stopped.
    Resume,
    /// The connection is lost: motors are stopped and locked.
    Lost,
    /// The same, because it was closed so often that another client seems to take it.
    TakenByAnother
  };

  // --- what happened --------------------------------------------------------------------------------------------------
  /// It is open. \p online: the inverters that were online, in node order; each is read once before any write.
  void opened(TimePoint now, const std::vector<std::size_t>& online);
  /// \p inverter has answered over it (with whatever).
  void answered(TimePoint now, std::size_t inverter);
  /// A request to \p inverter over it got no answer in time.
  void unanswered(std::size_t inverter);
  /// The peer has closed it, in place of the answer of \p inverter or between two exchanges.
  Verdict closed(TimePoint now, std::optional<std::size_t> inverter);
  /// It could not be opened (yet).
  Verdict notOpen(TimePoint now);
  /// It is closed from here, to be opened again at once.
  void reopening(TimePoint now);
  /// It is lost for any other reason, or closed on purpose.
  void lost();
  /// It was closed for a reason that the next one will have too (telnet mode): not more often than once in two seconds.
  void slowDown();

  // --- what follows ---------------------------------------------------------------------------------------------------
  /// Between an orderly close and the next open connection.
  bool resuming() const;
  /// Several connections in a row were closed in place of its answers, and no drive has answered in between.
  bool closedAgain(std::size_t inverter) const;
  /// The next inverter to be read before any write; nothing: all have been.
  std::optional<std::size_t> toRead() const;
  /// Every inverter that was online was asked after the reopening, and none answered.
  bool nobodyAnswered() const;
  /// Not before this time is the next connection to be tried.
  TimePoint openNotBefore() const;
  /// Connections in a row that were closed before any drive answered over them.
  unsigned closedUnused() const;

private:
  struct QuickClose
  {
    TimePoint at;
    std::optional<std::size_t> inverter;
    /// That inverter has answered since.
    bool answers = false;
  };
  bool closedTooOften(TimePoint now) const;
  bool isTried(std::size_t inverter) const;

  /// In the order of asking: the one under way at the close goes last.
  std::deque<std::size_t> unread_;
  bool checking_ = false;
  bool anybody_ = false;
  std::optional<TimePoint> resuming_since_;
  /// Inverters in place of whose answers the connection was closed since any drive answered.
  std::vector<std::size_t> tried_;
  std::optional<TimePoint> last_good_;
  std::deque<QuickClose> quick_closes_;
  TimePoint opened_at_;
  TimePoint not_before_;
  unsigned closed_unused_ = 0;
  /// Closed again and again: connections keep a distance until one has lasted.
  bool troubled_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_CONNECTION_WATCH_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_LIVENESS_H
#define INVERTER_BUS_BUS_LIVENESS_H

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace bus
{
/// Whether an inverter is alive: alive means data (contract, 8.15). Too many failures in a row, or no complete status for
/// too long, make it offline; a drive that answers without reporting its status (a loop-back, an acknowledged write, a
/// late reply) is not shown as alive for that. Pure: time comes in as an argument. Not thread safe.
class Liveness
{
public:
  /// \p offline_after failures in a row (bus parameter `offline_after`). \p shortest_silence the same in time, where
  /// replies were not waited for in full.
  explicit Liveness(int offline_after, Duration shortest_silence = Duration{ 0 });

  // --- failures in a row ----------------------------------------------------------------------------------------------
  /// An exchange was lost, after its repeats; true: so many in a row that the inverter is offline. Lost \p write of command
  /// words alone don't make it so (contract, 8.1): a read must be among them.
  bool lost(bool write);
  /// One of them that was sent at \p sent_at has not had its full time (contract, 8.4).
  void waitedBriefly(TimePoint sent_at);
  /// The row has become long through short waits: this is not yet a silence for which an inverter goes offline.
  bool tooSoon(TimePoint now) const;
  /// A read of the run words was answered by an exception; counts like a lost exchange.
  bool refused();
  /// A read brought data of the status: the row is over.
  void dataRead();
  /// Only writes were lost, but so many that a read must show whether the drive is away.
  bool needsRead() const;

  // --- the age of the status ------------------------------------------------------------------------------------------
  /// The watch begins at this time: nothing that came before was to be expected (start-up).
  void watchFrom(TimePoint time);
  /// Until then no status is expected, and a lost exchange is none until the drive is heard (a reset's deaf time).
  void deafUntil(TimePoint time);
  /// The drive has answered: if it is deaf, then from the next frame on.
  void heard();
  /// It is expected to be deaf, and has not been heard meanwhile.
  bool mayBeDeaf(TimePoint now) const;
  /// Until \p now this node itself did not run, for \p duration: no status was asked for, so none was to be expected.
  void notWatching(TimePoint now, Duration duration);
  void complete(TimePoint now);
  /// An exchange that is no read of a refresh was lost; see noteRead() for those.
  void missed(std::uint16_t error_id);
  /// No complete status for `max(2 s, 3 refresh periods)`, although it was asked more than once and did not report it: an
  /// inverter that was not asked, because others took the time, is not to blame, nor is one that lost one exchange and
  /// was not asked since. \p period is the longest time between two refreshes of this inverter as the configuration has
  /// it, with what a gateway adds.
  bool overdue(TimePoint now, Duration period) const;

  // --- what has become of its reads -----------------------------------------------------------------------------------
  /// Each read of a refresh. \p length distinguishes a long reply from a short one: its cost on the line.
  void noteRead(Duration length, const wire::Reply& reply);
  /// Why no status comes, in words, from the reads since the last complete one: "answers exception 02 to the status",
  /// "damaged long replies: 221 of 369", "no long replies: 4 of 9"; empty: nothing to say beyond that no reply came.
  std::string reason() const;
  /// Since the last complete status the drive has answered every read, and refuses for the moment (Modbus exceptions
  /// above 03: busy, locked, running).
  bool refusesForTheMoment() const;
  /// Error id of the last exchange that failed since the last complete status; 0: none has.
  std::uint16_t lastError() const;

private:
  struct Reads
  {
    unsigned asked = 0;
    unsigned lost = 0;
    unsigned damaged = 0;
    unsigned refused = 0;
  };
  /// Failures in a row.
  struct Row
  {
    int failures = 0;
    bool read_failed = false;
    /// When the first request left whose reply was not waited for in full.
    std::optional<TimePoint> brief_since;
  };
  Reads since(Duration length) const;

  int offline_after_;
  Duration shortest_silence_;
  Row row_;

  TimePoint since_;
  TimePoint deaf_until_;
  /// The same until the drive is heard.
  TimePoint silent_until_;

  /// By length, since the last complete status.
  std::map<Duration, Reads> reads_;
  std::uint16_t last_error_ = 0;
  std::uint16_t refusal_ = 0;
  /// Exchanges that brought nothing.
  unsigned misses_ = 0;
  /// A read was answered after one that was not: the drive is there.
  bool answers_some_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_LIVENESS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_SLOW_TURNS_H
#define INVERTER_BUS_BUS_SLOW_TURNS_H

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "bus/inverter/status_reads.h"

namespace inverter_bus
{
namespace bus
{
/// What the bus allows the slow reads of one refresh (contract, 8.3).
struct SlowLeave
{
  /// A read that takes from the share may go.
  bool open = true;
  /// Age at which it may be read again; 0: they are never read.
  Duration period = std::chrono::seconds(1);
};

/// Which slow reads go with a refresh: what reveals a leftover RUN or a restart of the drive goes first, after a
/// return or a lost exchange (contract, 4.1); else at most one of these that is due, and one that the share of the slow
/// values allows (contract, 8.3). Pure. Not thread safe; the bus guards it.
class SlowTurns
{
public:
  /// Whether this node's RUN is still in force is read before any other slow value.
  void askForRun();
  /// The drive may have been switched off and on: whether it was is read before any other slow value.
  void suspectRestart();
  /// \p words came with a read; what they show no longer has to go first.
  void noteRestart(const drive::Monitor& words);
  /// They are all that a refresh has brought; \p tells_run: the drive can report whether a RUN of the bus is on.
  void noteRun(const drive::Monitor& words, bool tells_run);
  /// A warning or a trip has come or gone: the drive's warning word is the next slow value to be read.
  void askForWarning();
  /// The current read has brought it, or was to.
  void noteWarning(const StatusRead& read);
  /// It is waited for, and \p reads has it.
  bool asksForWarning(const StatusReads& reads, TimePoint now) const;
  /// Nothing that was read counts any more.
  void forget();
  /// The reads have changed.
  void restart();

  /// Those for a refresh that begins at \p now; \p first: it is the first one, which is to be short.
  std::vector<std::size_t> take(const StatusReads& reads, TimePoint now, bool first, const SlowLeave& leave);
  /// The refresh waits for \p read: the first word of a leftover RUN is in it.
  bool waitedFor(const StatusRead& read) const;

private:
  bool goesFirst(const StatusRead& read) const;
  std::optional<std::size_t> takeSlowed(const StatusReads& reads, TimePoint now, const SlowLeave& leave);
  std::optional<std::size_t> takeGuard(const StatusReads& reads, TimePoint now);

  /// Where the search for one that is due begins: of those that are slowed, and of those that never are.
  std::size_t cursor_ = 0;
  std::size_t guard_cursor_ = 0;
  /// The slow words that decide over safety have come since the last return.
  bool run_heard_ = false;
  /// An exchange got lost since the marker of a restart was read.
  bool restart_suspected_ = false;
  bool warning_asked_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_SLOW_TURNS_H

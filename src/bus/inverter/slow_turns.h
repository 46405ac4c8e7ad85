// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_SLOW_TURNS_H
#define INVERTER_BUS_BUS_SLOW_TURNS_H

#include <cstddef>
#include <vector>

#include "bus/inverter/status_reads.h"

namespace inverter_bus
{
namespace bus
{
/// Which slow reads go with a refresh: what a leftover RUN or a restart of the drive can be told from goes first, after a
/// return or a lost exchange (contract, 4.1); else at most one that is due. Pure. Not thread safe; the bus guards it.
class SlowTurns
{
public:
  /// Whether our RUN is still in force is read before any other slow value.
  void askForRun();
  /// The drive may have been switched off and on: whether it was is read before any other slow value.
  void suspectRestart();
  /// \p words came with a read; what they tell need not go first any more.
  void noteRestart(const drive::Monitor& words);
  /// They are all that a refresh has brought; \p tells_run: the drive can tell whether a RUN of the bus is on.
  void noteRun(const drive::Monitor& words, bool tells_run);
  /// Nothing that was read counts any more.
  void forget();
  /// The reads are others now.
  void restart();

  /// Those for a refresh that begins at \p now; \p first: it is the first one, which is to be short.
  std::vector<std::size_t> take(const StatusReads& reads, TimePoint now, bool first);
  /// The refresh waits for \p read: the first word of a leftover RUN is in it.
  bool waitedFor(const StatusRead& read) const;

private:
  bool goesFirst(const StatusRead& read) const;

  /// Where the search for one that is due begins.
  std::size_t cursor_ = 0;
  /// The slow words that decide over safety have come since the last return.
  bool run_heard_ = false;
  /// An exchange got lost since the marker of a restart was read.
  bool restart_suspected_ = false;
};

/// How old a slow value may be where it is shown (contract, section 2).
constexpr double OLDEST_SLOW_VALUE_S = 1.0;
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_SLOW_TURNS_H

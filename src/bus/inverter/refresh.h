// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_REFRESH_H
#define INVERTER_BUS_BUS_REFRESH_H

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "bus/inverter/chosen_block.h"
#include "bus/inverter/mapped_reads.h"
#include "bus/inverter/slow_turns.h"
#include "bus/inverter/status_draft.h"
#include "bus/inverter/status_reads.h"

namespace inverter_bus
{
namespace bus
{
/// The status refresh of one inverter: which read is next, and what the drive has reported so far, with the time of each
/// word.
///
/// Each refresh reads all fast blocks, the fault blocks while the drive is tripped, and the slow block whose turn it is.
/// Values belong to the stamp only if they came in one refresh; slow ones have an age of their own (contract, section 2 and
/// 8.3).
class Refresh
{
public:
  /// \p drive must outlive it.
  explicit Refresh(const drive::Drive& drive);

  /// Percent of these become A and V; without them such values stay empty.
  void setRatings(const drive::Ratings& ratings);
  /// Reads the words that the user chose in one exchange, and beside it only what that read doesn't bring; empty: direct
  /// reads. A refresh under way starts again if this changes anything.
  void useBlock(const std::optional<drive::ReadBlock>& block);
  const ChosenBlock& chosen() const;
  ChosenBlock& chosen();

  /// Asks for what the next refresh does with the drive's register map; not while one is under way.
  void useMap(const std::function<MapOrders()>& orders);
  MappedReads& mapped();

  /// The read that is due; starts a new refresh when none is under way, with what \p leave allows of slow values.
  const drive::ReadBlock& next(TimePoint now, const SlowLeave& leave = SlowLeave());
  /// That read, until its end is reported.
  const StatusRead& asked() const;

  /// The drive has just refused a read of its run words that can't be made in another form; true once.
  bool takeRefusal();

  /// The answer to next(). Returns true when the refresh needs another exchange.
  bool received(const wire::Reply& reply);
  /// The drive refused the read (exception): a block of several values is split, a single value is left out for a while.
  bool refused(const wire::Reply& reply);
  /// The read failed after its repeats: this refresh ends without a result.
  void failed();

  /// True after the last read of a refresh, once.
  bool takeComplete();
  /// Everything that may be shown at \p now.
  drive::Monitor monitor(TimePoint now) const;
  /// The run words of the last complete refresh and when their request left.
  const StatusWords& fresh() const;
  /// The refresh under way: what has come so far.
  StatusDraft& draft();
  /// Leaves the read at hand out for a while if it is one of the slow values; false: it is not, or nothing follows it.
  bool skipSlow();
  /// The drive's warning word is the next slow value to be read, on this bus.
  bool asksForWarning(TimePoint now) const;
  /// What goes before all other slow values.
  SlowTurns& slow();
  /// Of the last complete refresh; empty: none since the program began.
  const std::optional<TimePoint>& stamp() const;
  /// Nothing that was read counts any longer (inverter offline).
  void forget();
  /// All of one refresh, for costs.
  const StatusReads& reads() const;

private:
  void plan(TimePoint now, const SlowLeave& leave);
  bool advance();
  bool postpone();

  const drive::Drive& drive_;
  StatusReads reads_;
  SlowTurns slow_;
  ChosenBlock chosen_;
  MappedReads mapped_;
  StatusDraft draft_;
  /// The reads of the refresh under way, those that are left at the end; empty: none is under way.
  std::vector<std::size_t> plan_;
  TimePoint asked_at_;
  /// Of the last complete refresh.
  struct Status
  {
    StatusWords words;
    std::optional<TimePoint> stamp;
  };
  Status last_;
  drive::Ratings ratings_;
  bool run_refused_ = false;
  bool complete_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_REFRESH_H

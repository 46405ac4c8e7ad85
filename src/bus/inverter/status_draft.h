// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_STATUS_DRAFT_H
#define INVERTER_BUS_BUS_STATUS_DRAFT_H

#include <optional>

#include "bus/inverter/status_reads.h"

namespace inverter_bus
{
namespace bus
{
/// What a refresh has brought, with the time to which its run words belong.
struct StatusWords
{
  drive::Monitor monitor;
  /// When the oldest request left for a word that shows whether the motor runs.
  TimePoint sent_at;
};

/// The status that a refresh under way is about to make. Pure. Not thread safe; the bus guards it.
class StatusDraft
{
public:
  /// A refresh begins.
  void restart();
  /// \p reply brought \p read, whose values are decoded.
  void take(const StatusRead& read, const wire::Reply& reply);
  /// A read without values was answered at \p at: the drive is there.
  void heard(TimePoint at);
  /// The marker of a restart that was just read is dealt with: the rest of this refresh must not find it once more, after
  /// the drive has been sent what it had forgotten.
  void restartNoted();
  /// The reason of a trip is still to be read: it belongs in the first status that shows the trip. True once.
  bool takeFaultDue();

  /// An exchange with this drive was lost meanwhile.
  void lost();
  /// So much time was lost between its reads that the first words don't belong to the stamp any more (contract, section 2): all
  /// are to be read again. Not twice in a row, for on the slowest lines that is how long it takes.
  bool takeTooOld();

  /// What has come so far.
  const StatusWords& words() const;
  /// Enough has come for a status; \p run_needed: one of the reads shows whether the motor runs.
  bool suffices(bool run_needed) const;
  /// Arrival of the last fast reply; empty: none yet.
  const std::optional<TimePoint>& stamp() const;

private:
  StatusWords words_;
  std::optional<TimePoint> stamp_;
  /// A run word was read.
  bool run_read_ = false;
  bool fault_asked_ = false;
  bool lost_ = false;
  bool read_again_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_STATUS_DRAFT_H

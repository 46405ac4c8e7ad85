// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_RUN_EVIDENCE_H
#define INVERTER_BUS_BUS_RUN_EVIDENCE_H

#include <optional>

#include "bus/inverter/movement.h"
#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// What the drive's marker of a restart means for a RUN from this node.
enum class Restart
{
  None,
  /// It may have restarted before it got the RUN that is in force. If that is gone, the next read of it shows it.
  PerhapsBeforeRun,
  Restarted
};

/// What shows that this node's RUN is in force (contract, 4.1): confirmed words may be repeated only while the last
/// exchange did, since a drive that was switched off and on meanwhile would start by them. Pure: time and the movement
/// come in as arguments. Not thread safe; the bus guards it.
class RunEvidence
{
public:
  /// \p drive must outlive it.
  explicit RunEvidence(const drive::Drive& drive);

  /// An exchange with the drive has ended: what the one before it showed no longer counts, and a lost or refused one
  /// invalidates all that was proven.
  void exchangeEnded(wire::Outcome outcome);
  /// \p reply answered a read of the status; \p words is what the refresh has brought so far.
  void statusRead(const drive::Monitor& words, const wire::Reply& reply, const Movement& movement);
  /// The marker of a restart was read by a request that left at \p sent_at. With \p stop_pending no RUN is to go on.
  Restart restartRead(bool restarted, TimePoint sent_at, const Movement& movement, bool stop_pending);
  /// Nothing that was read of the drive counts any longer.
  void forget();

  /// The last exchange has shown that the motor follows this node's RUN, so recently that the drive can't have lost it
  /// since.
  bool shows(TimePoint now, const Movement& movement) const;
  /// What commands the drive is to be read again, since a panel or a terminal may take it over at any time. True once in
  /// 5 s while a RUN from this node is in force, or once in \p period where that is longer (contract, 8.3).
  bool takeSourceDue(TimePoint now, const Movement& movement, Duration period);

private:
  bool followsTarget(const drive::Monitor& words, const Movement& movement);

  const drive::Drive& drive_;
  std::optional<TimePoint> shown_at_;
  /// The drive's own copy of the RUN command was read as on since the last lost exchange.
  bool proven_ = false;
  /// By then the drive had not restarted.
  TimePoint no_restart_until_;
  double last_shown_hz_ = 0.0;
  TimePoint source_asked_at_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_RUN_EVIDENCE_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_EXCHANGE_H
#define INVERTER_BUS_BUS_EXCHANGE_H

#include <cstddef>

#include "bus/inverter/movement.h"
#include "bus/rules/scheduler.h"
#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace bus
{
/// The exchange in flight, as the activity that composed it wants it.
struct InFlight
{
  Pick pick;
  std::size_t inverter = 0;
  wire::Request request;
  /// Time that it occupies the line if it is answered at once.
  Duration cost{ 0 };
  /// The same if it is not answered, with the full time-out.
  Duration full_wait{ 0 };
  /// A loop-back that makes sure that no late reply is on its way; the real request follows.
  bool resync = false;
  /// The request is a loop-back, as a probe or for resync.
  bool loopback = false;
  /// A stop's write that a late reply to an earlier request could answer.
  bool may_be_late = false;
  /// Takes from the share of the slow values (contract, 8.3).
  bool slow = false;
  /// A write that also reads the status (17H).
  bool with_status = false;
  /// Repeats command words that the drive has confirmed, and is no read.
  bool keeps_alive = false;
  /// A velocity's frame that may set RUN or raise the frequency.
  bool moves = false;
  /// It may set RUN: a stop of the same inverter waits for its reply (contract, 8.4).
  bool may_start = false;
  /// It reaches the drive's EEPROM, or resets it: it is waited for in any case (contract, 8.4).
  bool lasting = false;
  /// Its reply is not waited for in full.
  bool brief = false;
  /// When it was decided that it goes.
  TimePoint chosen_at;
  Write write;
};

/// The exchange of a pick; what is to be sent is still missing.
inline InFlight exchangeFor(const Pick& pick)
{
  InFlight current;
  current.pick = pick;
  current.inverter = pick.inverter;
  return current;
}

/// What the end of an exchange says about its inverter beyond the activity's own concern; Absences draws the conclusion.
enum class Ending
{
  /// Nothing: it was answered, or its loss is no news.
  Nothing,
  Lost,
  LostWrite,
  /// Counts among the writes that were lost in a row.
  LostStopWrite,
  /// Answered, but by a refusal: an offline inverter has shown no status after all.
  Refused
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_EXCHANGE_H

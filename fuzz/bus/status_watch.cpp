// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/status_watch.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
constexpr double PROBES_AT_FIRST = 3.0;

bool isTripped(const bus::InverterStatus& status)
{
  return status.monitor.faulted.value_or(false) || status.monitor.unknown_trip;
}
}  // namespace

StatusWatch::StatusWatch(Checks& checks) : checks_(checks)
{
}

void StatusWatch::published(TimePoint now, const bus::InverterStatus& status)
{
  ++statuses_;
  const std::size_t index = status.index;
  const InverterRecord& inverter = checks_.observed.inverters[index];
  const bool was_tripped = inverter.told.any && isTripped(inverter.told.status);
  if (status.communication_error)
  {
    takeOffline(now, index);
  }
  else if (status.has_stamp)
  {
    takeStatus(now, status);
  }
  if (isTripped(status) && !was_tripped)
  {
    takeTrip(now, index);
  }
  if (status.locked && inverter.order.valid)
  {
    takeLock(now, index);
  }
  checks_.told_locks.told(now, index, status.locked);
  checks_.liveness.published(status);
  checks_.locks.tryOpen(now, index);
  checks_.recorder.published(status);
}

void StatusWatch::takeOffline(TimePoint now, std::size_t index)
{
  const Told& told = checks_.observed.inverters[index].told;
  if (told.online)
  {
    checks_.liveness.checkWentOffline(now, index);
  }
  if (told.online || !told.any)
  {
    checks_.probes.allow(PROBES_AT_FIRST);
    checks_.lockUp(now, index, false);
  }
  checks_.locks.wentOffline(index);
  checks_.lowest_class.wentOffline(index);
  checks_.slow_reads.wentOffline(index);
  checks_.stops.drop(index);
  checks_.zeros.drop(index);
  checks_.recorder.wentOffline(index);
}

void StatusWatch::takeStatus(TimePoint now, const bus::InverterStatus& status)
{
  checks_.values.check(now, status);
  checks_.trips.check(now, status);
  if (!checks_.observed.inverters[status.index].told.online)
  {
    checks_.supervision.cameOnline(now, status.index);
  }
  checks_.locks.hasStatus(status.index, isTripped(status));
  checks_.recorder.isOnline(status);
}

void StatusWatch::takeTrip(TimePoint now, std::size_t index)
{
  // The first of its reads may have shown the trip long before the last one.
  const Told& told = checks_.observed.inverters[index].told;
  const TimePoint since = told.any ? told.status.stamp : now;
  checks_.lockUp(now, index, false);
  checks_.locks.tripped(index, since);
  checks_.recorder.stopRequested(index);
}

/// The drive did something by itself, and the node has noticed.
void StatusWatch::takeLock(TimePoint now, std::size_t index)
{
  // It may have stopped long ago what had never started.
  const TimePoint accepted_at = checks_.observed.inverters[index].order.accepted_at;
  checks_.lockUp(now, index, false);
  checks_.locks.backdate(index, accepted_at);
}

void StatusWatch::logged(TimePoint now, const std::string& line) const
{
  checks_.refusals.check(now, line);
}

std::uint64_t StatusWatch::statuses() const
{
  return statuses_;
}
}  // namespace fuzz
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/trips.h"

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
namespace
{
// Of these statuses the second one was asked for in whole after the trip.
constexpr unsigned STATUSES_UNTIL_KNOWN = 2;
}  // namespace

Trips::Trips(const Observed& observed, const Plant& plant)
  : observed_(observed), plant_(plant), statuses_(observed.inverters.size(), 0)
{
}

void Trips::glance(std::size_t index)
{
  statuses_[index] = isUnlisted(index) ? statuses_[index] : 0;
}

/// The drive reports its trip in a word that its profile does not know.
bool Trips::isUnlisted(std::size_t index) const
{
  const InverterFacts& facts = observed_.scene.inverters[index];
  if (facts.drive == "omron_rx")
  {
    return plant_.flag(index, "tripped") && plant_.value(index, "status_b") != "2";
  }
  return !facts.listed_trips.empty() && plant_.flag(index, "tripped") &&
         facts.listed_trips.count(std::stoi(plant_.value(index, "trip"))) == 0;
}

void Trips::check(TimePoint now, const bus::InverterStatus& status)
{
  const std::size_t index = status.index;
  if (!isUnlisted(index))
  {
    statuses_[index] = 0;
    return;
  }
  const Told& told = observed_.inverters[index].told;
  const bool whole = !told.any || told.status.stamp != status.stamp;
  statuses_[index] += whole && !status.communication_error ? 1 : 0;
  if (statuses_[index] < STATUSES_UNTIL_KNOWN)
  {
    return;
  }
  const std::string name = observed_.scene.title(index);
  if (!status.locked)
  {
    fail(now, "a trip that no table lists is a trip", name + " is not locked");
  }
  if (plant_.runLatched(index) && !status.stop_active)
  {
    fail(now, "a trip that no table lists is a trip", name + " still has RUN on");
  }
  if (status.monitor.faulted)
  {
    fail(now, "a trip that no table lists is a trip", name + ": it is unknown whether it is tripped");
  }
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

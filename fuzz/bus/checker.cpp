// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checker.h"

#include <utility>

namespace inverter_bus
{
namespace fuzz
{
Checker::Checker(const Scene& scene, simulation::SimulatedBus& bus, const util::Clock& clock,
                 std::function<bool(std::size_t)> budget_warns)
  : checks_(scene, bus, clock, std::move(budget_warns)), line_(checks_), users_(checks_), statuses_(checks_)
{
}

LineWatch& Checker::line()
{
  return line_;
}

UserWatch& Checker::users()
{
  return users_;
}

StatusWatch& Checker::statuses()
{
  return statuses_;
}

checks::Services& Checker::services()
{
  return checks_.services;
}

void Checker::glance(TimePoint now)
{
  for (std::size_t index = 0; index < checks_.observed.inverters.size(); ++index)
  {
    checks_.values.glance(now, index);
    checks_.trips.glance(index);
  }
}

void Checker::disturbed(TimePoint now)
{
  checks_.recorder.disturbed(now);
}

void Checker::lostPower(TimePoint now, std::size_t index)
{
  checks_.run_frames.lostPower(now, index);
  checks_.recorder.lostPower(now, index);
}

const Observed& Checker::observed() const
{
  return checks_.observed;
}

const Plant& Checker::plant() const
{
  return checks_.plant;
}

std::size_t Checker::openCalls() const
{
  return checks_.services.open();
}

Statistics Checker::statistics() const
{
  Statistics sum;
  sum.exchanges = checks_.observed.exchange.number;
  sum.commands = checks_.commands.checked();
  sum.accepted = checks_.locks.checked();
  sum.runs = checks_.run_frames.checked();
  sum.stops = checks_.stops.checked();
  sum.services = checks_.services.total();
  sum.statuses = statuses_.statuses();
  sum.values = checks_.values.compared();
  sum.worst_stop = checks_.stops.worst();
  return sum;
}
}  // namespace fuzz
}  // namespace inverter_bus

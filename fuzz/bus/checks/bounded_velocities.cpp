// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/bounded_velocities.h"

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
BoundedVelocities::BoundedVelocities(const Observed& observed)
  : observed_(observed), lost_(observed.inverters.size(), 0)
{
}

void BoundedVelocities::check(TimePoint now)
{
  wanted_off_ = false;
  const RequestFacts& facts = observed_.exchange.facts;
  if (!facts.inverter || !facts.commands() || facts.stop || observed_.shutting_down)
  {
    return;
  }
  const std::size_t index = *facts.inverter;
  const Words& words = observed_.inverters[index].words;
  if ((words.run_answered || words.run_sent) && lost_[index] > observed_.scene.retries)
  {
    fail(now, "a velocity is bounded whatever follows it",
         observed_.scene.title(index) + " is sent one more velocity after " + std::to_string(lost_[index]) +
             " lost frames");
  }
}

void BoundedVelocities::answered(std::size_t index)
{
  lost_[index] = observed_.exchange.facts.commands() ? 0 : lost_[index];
}

void BoundedVelocities::wantedOff()
{
  wanted_off_ = true;
}

void BoundedVelocities::ended(TimePoint now)
{
  const Exchange& exchange = observed_.exchange;
  const RequestFacts& facts = exchange.facts;
  // Words that a refresh repeats are no velocity's.
  if (!facts.inverter || exchange.answered || !facts.commands() || facts.stop || facts.with_read)
  {
    return;
  }
  // Nor is one a try that a stop has cut (8.4), also in the time that the drive's own delay adds to the time-out.
  const Duration full = observed_.scene.inverters[*facts.inverter].fullWait();
  const bool cut = exchange.cut || (wanted_off_ && now - exchange.request_end < full);
  lost_[*facts.inverter] += cut ? 0 : 1;
}

void BoundedVelocities::forbidden(std::size_t index)
{
  lost_[index] = 0;
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

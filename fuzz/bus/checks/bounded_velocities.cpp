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

void BoundedVelocities::check(TimePoint now) const
{
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

void BoundedVelocities::ended()
{
  const RequestFacts& facts = observed_.exchange.facts;
  // Words that a refresh repeats are no velocity's.
  // Nor is one a try that a stop has cut.
  if (facts.inverter && !observed_.exchange.answered && !observed_.exchange.cut && facts.commands() && !facts.stop &&
      !facts.with_read)
  {
    ++lost_[*facts.inverter];
  }
}

void BoundedVelocities::forbidden(std::size_t index)
{
  lost_[index] = 0;
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

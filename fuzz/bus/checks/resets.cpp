// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/resets.h"

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
Resets::Resets(const Observed& observed, const Plant& plant) : observed_(observed), plant_(plant)
{
}

void Resets::check(TimePoint now) const
{
  const RequestFacts& facts = observed_.exchange.facts;
  if (facts.inverter && facts.reset && plant_.runLatched(*facts.inverter))
  {
    fail(now, "reset sends nothing unless RUN is off",
         observed_.scene.title(*facts.inverter) + " is reset with RUN on");
  }
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

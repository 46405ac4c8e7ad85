// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/refusals.h"

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
Refusals::Refusals(const Observed& observed) : observed_(observed), refused_at_(observed.inverters.size())
{
}

void Refusals::refused(TimePoint now, std::size_t index)
{
  refused_at_[index] = refused_at_[index] ? refused_at_[index] : now;
}

void Refusals::forget(std::size_t index)
{
  refused_at_[index].reset();
}

void Refusals::check(TimePoint now, const std::string& line) const
{
  for (std::size_t index = 0; index < refused_at_.size(); ++index)
  {
    const InverterFacts& facts = observed_.scene.inverters[index];
    const std::string silence = facts.name + ": stopping: no command for";
    const TimePoint accepted_at = observed_.inverters[index].order.accepted_at;
    if (line.compare(0, silence.size(), silence) == 0 && refused_at_[index] &&
        *refused_at_[index] < accepted_at + seconds(facts.command_timeout))
    {
      fail(now, "refusals are reported",
           observed_.scene.title(index) + ": the log says that no command came, but they were refused");
    }
  }
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

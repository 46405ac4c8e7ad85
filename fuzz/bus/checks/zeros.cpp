// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/zeros.h"

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
namespace
{
constexpr double EXCHANGES = 8.0;
constexpr double EXCHANGES_EACH = 3.0;
}  // namespace

Zeros::Zeros(const Observed& observed) : observed_(observed), due_(observed.inverters.size())
{
}

void Zeros::commanded(TimePoint now, std::size_t index)
{
  const InverterRecord& inverter = observed_.inverters[index];
  if (inverter.words.run_answered && !inverter.stop.active && observed_.online(index) && !due_[index])
  {
    due_[index] = now;
  }
}

void Zeros::drop(std::size_t index)
{
  due_[index].reset();
}

void Zeros::dropAll()
{
  for (std::optional<TimePoint>& due : due_)
  {
    due.reset();
  }
}

void Zeros::sent()
{
  const RequestFacts& facts = observed_.exchange.facts;
  if (facts.inverter && facts.stop)
  {
    due_[*facts.inverter].reset();
  }
}

void Zeros::checkOverdue(TimePoint now, std::size_t index) const
{
  const double exchanges = EXCHANGES + EXCHANGES_EACH * static_cast<double>(due_.size());
  const Duration bound = seconds(exchanges * toSeconds(observed_.longestWait(now)));
  if (due_[index] && observed_.online(index) && now - *due_[index] > bound)
  {
    fail(now, "a command of 0 takes RUN off",
         observed_.scene.title(index) + " has got no stop since " + decimal(toSeconds(now - *due_[index])) + " s");
  }
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

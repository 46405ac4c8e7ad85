// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/set_points.h"

#include <cmath>

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
SetPoints::SetPoints(const Observed& observed) : observed_(observed)
{
}

void SetPoints::check(TimePoint now) const
{
  const RequestFacts& facts = observed_.exchange.facts;
  if (!facts.set_hertz || !facts.inverter)
  {
    return;
  }
  const std::size_t index = *facts.inverter;
  const Order& order = observed_.inverters[index].order;
  if (!order.valid && now != order.ended_at && !observed_.decidedBefore(now, order.ended_at))
  {
    fail(now, "a cancelled velocity is not sent", observed_.scene.title(index));
  }
  checkNewest(now, index);
  checkOnce(now, index);
}

void SetPoints::checkNewest(TimePoint now, std::size_t index) const
{
  const Exchange& exchange = observed_.exchange;
  const Order& order = observed_.inverters[index].order;
  const double resolution = observed_.scene.inverters[index].brand == Brand::JE ? 0.051 : 0.0051;
  const double wanted = std::fabs(order.hertz);
  const bool newest = std::fabs(*exchange.facts.set_hertz - wanted) <= resolution;
  if (order.valid && !newest && !exchange.precedes_command)
  {
    fail(now, "the newest velocity wins",
         observed_.scene.title(index) + " is sent " + decimal(*exchange.facts.set_hertz) + " Hz instead of " +
             decimal(wanted) + " Hz");
  }
}

void SetPoints::checkOnce(TimePoint now, std::size_t index) const
{
  const Exchange& exchange = observed_.exchange;
  const Words& words = observed_.inverters[index].words;
  if (exchange.facts.run && words.shown)
  {
    // Words in force, repeated with a refresh.
    return;
  }
  if (words.settled)
  {
    fail(now, "no velocity is queued twice", observed_.scene.title(index) + " has confirmed it already");
  }
  const int copies = exchange.facts.run ? words.run_set_copies : words.set_copies;
  if (!exchange.precedes_command && copies > observed_.scene.retries)
  {
    fail(now, "no velocity is queued twice",
         observed_.scene.title(index) + ": more copies of a set-point than retries");
  }
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

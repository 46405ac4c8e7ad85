// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/supervision.h"

#include <algorithm>
#include <utility>

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
namespace
{
constexpr double MEMORY_S = 10.0;
constexpr double BEFORE_S = 0.5;  // what happened shortly before may still delay others
}  // namespace

Supervision::Supervision(const Observed& observed, std::function<bool(std::size_t)> budget_warns)
  : observed_(observed), budget_warns_(std::move(budget_warns)), online_since_(observed.inverters.size())
{
}

void Supervision::cameOnline(TimePoint now, std::size_t index)
{
  online_since_[index] = now;
}

void Supervision::ended(TimePoint now)
{
  const Exchange& exchange = observed_.exchange;
  if (!exchange.facts.inverter)
  {
    return;
  }
  if (exchange.facts.expects_reply && !exchange.answered)
  {
    unanswered_.push_back(now);
  }
  while (!unanswered_.empty() && now - unanswered_.front() > seconds(MEMORY_S))
  {
    unanswered_.pop_front();
  }
}

void Supervision::check(TimePoint now, std::size_t index) const
{
  const InverterRecord& inverter = observed_.inverters[index];
  const double timeout = observed_.scene.inverters[index].drive_timeout;
  const std::optional<TimePoint>& before = inverter.link.last_heard;
  if (!before || timeout == 0.0 || now - *before <= seconds(timeout) || !inverter.link.timeout_known ||
      !inverter.told.online)
  {
    return;
  }
  if (isCalm(*before - seconds(BEFORE_S), index) && !observed_.shutting_down && inverter.told.status.run_command &&
      !budget_warns_(index))
  {
    fail(now, "a running drive is served within its own communication time-out",
         observed_.scene.title(index) + " heard nothing for " + decimal(toSeconds(now - *before)) +
             " s, its time-out is " + decimal(timeout) + " s");
  }
}

/// Nothing has happened since then that could excuse it.
bool Supervision::isCalm(TimePoint from, std::size_t index) const
{
  const auto lost = std::count_if(unanswered_.begin(), unanswered_.end(), [&](TimePoint time) { return time >= from; });
  return observed_.disturbed_at < from && observed_.connected_since < from && online_since_[index] < from && lost <= 1;
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/rules/probe_account.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
struct Patience
{
  std::chrono::milliseconds in_all;
  std::chrono::milliseconds beyond_delay;
};
constexpr Patience HEARD{ std::chrono::milliseconds(12), std::chrono::milliseconds(5) };
// An adapter may hold the reply back, and nobody knows.
constexpr Patience UNHEARD{ std::chrono::milliseconds(15), std::chrono::milliseconds(10) };
}  // namespace

Duration leastProbeTimeout(Duration slowest, Duration reply_delay)
{
  const Patience& patience = slowest == Duration::zero() ? UNHEARD : HEARD;
  const Duration needed = std::max<Duration>(slowest + slowest / 2, patience.in_all);
  return std::max<Duration>(needed - reply_delay, patience.beyond_delay);
}

ProbeAccount::ProbeAccount(std::size_t inverters, double share)
  : share_(share), last_probe_(inverters), last_long_wait_(inverters, 0)
{
}

TimePoint ProbeAccount::opensAt() const
{
  return opens_at_;
}

TimePoint ProbeAccount::opensAt(std::size_t inverter) const
{
  const TimePoint last = last_probe_[inverter];
  return last == TimePoint() ? last : last + seconds(PROBE_PERIOD_S);
}

bool ProbeAccount::mayWaitLong(TimePoint now, std::size_t inverter, const std::vector<std::size_t>& wanting) const
{
  return now >= paid_off_at_ && std::none_of(wanting.begin(), wanting.end(), [&](std::size_t other) {
           return last_long_wait_[other] < last_long_wait_[inverter];
         });
}

void ProbeAccount::ended(TimePoint now, std::size_t inverter, Duration cost, Duration in_turn)
{
  last_probe_[inverter] = now;
  if (cost > in_turn)
  {
    chargeLongWait(now, inverter, cost - in_turn);
  }
  charge(now, std::min(cost, in_turn));
}

void ProbeAccount::charge(TimePoint now, Duration cost)
{
  const double share = now < paid_off_at_ ? share_ * PROBE_TURNS_SHARE / PROBE_SHARE : share_;
  opens_at_ = std::max(opens_at_, now + std::chrono::duration_cast<Duration>(cost * (1.0 / share - 1.0)));
}

void ProbeAccount::chargeLongWait(TimePoint now, std::size_t inverter, Duration beyond)
{
  last_long_wait_[inverter] = ++long_waits_;
  const double rest = share_ * (1.0 - PROBE_TURNS_SHARE / PROBE_SHARE);
  paid_off_at_ = std::max(paid_off_at_, now + std::chrono::duration_cast<Duration>(beyond * (1.0 / rest)));
}

void ProbeAccount::restart(TimePoint now)
{
  opens_at_ = now;
  std::fill(last_probe_.begin(), last_probe_.end(), TimePoint());
}
}  // namespace bus
}  // namespace inverter_bus

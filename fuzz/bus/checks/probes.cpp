// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/probes.h"

#include <algorithm>

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
namespace
{
constexpr double SHARE = 0.05;
constexpr double MOST_ALLOWED_EXCHANGES_EACH = 4.0;
constexpr double MARGIN_EXCHANGES = 2.0;
constexpr double EXCHANGES_AT_OPENING = 2.0;
}  // namespace

Probes::Probes(const Observed& observed) : observed_(observed), silences_(observed.inverters.size(), 0)
{
}

void Probes::opened()
{
  allow(EXCHANGES_AT_OPENING);
}

void Probes::lost()
{
  std::fill(silences_.begin(), silences_.end(), observed_.scene.offline_after);
}

void Probes::allow(double exchanges)
{
  allowance_ += exchanges * toSeconds(observed_.scene.longestExchange());
}

void Probes::replied(std::size_t index)
{
  silences_[index] = 0;
}

void Probes::ended(TimePoint now)
{
  const Exchange& exchange = observed_.exchange;
  if (!exchange.facts.inverter || exchange.answered)
  {
    return;
  }
  unsigned& silences = silences_[*exchange.facts.inverter];
  silences += exchange.facts.expects_reply ? 1 : 0;
  // One that has answered since, however late, is back.
  if (exchange.to_offline && silences > observed_.scene.offline_after)
  {
    pay(now, now - exchange.began);
  }
}

void Probes::pay(TimePoint now, Duration cost)
{
  const double exchange = toSeconds(observed_.scene.longestExchange());
  const double filled = paid_at_ == TimePoint() ? 0.0 : SHARE * toSeconds(now - paid_at_);
  debt_ = std::max(0.0, debt_ - filled) + toSeconds(cost);
  paid_at_ = now;
  const double most = MOST_ALLOWED_EXCHANGES_EACH * static_cast<double>(silences_.size()) * exchange;
  allowance_ = std::min(allowance_, debt_ + most);
  if (debt_ > allowance_ + MARGIN_EXCHANGES * exchange)
  {
    fail(now, "probes of dead drives take at most 5 % of the time",
         decimal(debt_) + " s beyond their share, " + decimal(allowance_) + " s are allowed for");
  }
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

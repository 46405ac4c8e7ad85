// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/trial.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
// 5 % of 2.7 s: an offline inverter is to be found again within 3 s (contract, rule 3.7).
constexpr double MOST_PAID_FOR_DATA_S = 0.135;
}  // namespace

void Trial::exchangeEnded(bool probe, wire::Outcome outcome, Duration cost)
{
  probed_ = probed_ || probe;
  const bool wasted = outcome != wire::Outcome::Ok;
  cost_ = (under_way_ ? cost_ : Duration::zero()) + cost;
  waste_ = (under_way_ ? waste_ : Duration::zero()) + (wasted ? cost : Duration::zero());
}

void Trial::begin()
{
  probed_ = false;
  under_way_ = true;
}

bool Trial::beginLate()
{
  if (under_way_ || !probed_)
  {
    return false;
  }
  begin();
  cost_ = Duration::zero();
  waste_ = Duration::zero();
  return true;
}

Duration Trial::end()
{
  under_way_ = false;
  return std::max(waste_, std::min(cost_, seconds(MOST_PAID_FOR_DATA_S)));
}

void Trial::drop()
{
  under_way_ = false;
  probed_ = false;
}

bool Trial::underWay() const
{
  return under_way_;
}
}  // namespace bus
}  // namespace inverter_bus

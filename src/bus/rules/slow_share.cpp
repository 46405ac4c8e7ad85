// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/rules/slow_share.h"

#include <algorithm>
#include <string>

namespace inverter_bus
{
namespace bus
{
namespace
{
// From a shorter cycle little could be saved, from a longer one too much.
constexpr double SHORTEST_SAVING_S = 0.7;
constexpr double LONGEST_SAVING_S = 5.0;
// On a line so slow that one exchange takes most of the share.
constexpr double LEAST_RATE = 0.01;
}  // namespace

bool isSlowed(const drive::ReadBlock& block)
{
  return std::all_of(block.fields.begin(), block.fields.end(),
                     [](const std::string& field) { return drive::skippableFields().count(field) != 0; });
}

SlowShare::SlowShare(const Settings& settings) : interval_(settings.interval), longest_(settings.longest)
{
  const double saving = std::min(std::max(toSeconds(settings.cycle), SHORTEST_SAVING_S), LONGEST_SAVING_S);
  // In a window the saved time and all that is earned meanwhile: rate * saving + rate * window = share * window.
  const double rate = SLOW_SHARE * SLOW_WINDOW_S / (SLOW_WINDOW_S + saving);
  saved_ = std::max(seconds(rate * saving), longest_);
  rate_ = std::max(SLOW_SHARE - toSeconds(saved_) / SLOW_WINDOW_S, LEAST_RATE);
}

bool SlowShare::reads() const
{
  return interval_ > Duration{ 0 };
}

bool SlowShare::open(TimePoint now) const
{
  return earned_at_ <= now + seconds(toSeconds(saved_ - longest_) / rate_);
}

void SlowShare::spent(TimePoint end, Duration cost)
{
  earned_at_ = std::max(earned_at_, end - cost) + seconds(toSeconds(cost) / rate_);
}

Duration SlowShare::period(Duration needs) const
{
  return std::max(interval_, seconds(toSeconds(needs) / rate_));
}

double SlowShare::rate() const
{
  return rate_;
}
}  // namespace bus
}  // namespace inverter_bus

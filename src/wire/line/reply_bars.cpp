// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/wire/reply_bars.h"

#include <algorithm>
#include <iterator>

namespace inverter_bus
{
namespace wire
{
namespace
{
constexpr std::chrono::seconds BAR_TIME{ 1 };
/// How long after the bar's end a reply is still recognised as late.
constexpr std::chrono::seconds MEMORY{ 4 };

bool beginsWith(const std::string& text, const std::string& beginning)
{
  return text.compare(0, beginning.size(), beginning) == 0;
}
}  // namespace

void ReplyBars::add(const std::string& shape, std::uint8_t station, const Lost& lost, TimePoint now)
{
  forgetOld(now);
  Bar& bar = bars_[shape];
  // What was lost before the last bar ended will not come any more.
  bar.owed = bar.until > now ? bar.owed : 0;
  bar.station = station;
  bar.until = now + BAR_TIME;
  bar.lost = lost;
  ++bar.owed;
}

TimePoint ReplyBars::barredUntil(const std::string& shape) const
{
  const auto bar = bars_.find(shape);
  return bar == bars_.end() ? TimePoint() : bar->second.until;
}

bool ReplyBars::mayBeLate(const std::string& shape, TimePoint now) const
{
  auto bar = bars_.lower_bound(shape);
  while (bar != bars_.end() && beginsWith(bar->first, shape) && bar->second.until <= now)
  {
    ++bar;
  }
  return bar != bars_.end() && beginsWith(bar->first, shape);
}

bool ReplyBars::owes(TimePoint now) const
{
  return std::any_of(bars_.begin(), bars_.end(), [now](const Bars::value_type& bar) { return bar.second.until > now; });
}

std::optional<ReplyBars::Late> ReplyBars::take(const std::string& shape, TimePoint now)
{
  forgetOld(now);
  const auto first = bars_.lower_bound(shape);
  if (shape.empty() || first == bars_.end() || !beginsWith(first->first, shape))
  {
    return std::nullopt;
  }
  const auto next = std::next(first);
  if (next != bars_.end() && beginsWith(next->first, shape))
  {
    return Late{};
  }
  Late late(first->second.lost);
  // The last one's bar, but the answer may be that to the one before.
  late->ticket = first->second.owed > 1 ? 0 : late->ticket;
  if (--first->second.owed == 0)
  {
    bars_.erase(first);
  }
  return late;
}

void ReplyBars::lift(std::uint8_t station, TimePoint time)
{
  for (auto bar = bars_.begin(); bar != bars_.end();)
  {
    const bool answered_since = bar->second.station == station && bar->second.lost.request_end <= time;
    bar = answered_since ? bars_.erase(bar) : std::next(bar);
  }
}

void ReplyBars::clear()
{
  bars_.clear();
}

void ReplyBars::forgetOld(TimePoint now)
{
  for (auto bar = bars_.begin(); bar != bars_.end();)
  {
    bar = bar->second.until + MEMORY < now ? bars_.erase(bar) : std::next(bar);
  }
}
}  // namespace wire
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/link/link_watch.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, 8.10.
constexpr double SHORTEST_PATIENCE_S = 5.0;
constexpr int TIME_OUTS = 10;
constexpr double FIRST_PERIOD_S = 10.0;
constexpr double LONGEST_PERIOD_S = 60.0;
}  // namespace

LinkWatch::LinkWatch(Duration response_timeout)
  : patience_(std::max(seconds(SHORTEST_PATIENCE_S), TIME_OUTS * response_timeout))
{
}

void LinkWatch::opened(TimePoint now)
{
  opened_at_ = now;
  silent_since_.reset();
}

void LinkWatch::answered()
{
  ever_answered_ = true;
  silent_since_.reset();
  unanswered_since_.reset();
  period_ = Duration::zero();
}

void LinkWatch::lost(TimePoint sent_at)
{
  silent_since_ = silent_since_ ? silent_since_ : std::optional<TimePoint>(sent_at);
  unanswered_since_ = unanswered_since_ ? unanswered_since_ : std::optional<TimePoint>(sent_at);
}

void LinkWatch::notWatching(Duration duration)
{
  opened_at_ += duration;
  for (auto* since : { &silent_since_, &unanswered_since_ })
  {
    *since = *since ? std::optional<TimePoint>(**since + duration) : std::nullopt;
  }
}

bool LinkWatch::wasSilent(TimePoint now) const
{
  return unanswered_since_ && now - *unanswered_since_ >= patience_;
}

bool LinkWatch::mute(TimePoint now) const
{
  if (!silent_since_)
  {
    return false;
  }
  if (inVain())
  {
    return now - renewed_at_ >= period_;
  }
  return ever_answered_ ? now - *silent_since_ >= patience_ : now - opened_at_ >= seconds(FIRST_PERIOD_S);
}

bool LinkWatch::renewing(TimePoint now)
{
  const bool first = !inVain();
  period_ = first ? seconds(FIRST_PERIOD_S) : std::min(2 * period_, seconds(LONGEST_PERIOD_S));
  renewed_at_ = now;
  return first;
}

bool LinkWatch::inVain() const
{
  return period_ > Duration::zero();
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/link/connection_watch.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, 8.9.
constexpr double LONGEST_RESUMING_S = 0.5;
constexpr double QUICK_CLOSE_S = 2.0;
constexpr double QUICK_CLOSES_WINDOW_S = 10.0;
constexpr std::size_t MOST_QUICK_CLOSES = 3;
constexpr double SLOW_PERIOD_S = 2.0;
}  // namespace

// --- what happened ---------------------------------------------------------------------------------------------------

void ConnectionWatch::opened(TimePoint now, const std::vector<std::size_t>& online)
{
  opened_at_ = now;
  last_good_.reset();
  checking_ = resuming_since_.has_value() && !online.empty();
  unread_.clear();
  if (checking_)
  {
    unread_.assign(online.begin(), online.end());
    std::stable_partition(unread_.begin(), unread_.end(), [this](std::size_t index) { return !isTried(index); });
  }
  anybody_ = false;
  resuming_since_.reset();
}

void ConnectionWatch::answered(TimePoint now, std::size_t inverter)
{
  anybody_ = true;
  last_good_ = now;
  closed_unused_ = 0;
  tried_.clear();
  troubled_ = troubled_ && now - opened_at_ < seconds(QUICK_CLOSES_WINDOW_S);
  unread_.erase(std::remove(unread_.begin(), unread_.end(), inverter), unread_.end());
  for (QuickClose& close : quick_closes_)
  {
    close.answers = close.answers || close.inverter == inverter;
  }
}

void ConnectionWatch::unanswered(std::size_t inverter)
{
  unread_.erase(std::remove(unread_.begin(), unread_.end(), inverter), unread_.end());
}

bool ConnectionWatch::isTried(std::size_t inverter) const
{
  return std::find(tried_.begin(), tried_.end(), inverter) != tried_.end();
}

/// Three times in ten seconds; but not where each one came in place of the answer of a station that never answers: that is
/// how some gateways say "no answer".
bool ConnectionWatch::closedTooOften(TimePoint now) const
{
  const auto recent = [now](const QuickClose& close) { return now - close.at <= seconds(QUICK_CLOSES_WINDOW_S); };
  const auto count = static_cast<std::size_t>(std::count_if(quick_closes_.begin(), quick_closes_.end(), recent));
  const bool silent_stations = std::all_of(quick_closes_.begin(), quick_closes_.end(),
                                           [](const QuickClose& close) { return close.inverter && !close.answers; });
  return count >= MOST_QUICK_CLOSES && !silent_stations;
}

ConnectionWatch::Verdict ConnectionWatch::closed(TimePoint now, std::optional<std::size_t> inverter)
{
  const bool used = last_good_.has_value();
  if (inverter)
  {
    tried_.push_back(*inverter);
  }
  const bool others_left =
      checking_ && std::any_of(unread_.begin(), unread_.end(), [this](std::size_t index) { return !isTried(index); });
  if (!used && !(inverter && others_left))
  {
    ++closed_unused_;
    lost();
    not_before_ = std::max(now, opened_at_ + seconds(SLOW_PERIOD_S));
    return Verdict::Lost;
  }
  while (!quick_closes_.empty() && now - quick_closes_.front().at > seconds(QUICK_CLOSES_WINDOW_S))
  {
    quick_closes_.pop_front();
  }
  if (used && now - *last_good_ <= seconds(QUICK_CLOSE_S))
  {
    quick_closes_.push_back({ now, inverter, false });
    if (closedTooOften(now))
    {
      // Once more immediately, since there is something to stop; then at intervals.
      not_before_ = troubled_ ? std::max(now, opened_at_ + seconds(SLOW_PERIOD_S)) : now;
      lost();
      troubled_ = true;
      return Verdict::TakenByAnother;
    }
  }
  resuming_since_ = now;
  not_before_ = now;
  return Verdict::Resume;
}

ConnectionWatch::Verdict ConnectionWatch::notOpen(TimePoint now)
{
  if (resuming_since_ && now - *resuming_since_ < seconds(LONGEST_RESUMING_S))
  {
    return Verdict::Resume;
  }
  resuming_since_.reset();
  return Verdict::Lost;
}

void ConnectionWatch::reopening(TimePoint now)
{
  lost();
  resuming_since_ = now;
}

void ConnectionWatch::lost()
{
  resuming_since_.reset();
  checking_ = false;
  unread_.clear();
  tried_.clear();
  last_good_.reset();
}

void ConnectionWatch::slowDown()
{
  lost();
  not_before_ = opened_at_ + seconds(SLOW_PERIOD_S);
}

// --- what follows ----------------------------------------------------------------------------------------------------

bool ConnectionWatch::resuming() const
{
  return resuming_since_.has_value();
}

bool ConnectionWatch::closedAgain(std::size_t inverter) const
{
  return std::count(tried_.begin(), tried_.end(), inverter) > 1;
}

std::optional<std::size_t> ConnectionWatch::toRead() const
{
  return checking_ && !unread_.empty() ? std::optional<std::size_t>(unread_.front()) : std::nullopt;
}

bool ConnectionWatch::nobodyAnswered() const
{
  return checking_ && unread_.empty() && !anybody_;
}

TimePoint ConnectionWatch::openNotBefore() const
{
  return not_before_;
}

unsigned ConnectionWatch::closedUnused() const
{
  return closed_unused_;
}
}  // namespace bus
}  // namespace inverter_bus

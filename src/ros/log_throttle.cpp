// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/log_throttle.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
constexpr Duration PERIOD = std::chrono::seconds(5);
constexpr std::size_t MOST_LINES = 50;
/// Gone and back, twice.
constexpr std::size_t MOST_OF_A_SUBJECT = 4;
}  // namespace

bool LogThrottle::admit(const bus::Finding& finding, TimePoint now)
{
  forgetBefore(now - PERIOD);
  const bool room = roomFor(finding.subject) <= now;
  if (finding.subject.empty())
  {
    if (!room || wasLogged(finding.text))
    {
      ++suppressed_;
      return false;
    }
    note(finding, now);
    return true;
  }
  drop(finding.subject);
  if (!isNews(finding) && wasLogged(finding.text))
  {
    ++suppressed_;
    return false;
  }
  if (!room)
  {
    held_[finding.subject] = finding;
    return false;
  }
  note(finding, now);
  return true;
}

std::optional<TimePoint> LogThrottle::nextDue() const
{
  std::optional<TimePoint> due;
  for (const auto& held : held_)
  {
    const TimePoint room = roomFor(held.first);
    due = due ? std::min(*due, room) : room;
  }
  return due;
}

std::vector<bus::Finding> LogThrottle::takeDue(TimePoint now)
{
  forgetBefore(now - PERIOD);
  std::vector<bus::Finding> due;
  for (auto held = held_.begin(); held != held_.end();)
  {
    if (roomFor(held->first) > now)
    {
      ++held;
      continue;
    }
    const bus::Finding finding = std::move(held->second);
    held = held_.erase(held);
    if (isNews(finding))
    {
      note(finding, now);
      due.push_back(finding);
    }
    else
    {
      ++suppressed_;
    }
  }
  return due;
}

std::vector<bus::Finding> LogThrottle::takeHeld()
{
  std::vector<bus::Finding> all;
  for (auto& held : held_)
  {
    if (isNews(held.second))
    {
      all.push_back(std::move(held.second));
    }
  }
  held_.clear();
  return all;
}

std::size_t LogThrottle::takeSuppressed()
{
  return std::exchange(suppressed_, 0);
}

void LogThrottle::forgetBefore(TimePoint time)
{
  while (!logged_.empty() && logged_.front().time <= time)
  {
    logged_.pop_front();
  }
}

bool LogThrottle::wasLogged(const std::string& text) const
{
  return std::any_of(logged_.begin(), logged_.end(), [&](const Line& line) { return line.text == text; });
}

/// The log does not end with it already.
bool LogThrottle::isNews(const bus::Finding& finding) const
{
  const auto last = last_.find(finding.subject);
  return last == last_.end() || last->second != finding.text;
}

/// From when on a line of \p subject may be logged, as far as its number goes.
TimePoint LogThrottle::roomFor(const std::string& subject) const
{
  TimePoint room;
  if (logged_.size() >= MOST_LINES)
  {
    room = logged_[logged_.size() - MOST_LINES].time + PERIOD;
  }
  std::size_t lines = 0;
  for (auto line = logged_.rbegin(); !subject.empty() && line != logged_.rend(); ++line)
  {
    lines += line->subject == subject ? 1 : 0;
    if (lines == MOST_OF_A_SUBJECT)
    {
      return std::max(room, line->time + PERIOD);
    }
  }
  return room;
}

void LogThrottle::note(const bus::Finding& finding, TimePoint now)
{
  logged_.push_back({ finding.text, finding.subject, now });
  if (!finding.subject.empty())
  {
    last_[finding.subject] = finding.text;
  }
}

/// The state that a held line describes is over.
void LogThrottle::drop(const std::string& subject)
{
  suppressed_ += held_.erase(subject);
}
}  // namespace ros_node
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/story.h"

#include <algorithm>
#include <cstdio>

namespace inverter_bus
{
namespace fuzz
{
namespace
{
constexpr std::size_t KEPT = 5000;
}  // namespace

Story::Story(TimePoint start) : start_(start)
{
}

void Story::frame(const simulation::FrameRecord& frame)
{
  frames_.push_back(frame);
  if (frames_.size() > KEPT)
  {
    frames_.pop_front();
  }
}

void Story::event(TimePoint now, const std::string& text)
{
  events_.emplace_back(now, text);
  if (events_.size() > KEPT)
  {
    events_.pop_front();
  }
}

std::string Story::eventText(const std::pair<TimePoint, std::string>& event) const
{
  char time[32];
  std::snprintf(time, sizeof time, "%.6f", toSeconds(event.first - start_));
  return std::string("  ") + time + " ----- " + event.second + "\n";
}

std::string Story::lastFrames(std::size_t count) const
{
  std::string text;
  const auto first = frames_.end() - static_cast<std::ptrdiff_t>(std::min(count, frames_.size()));
  auto event = events_.begin();
  while (first != frames_.end() && event != events_.end() && event->first < first->time)
  {
    ++event;
  }
  for (auto frame = first; frame != frames_.end(); ++frame)
  {
    for (; event != events_.end() && event->first <= frame->time; ++event)
    {
      text += eventText(*event);
    }
    text += "  " + simulation::frameText(*frame, start_) + "\n";
  }
  for (; event != events_.end(); ++event)
  {
    text += eventText(*event);
  }
  return text;
}
}  // namespace fuzz
}  // namespace inverter_bus

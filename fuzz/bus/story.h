// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_STORY_H
#define INVERTER_BUS_FUZZ_STORY_H

#include <deque>
#include <string>
#include <utility>

#include "inverter_bus/simulation/simulated_bus.h"
#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace fuzz
{
/// What has happened lately, for the report of a broken rule.
class Story
{
public:
  explicit Story(TimePoint start);

  void frame(const simulation::FrameRecord& frame);
  /// What users or the world did.
  void event(TimePoint now, const std::string& text);
  /// The last \p count frames, and the events among them.
  std::string lastFrames(std::size_t count) const;

private:
  std::string eventText(const std::pair<TimePoint, std::string>& event) const;

  TimePoint start_;
  std::deque<simulation::FrameRecord> frames_;
  std::deque<std::pair<TimePoint, std::string>> events_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_STORY_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/report/line_watch.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double FOREIGN_SHOWN_S = 60.0;
}  // namespace

void LineWatch::note(TimePoint now, const LineFacts& facts)
{
  if (facts.counters.foreign_frames != facts_.counters.foreign_frames)
  {
    foreign_at_ = now;
  }
  facts_ = facts;
}

const LineFacts& LineWatch::facts() const
{
  return facts_;
}

std::optional<Finding> LineWatch::foreignFinding(TimePoint now, bool gateway) const
{
  if (facts_.counters.foreign_frames == 0 || now - foreign_at_ >= seconds(FOREIGN_SHOWN_S))
  {
    return std::nullopt;
  }
  return Finding{ Level::Warn, std::string("frames that this node did not ask for are on the line: look for ") +
                                   (gateway ? "another client of the gateway, or a gateway that polls by itself"
                                            : "a second master") +
                                   " (" + std::to_string(facts_.counters.foreign_frames) + " so far)" };
}
}  // namespace bus
}  // namespace inverter_bus

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

void LineWatch::note(TimePoint now, const wire::LineCounters& counters, bool echo_found, const std::string& quirk)
{
  if (counters.foreign_frames != counters_.foreign_frames)
  {
    foreign_at_ = now;
  }
  counters_ = counters;
  echo_found_ = echo_found;
  gateway_quirk_ = quirk;
}

const wire::LineCounters& LineWatch::counters() const
{
  return counters_;
}

bool LineWatch::echoFound() const
{
  return echo_found_;
}

const std::string& LineWatch::gatewayQuirk() const
{
  return gateway_quirk_;
}

std::optional<Finding> LineWatch::foreignFinding(TimePoint now, bool gateway) const
{
  if (counters_.foreign_frames == 0 || now - foreign_at_ >= seconds(FOREIGN_SHOWN_S))
  {
    return std::nullopt;
  }
  return Finding{ Level::Warn, std::string("frames that this node did not ask for are on the line: look for ") +
                                   (gateway ? "another client of the gateway, or a gateway that polls by itself"
                                            : "a second master") +
                                   " (" + std::to_string(counters_.foreign_frames) + " so far)" };
}
}  // namespace bus
}  // namespace inverter_bus

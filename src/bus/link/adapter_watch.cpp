// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/link/adapter_watch.h"

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
/// What a chip that delivers at once shows, plus one.
constexpr double LONGEST_S = 0.002;
}  // namespace

void AdapterWatch::note(const std::optional<wire::AdapterLatency>& latency)
{
  latency_ = latency;
}

Duration AdapterWatch::latency() const
{
  return latency_ ? latency_->latency : Duration{ 0 };
}

std::optional<Finding> AdapterWatch::finding() const
{
  if (!latency_ || latency_->latency <= seconds(LONGEST_S))
  {
    return std::nullopt;
  }
  return Finding{ Level::Warn, "the adapter holds bytes back for up to " +
                                   util::millisecondsText(latency_->latency, 0) +
                                   ", which lengthens every exchange: echo 1 | sudo tee " + latency_->file };
}

std::string AdapterWatch::text() const
{
  return latency_ ? util::millisecondsText(latency_->latency, 0) : "not reported by its driver";
}
}  // namespace bus
}  // namespace inverter_bus

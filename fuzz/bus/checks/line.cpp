// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/line.h"

#include <algorithm>

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
namespace
{
constexpr double GAP_TOLERANCE_S = 2e-6;
}  // namespace

Line::Line(const Observed& observed) : observed_(observed)
{
}

void Line::opened(TimePoint now)
{
  heard_at_ = now;
  request_end_ = now;
}

void Line::heard(TimePoint now)
{
  heard_at_ = now;
}

void Line::begins(TimePoint now, const simulation::Bytes& request)
{
  if (observed_.exchange.in_flight)
  {
    fail(now, "one request in flight", "a request begins while another one is waited for");
  }
  checkGap(now);
  request_end_ = now + seconds(observed_.scene.character * static_cast<double>(request.size()));
}

/// Rule 3.8: silence before each request, counted from the last byte that came or went.
void Line::checkGap(TimePoint now) const
{
  const TimePoint last = std::max(request_end_, heard_at_);
  const Duration gap = observed_.scene.gap();
  if (now - last < gap - seconds(GAP_TOLERANCE_S) && observed_.babble(now) == Duration{ 0 })
  {
    fail(now, "gap",
         "only " + decimal(toSeconds(now - last) * 1e3) + " ms of silence before a request instead of " +
             decimal(toSeconds(gap) * 1e3) + " ms");
  }
}

void Line::checkStation(TimePoint now) const
{
  const RequestFacts& facts = observed_.exchange.facts;
  if (!facts.inverter && !facts.broadcast)
  {
    fail(now, "frames", "a request to a station that is not on the bus");
  }
}

/// Rule 3.3.
void Line::checkBroadcast(TimePoint now) const
{
  const RequestFacts& facts = observed_.exchange.facts;
  if (facts.broadcast && (!observed_.scene.one_brand || !facts.stop))
  {
    fail(now, "broadcasts", "a broadcast that is no stop, or on a bus of several brands");
  }
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

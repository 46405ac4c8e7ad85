// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/rules/reply_times.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, 8.4.
constexpr std::size_t REPLIES = 256;
constexpr int TIMES_THE_LONGEST = 3;
constexpr std::chrono::milliseconds SHORTEST{ 15 };
constexpr std::chrono::milliseconds HEARD_MARGIN{ 2 };
}  // namespace

ReplyTimes::ReplyTimes() : times_(REPLIES, Duration{ 0 }), heard_(REPLIES, Duration{ 0 })
{
}

void ReplyTimes::replied(Duration time, Duration heard)
{
  times_[next_] = time;
  heard_[next_] = heard;
  next_ = (next_ + 1) % REPLIES;
  longest_ = *std::max_element(times_.begin(), times_.end());
  latest_heard_ = *std::max_element(heard_.begin(), heard_.end());
  answers_ = true;
}

void ReplyTimes::missed()
{
  answers_ = false;
}

Duration ReplyTimes::cutAfter(Duration own_delay, Duration adapter) const
{
  return std::max({ TIMES_THE_LONGEST * longest_, own_delay, adapter + SHORTEST, latest_heard_ + HEARD_MARGIN });
}

Duration ReplyTimes::longest() const
{
  return longest_;
}

bool ReplyTimes::answers() const
{
  return answers_;
}
}  // namespace bus
}  // namespace inverter_bus

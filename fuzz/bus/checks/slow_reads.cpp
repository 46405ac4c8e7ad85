// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/slow_reads.h"

#include <algorithm>
#include <set>
#include <string>

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
namespace
{
constexpr double SHARE = 0.075;
constexpr double WINDOW_S = 10.0;
constexpr double TOLERANCE_S = 0.001;
constexpr double BARRED_S = 3.0;
// Warning words: a new warning has them read at once.
const std::set<unsigned>& warningWords()
{
  static const std::set<unsigned> ADDRESSES{ 0x004D, 0xFC91 };
  return ADDRESSES;
}
}  // namespace

SlowReads::SlowReads(const Observed& observed) : observed_(observed), answered_(observed.inverters.size())
{
}

void SlowReads::begins(TimePoint now)
{
  const RequestFacts& facts = observed_.exchange.facts;
  if (!facts.inverter || !facts.reads_slow)
  {
    return;
  }
  const double interval = observed_.scene.slow_interval;
  const std::string title = observed_.scene.title(*facts.inverter);
  const auto last = answered_[*facts.inverter].find(facts.address);
  // After a lost exchange any read may go that no late reply answers, so that the drive's own time-out does not pass.
  const TimePoint lost_at = observed_.inverters[*facts.inverter].link.lost_at;
  const bool disturbed = lost_at != TimePoint() && now - lost_at < seconds(BARRED_S);
  if (interval <= 0.0 && !disturbed)
  {
    fail(now, "no slow value is read with slow_interval 0", title);
  }
  const bool early =
      !disturbed && last != answered_[*facts.inverter].end() && now - last->second < seconds(interval - TOLERANCE_S);
  if (early && warningWords().count(facts.address) == 0)
  {
    fail(now, "no slow value is read more often than slow_interval",
         title + ": again after " + decimal(toSeconds(now - last->second)) + " s");
  }
}

void SlowReads::answered(TimePoint now, std::size_t index, const ReplyFacts& reply)
{
  // One that is refused for the moment is asked for again.
  if (observed_.exchange.facts.reads_slow && reply.good)
  {
    answered_[index][observed_.exchange.facts.address] = now;
  }
}

void SlowReads::ended(TimePoint now)
{
  const Exchange& exchange = observed_.exchange;
  // One that is not answered takes a time that was unknown before.
  if (!exchange.facts.inverter || !exchange.facts.reads_slow || !exchange.answered)
  {
    return;
  }
  spent_.emplace_back(now, now - exchange.began + observed_.scene.gap());
  sum_ += spent_.back().second;
  while (now - spent_.front().first > seconds(WINDOW_S))
  {
    sum_ -= spent_.front().second;
    spent_.pop_front();
  }
  // A drive may take longer for one than its profile says.
  const auto longest = std::max_element(spent_.begin(), spent_.end(),
                                        [](const auto& one, const auto& other) { return one.second < other.second; });
  const Duration most = seconds(SHARE * WINDOW_S) + longest->second;
  if (sum_ > most)
  {
    fail(now, "slow values take at most 7.5 % of the wire",
         decimal(toSeconds(sum_)) + " s of the last " + decimal(WINDOW_S) + " s");
  }
}

void SlowReads::wentOffline(std::size_t index)
{
  answered_[index].clear();
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

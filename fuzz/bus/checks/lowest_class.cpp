// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/lowest_class.h"

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
constexpr unsigned EVERY = 8;
constexpr unsigned READS_BY_DEADLINE = 4;  // a drive's own time-out goes first, with a whole refresh
constexpr unsigned MARGIN = 2;
constexpr double BARRED_S = 3.0;  // after a lost exchange what is alike waits for a while (rule 3.9)
}  // namespace

LowestClass::LowestClass(const Observed& observed) : observed_(observed), lanes_(observed.inverters.size())
{
}

void LowestClass::check(TimePoint now)
{
  const RequestFacts& facts = observed_.exchange.facts;
  const bool waiting = anyoneWaits(now);
  const bool counts = facts.reads && !facts.reads_run && !facts.loopback;
  // A setting that is written, and refused for a while, has had the turn of one that waits to be read.
  const bool its_turn = facts.reads_parameter || facts.writes_setting || clearsLineForSetting(now);
  if (!waiting || !counts || its_turn)
  {
    others_in_a_row_ = its_turn || !waiting ? 0 : others_in_a_row_;
    return;
  }
  if (++others_in_a_row_ > longestRow())
  {
    fail(now, "the lowest class gets every eighth exchange",
         std::to_string(others_in_a_row_) + " reads went before a setting that waits");
  }
}

unsigned LowestClass::longestRow() const
{
  const auto& inverters = observed_.scene.inverters;
  const auto supervised = std::count_if(inverters.begin(), inverters.end(),
                                        [](const InverterFacts& facts) { return facts.drive_timeout > 0.0; });
  return EVERY + READS_BY_DEADLINE * static_cast<unsigned>(supervised) + MARGIN;
}

bool LowestClass::anyoneWaits(TimePoint now) const
{
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    const InverterRecord& inverter = observed_.inverters[index];
    const TimePoint lost_at = inverter.link.lost_at;
    // A drive that is deaf after its reset is not asked.
    const bool undisturbed =
        (lost_at == TimePoint() || now - lost_at > seconds(BARRED_S)) && now > inverter.link.deaf_until;
    if (undisturbed && lanes_[index].first_time && inverter.told.online && hasUnreadSettings(index))
    {
      return true;
    }
  }
  return false;
}

bool LowestClass::hasUnreadSettings(std::size_t index) const
{
  const std::set<unsigned> wanted = settingsOf(observed_.scene.inverters[index]);
  const std::set<unsigned>& read = lanes_[index].settings_read;
  return !std::includes(read.begin(), read.end(), wanted.begin(), wanted.end());
}

/// The turn came to a drive that has lost an exchange: a loop-back goes before what is alike (rule 3.9).
bool LowestClass::clearsLineForSetting(TimePoint now) const
{
  const RequestFacts& facts = observed_.exchange.facts;
  if (!facts.loopback || !facts.inverter || !hasUnreadSettings(*facts.inverter))
  {
    return false;
  }
  const InverterRecord& inverter = observed_.inverters[*facts.inverter];
  return lanes_[*facts.inverter].first_time && inverter.told.online && now - inverter.link.lost_at < seconds(BARRED_S);
}

void LowestClass::answered(std::size_t index)
{
  const RequestFacts& facts = observed_.exchange.facts;
  if (facts.reads_parameter)
  {
    lanes_[index].settings_read.insert(facts.address);
  }
}

void LowestClass::wentOffline(std::size_t index)
{
  lanes_[index].first_time = false;
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/cut_waits.h"

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
constexpr double SHORTEST_S = 0.015;
constexpr int TIMES_THE_LONGEST = 3;
constexpr double SHORTEST_PAUSE_S = 0.005;
constexpr double FIFO_CHARACTERS = 18.0;
// Fewer than the 256 of the rule: which replies the node has counted is not quite known.
constexpr std::size_t REPLIES = 200;
constexpr double TOLERANCE_S = 0.001;
// How often the node looks, and in what steps bytes are handed over.
constexpr double LOOK_S = 0.005;

/// It writes what is no command word.
bool isOtherWrite(const RequestFacts& facts)
{
  return !facts.reads && !facts.loopback && !facts.commands();
}
}  // namespace

CutWaits::CutWaits(const Observed& observed)
  : observed_(observed), stations_(observed.inverters.size()), due_(observed.inverters.size())
{
  for (Station& station : stations_)
  {
    station.last.assign(REPLIES, Duration{ 0 });
  }
}

void CutWaits::asked(TimePoint now, std::size_t index)
{
  const Exchange& exchange = observed_.exchange;
  const bool own_run = exchange.facts.run && exchange.facts.inverter == index;
  const bool due = exchange.in_flight && mayBeCut(exchange) && !own_run && observed_.online(index) &&
                   !observed_.inverters[index].stop.active && !observed_.shutting_down;
  if (due && !due_[index])
  {
    due_[index] = Due{ now, exchange.request_end, longest(*exchange.facts.inverter) };
  }
}

void CutWaits::zeroCame()
{
  zero_came_ = true;
}

void CutWaits::dropAll()
{
  std::fill(due_.begin(), due_.end(), std::nullopt);
  cut_.reset();
}

/// What a node must wait for: what looks like a status is the read-back of a stop where one is pending.
bool CutWaits::isLasting(const Exchange& exchange) const
{
  const RequestFacts& facts = exchange.facts;
  // A VF-S15 keeps what it is told in its EEPROM, but for command words; what the others keep is not known, but for the MX2.
  const bool hitachi = observed_.scene.inverters[*facts.inverter].brand == Brand::HITACHI;
  return facts.stop || facts.reset || (!hitachi && isOtherWrite(facts));
}

/// A frequency that a 3G3JE keeps in its EEPROM unless it was put into RAM mode since it was switched on.
bool CutWaits::mayWear(const Exchange& exchange) const
{
  const RequestFacts& facts = exchange.facts;
  return observed_.scene.inverters[*facts.inverter].brand == Brand::JE && facts.set_hertz.has_value();
}

/// It is waited for no longer than 8.4 says when a stop comes.
bool CutWaits::mayBeCut(const Exchange& exchange) const
{
  const RequestFacts& facts = exchange.facts;
  if (!facts.inverter || !facts.expects_reply || isLasting(exchange) || isOtherWrite(facts) || mayWear(exchange))
  {
    return false;
  }
  return !(observed_.inverters[*facts.inverter].stop.active && (facts.reads_run || facts.loopback));
}

bool CutWaits::insists() const
{
  return std::any_of(observed_.inverters.begin(), observed_.inverters.end(),
                     [](const InverterRecord& inverter) { return inverter.stop.active; });
}

Duration CutWaits::shortest(std::size_t index) const
{
  const Station& station = stations_[index];
  const Duration longest = *std::max_element(station.last.begin(), station.last.end());
  return std::max(seconds(SHORTEST_S), TIMES_THE_LONGEST * longest) - seconds(TOLERANCE_S);
}

Duration CutWaits::longest(std::size_t index) const
{
  return std::max({ seconds(SHORTEST_S), TIMES_THE_LONGEST * stations_[index].longest,
                    seconds(observed_.scene.inverters[index].own_delay + PROFILE_DELAY_S) });
}

Duration CutWaits::pause() const
{
  return seconds(std::max(SHORTEST_PAUSE_S, FIFO_CHARACTERS * observed_.scene.character));
}

void CutWaits::begins(TimePoint now)
{
  judgeLatency(now);
  insisted_ = insists();
  const bool superseded = zero_came_;
  zero_came_ = false;
  std::fill(due_.begin(), due_.end(), std::nullopt);
  if (cut_ && !superseded)
  {
    judgeCut(now);
  }
  cut_.reset();
}

/// The frame after one that was given up early.
void CutWaits::judgeCut(TimePoint now) const
{
  const RequestFacts& facts = observed_.exchange.facts;
  // Before a stop that a late reply could answer goes a loop-back.
  if (!facts.stop && !facts.loopback)
  {
    fail(now, "nothing but a stop cuts a wait",
         "given up early: " + simulation::toHex(cut_->request) + ", and then goes " +
             simulation::toHex(observed_.exchange.request));
  }
  if (facts.stop && cut_->facts.run && facts.inverter && facts.inverter == cut_->facts.inverter)
  {
    fail(now, "a stop waits for its own drive's RUN", "given up early: " + simulation::toHex(cut_->request));
  }
}

void CutWaits::judgeLatency(TimePoint now)
{
  const RequestFacts& facts = observed_.exchange.facts;
  for (std::size_t index = 0; index < due_.size(); ++index)
  {
    const std::optional<Due>& due = due_[index];
    if (!due || !facts.stop || facts.inverter != index || observed_.babble(now) != Duration{ 0 })
    {
      continue;
    }
    ++checked_;
    const TimePoint latest = std::max({ due->at, due->request_end + due->patience, heard_at_ + pause() }) +
                             observed_.scene.gap() + observed_.quiet() + seconds(LOOK_S);
    if (now > latest)
    {
      fail(now, "a stop cuts a wait",
           "its first byte comes " + decimal(toSeconds(now - due->at) * 1e3) + " ms after its request, " +
               decimal(toSeconds(now - latest) * 1e3) + " ms later than that");
    }
  }
}

void CutWaits::answered(TimePoint began, bool good)
{
  const Exchange& exchange = observed_.exchange;
  Station& station = stations_[*exchange.facts.inverter];
  const Duration by_the_line = began - exchange.request_end;
  if (good && exchange.facts.reads)
  {
    station.last[station.next] = by_the_line;
    station.next = (station.next + 1) % station.last.size();
  }
  station.longest = std::max(station.longest, by_the_line + seconds(LOOK_S));
}

void CutWaits::ended(TimePoint now)
{
  const Exchange& exchange = observed_.exchange;
  heard_at_ = exchange.heard_at;
  cut_.reset();
  if (!exchange.cut || exchange.to_offline)
  {
    return;
  }
  const std::size_t index = *exchange.facts.inverter;
  if (isLasting(exchange))
  {
    fail(now, "stops, resets and what is kept are waited for",
         "given up early: " + simulation::toHex(exchange.request));
  }
  const bool silent = exchange.heard_at == TimePoint();
  const Duration waited = silent ? now - exchange.request_end : now - exchange.heard_at;
  const Duration least = silent ? shortest(index) : seconds(SHORTEST_PAUSE_S - TOLERANCE_S);
  // Between two tries of a stop that insists who does not answer is waited for as short as one likes.
  if (waited < least && !insisted_ && !insists())
  {
    fail(now, "a drive has its time before a stop cuts the wait",
         "given up after " + decimal(toSeconds(waited) * 1e3) + " ms instead of " + decimal(toSeconds(least) * 1e3));
  }
  if (!insisted_ && !insists())
  {
    cut_ = exchange;
  }
}

std::uint64_t CutWaits::checked() const
{
  return checked_;
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

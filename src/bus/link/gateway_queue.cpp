// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/link/gateway_queue.h"

#include <algorithm>
#include <utility>

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, 8.8: after this many lost requests without any late answer the gateway is silent by nature.
constexpr unsigned UNANSWERED_BY_NATURE = 3;
// After this many answers of the gateway's own in time its block has become that short.
constexpr unsigned IN_TIME_BY_NATURE = 8;
}  // namespace

GatewayQueue::GatewayQueue(const Settings& settings) : settings_(settings)
{
}

bool GatewayQueue::active() const
{
  return settings_.active;
}

std::vector<GatewayQueue::Entry>::iterator GatewayQueue::find(std::uint64_t ticket)
{
  return std::find_if(entries_.begin(), entries_.end(),
                      [ticket](const Entry& entry) { return entry.ticket == ticket && !entry.orphan; });
}

// --- what happened ---------------------------------------------------------------------------------------------------

void GatewayQueue::sent(TimePoint now, std::uint64_t ticket, std::size_t inverter, GatewayRisk risk, bool probe)
{
  if (!settings_.active)
  {
    return;
  }
  giveUp(now);
  Entry entry;
  entry.ticket = ticket;
  entry.inverter = inverter;
  entry.risk = risk;
  entry.probe = probe;
  entry.sent_at = now;
  entry.behind_another = !free(now);
  entries_.push_back(entry);
}

void GatewayQueue::answered(TimePoint now, std::uint64_t ticket, bool by_gateway)
{
  const auto entry = find(ticket);
  if (entry != entries_.end())
  {
    const Duration took = now - entry->sent_at;
    longest_reply_ = std::max(longest_reply_, took);
    if (by_gateway && !entry->behind_another)
    {
      noteInTime(std::min(took, settings_.timeout));
    }
    entries_.erase(entry);
  }
}

/// In time or not: this is how long all others are kept waiting.
void GatewayQueue::noteInTime(Duration took)
{
  longest_in_time_ = std::max(longest_in_time_, took);
  if (++in_time_ >= IN_TIME_BY_NATURE)
  {
    noteBlock(longest_in_time_);
  }
  block_ = std::max(block_, took);
}

void GatewayQueue::noteBlock(Duration block)
{
  block_ = block;
  in_time_ = 0;
  longest_in_time_ = Duration::zero();
}

void GatewayQueue::lost(TimePoint now, std::uint64_t ticket)
{
  const auto entry = find(ticket);
  if (entry != entries_.end())
  {
    entry->lost = true;
  }
  giveUp(now);
}

std::optional<GatewayQueue::Late> GatewayQueue::answeredLate(TimePoint now, std::uint64_t ticket)
{
  const auto entry = find(ticket);
  // A late answer to any request shows that waiting is worthwhile.
  unanswered_ = 0;
  if (entry == entries_.end())
  {
    return std::nullopt;
  }
  const Late late{ entry->inverter, entry->risk, !entry->behind_another, entry->probe };
  if (late.alone)
  {
    noteBlock(std::min(now - entry->sent_at, settings_.timeout));
  }
  entries_.erase(entry);
  return late;
}

void GatewayQueue::connectionEnded(TimePoint now)
{
  giveUp(now);
  for (Entry& entry : entries_)
  {
    noteCutShort(entry, now);
    entry.orphan = true;
  }
  // Only what may start a motor matters beyond the connection.
  entries_.erase(std::remove_if(entries_.begin(), entries_.end(),
                                [](const Entry& entry) { return entry.risk != GatewayRisk::Motion; }),
                 entries_.end());
}

/// A request that was alone shows how long a station that doesn't answer blocks the gateway.
void GatewayQueue::noteUnanswered(const Entry& entry)
{
  if (entry.lost && !entry.orphan && !entry.behind_another)
  {
    // As long as it was waited for, not as long as the next one will be.
    noteBlock(wait());
    unanswered_ = std::min(unanswered_ + 1, UNANSWERED_BY_NATURE);
  }
}

/// It was waited for until its connection ended: a gateway may report a silent station that way.
void GatewayQueue::noteCutShort(const Entry& entry, TimePoint now)
{
  if (!entry.lost || entry.orphan)
  {
    return;
  }
  const Duration kept = std::min(now - entry.sent_at, wait());
  noteKept(entry, kept);
  // At least: it may have ended for another reason.
  block_ = entry.behind_another ? block_ : std::max(block_, kept);
}

void GatewayQueue::noteKept(const Entry& entry, Duration kept)
{
  if (entry.probe && !entry.orphan)
  {
    kept_ = std::max(kept_.value_or(Duration::zero()), kept);
  }
}

void GatewayQueue::giveUp(TimePoint now)
{
  for (auto entry = entries_.begin(); entry != entries_.end();)
  {
    const bool over = (entry->lost || entry->orphan) && givenUpAt(*entry) <= now;
    if (over)
    {
      // Not until now: a late look does not mean that it was blocked that long.
      noteKept(*entry, givenUpAt(*entry) - entry->sent_at);
      noteUnanswered(*entry);
    }
    entry = over ? entries_.erase(entry) : entry + 1;
  }
}

std::optional<Duration> GatewayQueue::tick(TimePoint now)
{
  giveUp(now);
  return std::exchange(kept_, std::nullopt);
}

// --- what may go -----------------------------------------------------------------------------------------------------

/// What may start a motor is allowed for during the whole time: that no answer was ever late proves nothing.
TimePoint GatewayQueue::givenUpAt(const Entry& entry) const
{
  return entry.sent_at + (entry.risk == GatewayRisk::Motion || entry.orphan ? settings_.timeout : wait());
}

/// An answer may still come, and the gateway is busy until then.
bool GatewayQueue::owed(const Entry& entry, TimePoint now) const
{
  return !entry.orphan && (!entry.lost || entry.sent_at + wait() > now);
}

bool GatewayQueue::free(TimePoint now) const
{
  return std::none_of(entries_.begin(), entries_.end(), [&](const Entry& entry) { return owed(entry, now); });
}

TimePoint GatewayQueue::freeAt(TimePoint now) const
{
  TimePoint at = now;
  for (const Entry& entry : entries_)
  {
    at = owed(entry, now) ? std::max(at, entry.sent_at + wait()) : at;
  }
  return at;
}

TimePoint GatewayQueue::stopMayGoAt(TimePoint now, std::size_t inverter) const
{
  TimePoint at = now;
  for (const Entry& entry : entries_)
  {
    const bool own = entry.inverter == inverter && entry.risk == GatewayRisk::Stop;
    at = own && owed(entry, now) ? std::max(at, entry.sent_at + wait()) : at;
  }
  return at;
}

bool GatewayQueue::refreshUnanswered(TimePoint now, std::size_t inverter) const
{
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.inverter == inverter && entry.risk == GatewayRisk::Refresh && owed(entry, now);
  });
}

std::optional<TimePoint> GatewayQueue::motionUntil(TimePoint now, std::size_t inverter) const
{
  std::optional<TimePoint> until;
  for (const Entry& entry : entries_)
  {
    const bool risky = entry.inverter == inverter && entry.risk == GatewayRisk::Motion && givenUpAt(entry) > now;
    if (risky && (!until || *until < givenUpAt(entry)))
    {
      until = givenUpAt(entry);
    }
  }
  return until;
}

bool GatewayQueue::behindAnother(std::uint64_t ticket) const
{
  return std::any_of(entries_.begin(), entries_.end(),
                     [ticket](const Entry& entry) { return entry.ticket == ticket && entry.behind_another; });
}

// --- what it has learned ---------------------------------------------------------------------------------------------

Duration GatewayQueue::block() const
{
  return block_;
}

Duration GatewayQueue::longestPause() const
{
  const bool waiting =
      std::any_of(entries_.begin(), entries_.end(), [](const Entry& entry) { return entry.lost && !entry.orphan; });
  return waiting ? std::max(block_, wait()) : block_;
}

bool GatewayQueue::silentByNature() const
{
  return unanswered_ >= UNANSWERED_BY_NATURE;
}

Duration GatewayQueue::wait() const
{
  return silentByNature() ? std::min(settings_.timeout, longest_reply_ + settings_.response_timeout)
                          : settings_.timeout;
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/liveness.h"

#include <algorithm>

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, 8.15.
constexpr double SHORTEST_PATIENCE_S = 2.0;
constexpr int PERIODS_OF_PATIENCE = 3;
// A single one may be due to the line, and the next turn far away.
constexpr unsigned MISSES_OF_ITS_OWN = 2;
constexpr std::uint16_t MODBUS_EXCEPTIONS = 0x8000;

std::string refusalText(std::uint16_t error_id)
{
  const bool modbus = error_id >= MODBUS_EXCEPTIONS;
  return "answers " + (modbus ? "exception " + util::hexText(error_id & 0xFFU, 2) : util::hexText(error_id, 4)) +
         " to the status";
}

std::string share(const std::string& what, unsigned part, unsigned whole)
{
  return what + ": " + std::to_string(part) + " of " + std::to_string(whole);
}
}  // namespace

Liveness::Liveness(int offline_after, Duration shortest_silence)
  : offline_after_(offline_after), shortest_silence_(shortest_silence)
{
}

void Liveness::waitedBriefly(TimePoint sent_at)
{
  row_.brief_since = row_.brief_since ? row_.brief_since : std::optional<TimePoint>(sent_at);
}

bool Liveness::tooSoon(TimePoint now) const
{
  return row_.brief_since && now - *row_.brief_since < shortest_silence_;
}

bool Liveness::lost(bool write)
{
  row_.read_failed = row_.read_failed || !write;
  return ++row_.failures >= offline_after_ && row_.read_failed;
}

bool Liveness::refused()
{
  return lost(false);
}

void Liveness::dataRead()
{
  row_ = Row();
}

bool Liveness::needsRead() const
{
  return row_.failures >= offline_after_ && !row_.read_failed;
}

void Liveness::watchFrom(TimePoint time)
{
  since_ = std::max(since_, time);
}

void Liveness::deafUntil(TimePoint time)
{
  deaf_until_ = time;
  silent_until_ = time;
}

void Liveness::heard()
{
  silent_until_ = TimePoint();
}

bool Liveness::mayBeDeaf(TimePoint now) const
{
  return now < silent_until_;
}

void Liveness::notWatching(TimePoint now, Duration duration)
{
  since_ = std::min(now, since_ + duration);
}

void Liveness::complete(TimePoint now)
{
  since_ = now;
  reads_.clear();
  last_error_ = 0;
  refusal_ = 0;
  misses_ = 0;
  answers_some_ = false;
  heard();
  dataRead();
}

void Liveness::missed(std::uint16_t error_id)
{
  last_error_ = error_id;
  ++misses_;
}

bool Liveness::overdue(TimePoint now, Duration period) const
{
  const Duration patience = std::max(seconds(SHORTEST_PATIENCE_S), PERIODS_OF_PATIENCE * period);
  return misses_ >= MISSES_OF_ITS_OWN && now - since_ > patience && now > deaf_until_;
}

void Liveness::noteRead(Duration length, const wire::Reply& reply)
{
  Reads& reads = reads_[length];
  ++reads.asked;
  switch (reply.outcome)
  {
    case wire::Outcome::Ok:
      answers_some_ = last_error_ != 0;
      return;
    case wire::Outcome::Exception:
      ++reads.refused;
      refusal_ = reply.error_id;
      break;
    case wire::Outcome::Damaged:
      ++reads.damaged;
      break;
    default:
      ++reads.lost;
      break;
  }
  missed(reply.error_id);
}

bool Liveness::refusesForTheMoment() const
{
  constexpr std::uint16_t FIRST_MODBUS_EXCEPTION = 0x8000;
  constexpr unsigned LAST_LASTING_EXCEPTION = 0x03;
  const Reads all = since(Duration{ 0 });
  const bool refused = all.refused > 0 && all.lost == 0 && all.damaged == 0;
  return refused && refusal_ >= FIRST_MODBUS_EXCEPTION && (refusal_ & 0xFFU) > LAST_LASTING_EXCEPTION;
}

/// Of all reads that are at least so long.
Liveness::Reads Liveness::since(Duration length) const
{
  Reads sum;
  for (auto entry = reads_.lower_bound(length); entry != reads_.end(); ++entry)
  {
    sum.asked += entry->second.asked;
    sum.lost += entry->second.lost;
    sum.damaged += entry->second.damaged;
    sum.refused += entry->second.refused;
  }
  return sum;
}

std::string Liveness::reason() const
{
  const auto failing = [](const auto& entry) { return entry.second.lost + entry.second.damaged > 0; };
  const auto shortest = std::find_if(reads_.begin(), reads_.end(), failing);
  const Reads all = since(Duration::zero());
  if (all.refused > 0 && all.refused >= all.lost + all.damaged)
  {
    return refusalText(refusal_);
  }
  const bool nothing_but_silence = !answers_some_ && all.damaged == 0;
  if (shortest == reads_.end() || nothing_but_silence)
  {
    return "";
  }
  // Only what is long gets lost: a bad line, or a gateway's or converter's buffer.
  const bool only_long = shortest != reads_.begin();
  const Reads some = since(shortest->first);
  const std::string which = only_long ? "long replies" : "replies to the status";
  return some.damaged >= some.lost ? share("damaged " + which, some.damaged, some.asked)
                                   : share("no " + which, some.lost, some.asked);
}

std::uint16_t Liveness::lastError() const
{
  return last_error_;
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/slow_turns.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
// What decides safety is read again in the refresh for whose status it would be too old.
constexpr double GUARD_PERIOD_S = 0.9;
constexpr const char* WARNING = "warning_code";

/// In order, beginning with the first that is not before \p cursor.
std::vector<std::size_t> fromCursor(std::vector<std::size_t> indices, std::size_t cursor)
{
  const auto begin = std::find_if(indices.begin(), indices.end(), [&](std::size_t index) { return index >= cursor; });
  std::rotate(indices.begin(), begin, indices.end());
  return indices;
}
}  // namespace

void SlowTurns::askForRun()
{
  run_heard_ = false;
}

void SlowTurns::suspectRestart()
{
  restart_suspected_ = true;
}

void SlowTurns::noteRestart(const drive::Monitor& words)
{
  restart_suspected_ = restart_suspected_ && !words.restarted;
}

void SlowTurns::noteRun(const drive::Monitor& words, bool tells_run)
{
  run_heard_ = run_heard_ || words.run_seen.has_value() || !tells_run;
}

void SlowTurns::askForWarning()
{
  warning_asked_ = true;
}

void SlowTurns::noteWarning(const StatusRead& read)
{
  warning_asked_ = warning_asked_ && !read.brings(WARNING);
}

bool SlowTurns::asksForWarning(const StatusReads& reads, TimePoint now) const
{
  const std::vector<std::size_t> open =
      warning_asked_ ? reads.open(StatusRead::Kind::Slow, now) : std::vector<std::size_t>();
  return std::any_of(open.begin(), open.end(),
                     [&](std::size_t index) { return reads[index].isSlowed() && reads[index].brings(WARNING); });
}

void SlowTurns::forget()
{
  run_heard_ = false;
  restart_suspected_ = false;
  warning_asked_ = false;
  restart();
}

void SlowTurns::restart()
{
  cursor_ = 0;
  guard_cursor_ = 0;
}

bool SlowTurns::goesFirst(const StatusRead& read) const
{
  return (!run_heard_ && read.brings("run_seen")) || (restart_suspected_ && read.brings("restarted"));
}

bool SlowTurns::waitedFor(const StatusRead& read) const
{
  return !run_heard_ && read.brings("run_seen");
}

std::vector<std::size_t> SlowTurns::take(const StatusReads& reads, TimePoint now, bool first, const SlowLeave& leave)
{
  std::vector<std::size_t> taken = reads.open(StatusRead::Kind::Slow, now);
  taken.erase(std::remove_if(taken.begin(), taken.end(), [&](std::size_t index) { return !goesFirst(reads[index]); }),
              taken.end());
  if (!taken.empty() || first)
  {
    return taken;
  }
  for (const auto& one : { takeGuard(reads, now), takeSlowed(reads, now, leave) })
  {
    if (one)
    {
      taken.push_back(*one);
    }
  }
  return taken;
}

/// One of those that are never slowed.
std::optional<std::size_t> SlowTurns::takeGuard(const StatusReads& reads, TimePoint now)
{
  for (const std::size_t index : fromCursor(reads.open(StatusRead::Kind::Slow, now), guard_cursor_))
  {
    const bool due = !reads[index].ever || now - reads[index].last >= seconds(GUARD_PERIOD_S);
    if (due && !reads[index].isSlowed())
    {
      guard_cursor_ = index + 1;
      return index;
    }
  }
  return std::nullopt;
}

std::optional<std::size_t> SlowTurns::takeSlowed(const StatusReads& reads, TimePoint now, const SlowLeave& leave)
{
  if (!leave.open || leave.period <= Duration{ 0 })
  {
    return std::nullopt;
  }
  const bool warning = asksForWarning(reads, now);
  for (const std::size_t index : fromCursor(reads.open(StatusRead::Kind::Slow, now), cursor_))
  {
    const StatusRead& read = reads[index];
    const bool due = !read.ever || now - read.last >= leave.period;
    if (read.isSlowed() && (warning ? read.brings(WARNING) : due))
    {
      cursor_ = index + 1;
      return index;
    }
  }
  return std::nullopt;
}
}  // namespace bus
}  // namespace inverter_bus

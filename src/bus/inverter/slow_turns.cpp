// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/slow_turns.h"

#include <algorithm>
#include <iterator>

namespace inverter_bus
{
namespace bus
{
namespace
{
// A slow value is read again in the refresh whose status it would be too old for; one goes per refresh, so they stagger.
constexpr double SLOW_MARGIN_S = 0.1;
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

void SlowTurns::forget()
{
  run_heard_ = false;
  restart_suspected_ = false;
  restart();
}

void SlowTurns::restart()
{
  cursor_ = 0;
}

bool SlowTurns::goesFirst(const StatusRead& read) const
{
  return (!run_heard_ && read.brings("run_seen")) || (restart_suspected_ && read.brings("restarted"));
}

bool SlowTurns::waitedFor(const StatusRead& read) const
{
  return !run_heard_ && read.brings("run_seen");
}

std::vector<std::size_t> SlowTurns::take(const StatusReads& reads, TimePoint now, bool first)
{
  std::vector<std::size_t> open = reads.open(StatusRead::Kind::Slow, now);
  const auto begin = std::find_if(open.begin(), open.end(), [this](std::size_t index) { return index >= cursor_; });
  std::rotate(open.begin(), begin, open.end());
  std::vector<std::size_t> taken;
  std::copy_if(open.begin(), open.end(), std::back_inserter(taken),
               [&](std::size_t index) { return goesFirst(reads[index]); });
  const Duration due_age = seconds(OLDEST_SLOW_VALUE_S - SLOW_MARGIN_S);
  const auto due = std::find_if(open.begin(), open.end(), [&](std::size_t index) {
    return !reads[index].ever || now - reads[index].last >= due_age;
  });
  if (taken.empty() && !first && due != open.end())
  {
    taken.push_back(*due);
  }
  cursor_ = taken.empty() ? cursor_ : taken.back() + 1;
  return taken;
}
}  // namespace bus
}  // namespace inverter_bus

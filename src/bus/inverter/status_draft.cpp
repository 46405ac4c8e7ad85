// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/status_draft.h"

#include <algorithm>

#include "bus/inverter/merge_monitor.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// Between the first request of a status and its last reply: a motor starts or stops in that time.
constexpr double LONG_READING_S = 0.5;
}  // namespace

void StatusDraft::restart()
{
  const bool read_again = read_again_;
  *this = StatusDraft();
  read_again_ = read_again;
  words_.sent_at = TimePoint::max();
}

void StatusDraft::take(const StatusRead& read, const wire::Reply& reply)
{
  const bool fast = read.kind == StatusRead::Kind::Fast;
  if (read.kind != StatusRead::Kind::Slow)
  {
    mergeMonitor(read.values, words_.monitor);
  }
  // What decides safety counts in the refresh that brought it, whether or not it is read in every one.
  drive::Monitor signs;
  signs.run_seen = read.values.run_seen;
  signs.restarted = read.values.restarted;
  mergeMonitor(signs, words_.monitor);
  if (read.values.run_seen || (fast && (read.values.operation || read.values.running)))
  {
    words_.sent_at = std::min(words_.sent_at, reply.sent_at);
  }
  run_read_ = run_read_ || read.tellsRun();
  stamp_ = fast ? std::optional<TimePoint>(reply.finished_at) : stamp_;
}

void StatusDraft::heard(TimePoint at)
{
  stamp_ = at;
}

void StatusDraft::restartNoted()
{
  words_.monitor.restarted.reset();
}

bool StatusDraft::takeFaultDue()
{
  const bool due = words_.monitor.tripped().value_or(false) && !fault_asked_;
  fault_asked_ = fault_asked_ || due;
  return due;
}

void StatusDraft::lost()
{
  lost_ = true;
}

bool StatusDraft::takeTooOld()
{
  const bool old = stamp_ && *stamp_ - words_.sent_at > seconds(LONG_READING_S);
  read_again_ = lost_ && old && !read_again_;
  return read_again_;
}

const StatusWords& StatusDraft::words() const
{
  return words_;
}

bool StatusDraft::suffices(bool run_needed) const
{
  return stamp_ && (run_read_ || !run_needed);
}

const std::optional<TimePoint>& StatusDraft::stamp() const
{
  return stamp_;
}
}  // namespace bus
}  // namespace inverter_bus

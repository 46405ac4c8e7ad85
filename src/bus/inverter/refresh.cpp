// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/refresh.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// A value that the drive refuses is asked for again after this time (a parameter lock may have been lifted).
constexpr double LEFT_OUT_S = 30.0;
constexpr double POSTPONED_S = 0.5;
constexpr std::uint8_t NO_SUCH_ADDRESS = 0x02;

/// The drive does not have some number in the read, and never will.
bool isHole(const wire::Reply& reply)
{
  return reply.pdu.size() > 1 && reply.pdu[1] == NO_SUCH_ADDRESS;
}

/// There is reason to expect that the drive's warning word has changed.
bool warns(const drive::Monitor& before, const drive::Monitor& now)
{
  const auto changed = [](const std::optional<bool>& one, const std::optional<bool>& other) {
    return one && other && *one != *other;
  };
  return changed(before.overload_warning, now.overload_warning) || changed(before.tripped(), now.tripped());
}

/// The refresh under way starts again.
bool backToDirectReads(Refresh& refresh, ChosenBlock& chosen)
{
  refresh.useBlock(std::nullopt);
  chosen.drop();
  return true;
}

/// The same from the register map.
bool backToPlainReads(std::vector<std::size_t>& plan, MappedReads& mapped, StatusReads& reads)
{
  plan.clear();
  mapped.drop();
  reads.change(std::nullopt, {});
  return true;
}
}  // namespace

Refresh::Refresh(const drive::Drive& drive) : drive_(drive), reads_(drive), chosen_(drive)
{
}

void Refresh::setRatings(const drive::Ratings& ratings)
{
  ratings_ = ratings;
}

void Refresh::useBlock(const std::optional<drive::ReadBlock>& block)
{
  if (chosen_.use(block))
  {
    plan_.clear();
    reads_.build(block);
    slow_.restart();
  }
}

const ChosenBlock& Refresh::chosen() const
{
  return chosen_;
}

ChosenBlock& Refresh::chosen()
{
  return chosen_;
}

void Refresh::useMap(const std::function<MapOrders()>& orders)
{
  if (plan_.empty() && mapped_.take(orders()))
  {
    reads_.change(mapped_.orders().read, mapped_.orders().proof);
    slow_.restart();
  }
}

MappedReads& Refresh::mapped()
{
  return mapped_;
}

void Refresh::plan(TimePoint now, const SlowLeave& leave)
{
  draft_.restart();
  reads_.planPeriod(leave.period);
  plan_ = slow_.take(reads_, now, !last_.stamp, leave);
  const std::vector<std::size_t> fast = reads_.open(StatusRead::Kind::Fast, now);
  plan_.insert(plan_.end(), fast.begin(), fast.end());
  const std::vector<std::size_t> proof = reads_.open(StatusRead::Kind::Proof, now);
  plan_.insert(plan_.end(), proof.begin(), proof.end());
  if (plan_.empty())
  {
    // Everything is refused: keep asking for something, so that the inverter's return to health is seen.
    plan_.push_back(reads_.size() - 1);
  }
}

bool Refresh::takeRefusal()
{
  const bool refused = run_refused_;
  run_refused_ = false;
  return refused;
}

const StatusRead& Refresh::asked() const
{
  return reads_[plan_.front()];
}

const drive::ReadBlock& Refresh::next(TimePoint now, const SlowLeave& leave)
{
  asked_at_ = now;
  if (plan_.empty())
  {
    plan(now, leave);
  }
  return asked().block;
}

bool Refresh::advance()
{
  plan_.erase(plan_.begin());
  if (plan_.empty() && draft_.takeFaultDue())
  {
    plan_ = reads_.open(StatusRead::Kind::Fault, asked_at_);
  }
  if (!plan_.empty())
  {
    return true;
  }
  if (!draft_.suffices(reads_.tellRun()))
  {
    // Every read was refused, or every one that shows whether the motor runs: that is no status.
    return false;
  }
  if (draft_.takeTooOld())
  {
    plan_.clear();
    return true;
  }
  if (warns(last_.words.monitor, draft_.words().monitor))
  {
    slow_.askForWarning();
  }
  last_.words = draft_.words();
  if (!last_.words.monitor.tripped().value_or(true) && drive_.reports("fault_code"))
  {
    last_.words.monitor.fault_code = 0;
  }
  slow_.noteRun(last_.words.monitor, drive_.reports("run_seen"));
  // Only now: a stamp belongs to a whole status, not to half of a new one beside half of an old one.
  last_.stamp = draft_.stamp();
  complete_ = true;
  return false;
}

bool Refresh::received(const wire::Reply& reply)
{
  StatusRead& read = reads_[plan_.front()];
  if (read.kind == StatusRead::Kind::Proof)
  {
    drive::Monitor values;
    drive_.decode(read.block, reply.pdu, values, ratings_);
    mapped_.compare(!read.block.mirrors.empty(), values, draft_.words().monitor);
    return advance();
  }
  if (!read.block.chosen.empty() && !chosen_.received(reply, ratings_, last_.words.monitor))
  {
    return backToDirectReads(*this, chosen_);
  }
  read.values = drive::Monitor();
  drive_.decode(read.block, reply.pdu, read.values, ratings_);
  if (!read.block.mirrors.empty() && !mapped_.accepts(read.values))
  {
    return backToPlainReads(plan_, mapped_, reads_);
  }
  read.period = read.ever ? reply.finished_at - read.last : Duration{ 0 };
  read.took = reply.finished_at - reply.sent_at;
  read.last = reply.finished_at;
  read.ever = true;
  slow_.noteRestart(read.values);
  slow_.noteWarning(read);
  draft_.take(read, reply);
  return advance();
}

bool Refresh::refused(const wire::Reply& reply)
{
  if (!asked().block.mirrors.empty())
  {
    mapped_.refused();
    if (asked().kind != StatusRead::Kind::Proof)
    {
      return backToPlainReads(plan_, mapped_, reads_);
    }
    // The status of this refresh is there already.
    plan_.resize(1);
    return advance();
  }
  const bool lasting = isLastingRefusal(reply);
  if (!asked().block.chosen.empty() && chosen_.refused(lasting))
  {
    return backToDirectReads(*this, chosen_);
  }
  if (!lasting)
  {
    // Busy, or locked for the moment: nothing is known, and nothing follows for later refreshes.
    return postpone();
  }
  if (asked().block.fields.empty())
  {
    // A keep-alive that is refused was heard all the same.
    draft_.heard(reply.finished_at);
    return advance();
  }
  if (reads_.split(plan_.front(), isHole(reply)))
  {
    // The plan's numbers moved: this refresh starts again with the smaller reads.
    plan_.clear();
    return true;
  }
  // A value that the drive refuses is not asked for for a while, unless it was the last one that shows whether the motor
  // runs.
  StatusRead& read = reads_[plan_.front()];
  read.values = drive::Monitor();
  if (read.tellsRun() && !reads_.othersTellRun(plan_.front(), reply.finished_at))
  {
    run_refused_ = true;
    failed();
    return false;
  }
  read.left_out_until = reply.finished_at + seconds(LEFT_OUT_S);
  return advance();
}

bool Refresh::skipSlow()
{
  const StatusRead& read = asked();
  const bool last = plan_.size() < 2;
  return read.kind == StatusRead::Kind::Slow && !slow_.waitedFor(read) && !last && postpone();
}

/// The current read fails for now. If it is a slow one, the refresh goes on; if it is a fast one, the refresh has no
/// result.
bool Refresh::postpone()
{
  StatusRead& read = reads_[plan_.front()];
  if (read.kind != StatusRead::Kind::Slow)
  {
    run_refused_ = read.tellsRun();
    failed();
    return false;
  }
  read.left_out_until = asked_at_ + seconds(POSTPONED_S);
  return advance();
}

void Refresh::failed()
{
  // A slow read that got lost must not come before the run words of the next refresh again.
  if (!plan_.empty() && asked().kind == StatusRead::Kind::Slow)
  {
    reads_[plan_.front()].left_out_until = asked_at_ + seconds(POSTPONED_S);
  }
  plan_.clear();
}

bool Refresh::takeComplete()
{
  const bool complete = complete_;
  complete_ = false;
  return complete;
}

drive::Monitor Refresh::monitor(TimePoint now) const
{
  drive::Monitor monitor = last_.words.monitor;
  reads_.addSlowValues(now, monitor);
  return monitor;
}

const StatusWords& Refresh::fresh() const
{
  return last_.words;
}

bool Refresh::asksForWarning(TimePoint now) const
{
  return slow_.asksForWarning(reads_, now);
}

StatusDraft& Refresh::draft()
{
  return draft_;
}

SlowTurns& Refresh::slow()
{
  return slow_;
}

const std::optional<TimePoint>& Refresh::stamp() const
{
  return last_.stamp;
}

void Refresh::forget()
{
  plan_.clear();
  last_.words.monitor = drive::Monitor();
  complete_ = false;
  slow_.forget();
  chosen_.forget();
  mapped_.forget();
  // Reads that were left out, or split for another reason than a hole, are tried in full again.
  reads_.forget();
}

const StatusReads& Refresh::reads() const
{
  return reads_;
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/refresh.h"

#include <algorithm>
#include <tuple>

#include "drive/monitor_fields.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double OLDEST_SLOW_VALUE_S = 1.0;
// A slow value is read again in the refresh whose status it would be too old for; one goes per refresh, so they stagger.
constexpr double SLOW_MARGIN_S = 0.1;
// A value that the drive refuses is asked for again after this time (a parameter lock may have been lifted).
constexpr double LEFT_OUT_S = 30.0;
constexpr double POSTPONED_S = 0.5;

template <typename T>
void take(const std::optional<T>& from, std::optional<T>& to)
{
  if (from)
  {
    to = from;
  }
}

template <typename... Field>
void takeEach(const std::tuple<const Field&...>& from, const std::tuple<Field&...>& to)
{
  std::apply([&to](const auto&... value) { std::apply([&](auto&... kept) { (take(value, kept), ...); }, to); }, from);
}

unsigned lastAddress(const drive::Item& item)
{
  return item.address + item.size - 1U;
}

bool carries(const drive::ReadBlock& block, const char* field)
{
  return std::find(block.fields.begin(), block.fields.end(), field) != block.fields.end();
}
}  // namespace

void mergeMonitor(const drive::Monitor& from, drive::Monitor& to)
{
  takeEach(drive::monitorFields(from), drive::monitorFields(to));
}

std::vector<drive::ReadBlock> splitBlock(const drive::Drive& drive, const drive::ReadBlock& block)
{
  std::vector<std::string> fields = block.fields;
  const auto& items = drive.profile().status;
  // A packed word (raw_status) that spans the others can't be split; it is left out.
  fields.erase(std::remove_if(fields.begin(), fields.end(),
                              [&](const std::string& field) {
                                return fields.size() > 1 && items.at(field).size == block.count && block.count > 2;
                              }),
               fields.end());
  std::sort(fields.begin(), fields.end(), [&](const std::string& left, const std::string& right) {
    return items.at(left).address < items.at(right).address;
  });
  std::size_t cut = 0;
  unsigned widest = 0;
  for (std::size_t index = 1; index < fields.size(); ++index)
  {
    const unsigned gap = items.at(fields[index]).address - lastAddress(items.at(fields[index - 1]));
    if (gap > widest)
    {
      widest = gap;
      cut = index;
    }
  }
  if (cut == 0)
  {
    return { block };
  }
  const auto middle = fields.begin() + static_cast<std::ptrdiff_t>(cut);
  return { drive.blockOf({ fields.begin(), middle }), drive.blockOf({ middle, fields.end() }) };
}

Refresh::Refresh(const drive::Drive& drive, std::uint8_t station) : drive_(drive), station_(station)
{
  buildBlocks();
}

void Refresh::buildBlocks()
{
  blocks_.clear();
  slow_cursor_ = 0;
  const auto add = [&](const std::vector<drive::ReadBlock>& reads, Class kind) {
    for (const drive::ReadBlock& read : reads)
    {
      Block block;
      block.read = read;
      block.kind = kind;
      blocks_.push_back(block);
    }
  };
  add(block_ ? drive_.slowBlocksBeside(*block_) : drive_.slowBlocks(), Class::Slow);
  add(drive_.faultBlocks(), Class::Fault);
  // Last, so that the stamp belongs to the values that matter.
  add(block_ ? drive_.fastBlocksBeside(*block_) : drive_.fastBlocks(), Class::Fast);
  if (block_)
  {
    add({ *block_ }, Class::Fast);
  }
}

void Refresh::setRatings(const drive::Ratings& ratings)
{
  ratings_ = ratings;
}

void Refresh::useBlock(const std::optional<drive::ReadBlock>& block)
{
  const bool same = block.has_value() == block_.has_value() && (!block || block->chosen == block_->chosen);
  if (same)
  {
    return;
  }
  failed();
  block_ = block;
  block_proven_ = false;
  block_refusals_ = 0;
  chosen_values_.clear();
  buildBlocks();
}

bool Refresh::takeBlockRefusal()
{
  const bool refused = block_refused_;
  block_refused_ = false;
  return refused;
}

const std::optional<drive::ReadBlock>& Refresh::block() const
{
  return block_;
}

const std::vector<std::pair<std::string, std::string>>& Refresh::chosenValues() const
{
  return chosen_values_;
}

/// Back to direct reads; the refresh under way starts again.
bool Refresh::dropBlock()
{
  useBlock(std::nullopt);
  block_refused_ = true;
  return true;
}

/// Slots that were changed but don't count yet bring other words, or zeros. The status word must be what the direct read
/// before it was; a drive that changes its state just then is read directly until its next return, which costs little.
bool Refresh::isChosenWord(const Block& block, const wire::Reply& reply) const
{
  drive::Monitor values;
  drive_.decode(block.read, reply.pdu, values, ratings_);
  return !values.raw_status || !fresh_.raw_status || *values.raw_status == *fresh_.raw_status;
}

void Refresh::plan(TimePoint now)
{
  plan_.clear();
  position_ = 0;
  fault_planned_ = false;
  run_read_ = false;
  scratch_ = drive::Monitor();
  scratch_sent_at_ = TimePoint::max();
  scratch_stamp_ = TimePoint();
  planSlow(now);
  for (std::size_t index = 0; index < blocks_.size(); ++index)
  {
    const Block& block = blocks_[index];
    if (block.kind == Class::Fast && now >= block.left_out_until)
    {
      plan_.push_back(index);
    }
  }
  if (plan_.empty())
  {
    // Everything is refused: keep asking for something, so that the inverter's return to health is seen.
    plan_.push_back(blocks_.size() - 1);
  }
}

/// What a leftover RUN or a restart can be told from, after a return or a lost exchange.
bool Refresh::goesFirst(const Block& block) const
{
  const bool run = !run_heard_ && carries(block.read, "run_seen");
  const bool restart = restart_suspected_ && carries(block.read, "restarted");
  return block.kind == Class::Slow && (run || restart);
}

/// At most one slow read that is due, or those that go first.
void Refresh::planSlow(TimePoint now)
{
  const auto now_first = [&](const Block& block) { return goesFirst(block) && now >= block.left_out_until; };
  const bool some_first = std::any_of(blocks_.begin(), blocks_.end(), now_first);
  const Duration due_age = seconds(OLDEST_SLOW_VALUE_S - SLOW_MARGIN_S);
  bool planned = false;
  for (std::size_t step = 0; step < blocks_.size(); ++step)
  {
    const std::size_t index = (slow_cursor_ + step) % blocks_.size();
    Block& block = blocks_[index];
    if (block.kind != Class::Slow || now < block.left_out_until)
    {
      continue;
    }
    const bool due = !block.ever || now - block.last >= due_age;
    if (some_first ? now_first(block) : has_stamp_ && !planned && due)
    {
      plan_.push_back(index);
      planned = true;
      slow_cursor_ = index + 1;
    }
  }
}

bool Refresh::takeRefusal()
{
  const bool refused = run_refused_;
  run_refused_ = false;
  return refused;
}

/// Whether the motor runs stands in it: without such a word there is no status (contract, 8.15).
bool Refresh::tellsRun(const Block& block) const
{
  return block.kind == Class::Fast &&
         (carries(block.read, "run_seen") || carries(block.read, "operation") || carries(block.read, "running"));
}

const drive::ReadBlock& Refresh::next(TimePoint now)
{
  asked_at_ = now;
  if (position_ >= plan_.size())
  {
    plan(now);
  }
  return blocks_[plan_[position_]].read;
}

void Refresh::planFaultReads()
{
  fault_planned_ = true;
  for (std::size_t index = 0; index < blocks_.size(); ++index)
  {
    if (blocks_[index].kind == Class::Fault && asked_at_ >= blocks_[index].left_out_until)
    {
      plan_.push_back(index);
    }
  }
}

bool Refresh::advance()
{
  ++position_;
  if (position_ == plan_.size() && scratch_.tripped().value_or(false) && !fault_planned_)
  {
    // The reason of a trip belongs into the first status that shows it.
    planFaultReads();
  }
  if (position_ < plan_.size())
  {
    return true;
  }
  const bool tells_run =
      std::any_of(blocks_.begin(), blocks_.end(), [this](const Block& block) { return tellsRun(block); });
  if (scratch_stamp_ == TimePoint() || (tells_run && !run_read_))
  {
    // Every read was refused, or every one that tells whether the motor runs: that is no status.
    failed();
    return false;
  }
  if (!scratch_.tripped().value_or(true) && drive_.reports("fault_code"))
  {
    scratch_.fault_code = 0;
  }
  plan_.clear();
  position_ = 0;
  run_heard_ = run_heard_ || scratch_.run_seen.has_value() || !drive_.reports("run_seen");
  fresh_ = scratch_;
  fresh_sent_at_ = scratch_sent_at_;
  // Only now: a stamp belongs to a whole status, not to half of a new one beside half of an old one.
  stamp_ = scratch_stamp_;
  has_stamp_ = true;
  complete_ = true;
  return false;
}

bool Refresh::received(const wire::Reply& reply)
{
  Block& block = blocks_[plan_[position_]];
  if (!block.read.chosen.empty())
  {
    if (!block_proven_ && !isChosenWord(block, reply))
    {
      return dropBlock();
    }
    block_proven_ = true;
    block_refusals_ = 0;
    chosen_values_ = drive_.chosenValues(block.read, reply.pdu, ratings_);
  }
  block.values = drive::Monitor();
  drive_.decode(block.read, reply.pdu, block.values, ratings_);
  block.last = reply.finished_at;
  block.ever = true;
  takeRunWords(block, reply);
  run_read_ = run_read_ || tellsRun(block);
  if (block.kind == Class::Fast)
  {
    scratch_stamp_ = reply.finished_at;
  }
  return advance();
}

/// What decides over safety counts in the refresh that brought it, whether it is read in every one or not.
void Refresh::takeRunWords(const Block& block, const wire::Reply& reply)
{
  if (block.kind != Class::Slow)
  {
    mergeMonitor(block.values, scratch_);
  }
  take(block.values.run_seen, scratch_.run_seen);
  take(block.values.restarted, scratch_.restarted);
  restart_suspected_ = restart_suspected_ && !block.values.restarted;
  const bool fast = block.kind == Class::Fast && (block.values.operation || block.values.running);
  if (block.values.run_seen || fast)
  {
    scratch_sent_at_ = std::min(scratch_sent_at_, reply.sent_at);
  }
}

bool Refresh::refused(const wire::Reply& reply)
{
  constexpr unsigned MOST_BLOCK_REFUSALS = 2;
  const bool chosen = !blocks_[plan_[position_]].read.chosen.empty();
  if (chosen && ++block_refusals_ >= MOST_BLOCK_REFUSALS)
  {
    return dropBlock();
  }
  if (!isLastingRefusal(reply))
  {
    // Busy, or locked for the moment: nothing is known, and nothing follows for later refreshes.
    return postpone();
  }
  const std::size_t index = plan_[position_];
  if (!blocks_[index].read.chosen.empty())
  {
    return dropBlock();
  }
  if (blocks_[index].read.fields.empty())
  {
    // A keep-alive that is refused was heard all the same.
    scratch_stamp_ = reply.finished_at;
    return advance();
  }
  const std::vector<drive::ReadBlock> halves = splitBlock(drive_, blocks_[index].read);
  if (halves.size() < 2)
  {
    return leaveOut(index, reply);
  }
  Block second = blocks_[index];
  second.read = halves[1];
  blocks_[index].read = halves[0];
  blocks_.insert(blocks_.begin() + static_cast<std::ptrdiff_t>(index) + 1, second);
  // The plan's indices moved: this refresh starts again with the smaller reads.
  plan_.clear();
  position_ = 0;
  return true;
}

/// A value that the drive refuses is not asked for for a while, unless it was the last one that tells whether the motor runs.
bool Refresh::leaveOut(std::size_t index, const wire::Reply& reply)
{
  Block& block = blocks_[index];
  block.values = drive::Monitor();
  const bool another = std::any_of(blocks_.begin(), blocks_.end(), [&](const Block& other) {
    return &other != &block && tellsRun(other) && reply.finished_at >= other.left_out_until;
  });
  if (tellsRun(block) && !another)
  {
    run_refused_ = true;
    failed();
    return false;
  }
  block.left_out_until = reply.finished_at + seconds(LEFT_OUT_S);
  return advance();
}

bool Refresh::skipSlow()
{
  const Block& block = blocks_[plan_[position_]];
  // The first word of a leftover RUN is waited for.
  const bool waited_for = !run_heard_ && carries(block.read, "run_seen");
  const bool last = position_ + 1 >= plan_.size();
  return block.kind == Class::Slow && !waited_for && !last && postpone();
}

/// The read at hand is not to be had now. Without a slow one the refresh goes on, without a fast one it has no result.
bool Refresh::postpone()
{
  Block& block = blocks_[plan_[position_]];
  if (block.kind != Class::Slow)
  {
    run_refused_ = tellsRun(block);
    failed();
    return false;
  }
  block.left_out_until = asked_at_ + seconds(POSTPONED_S);
  return advance();
}

void Refresh::failed()
{
  // A slow read that gets lost must not stand before the run words of the next refresh again.
  if (position_ < plan_.size() && blocks_[plan_[position_]].kind == Class::Slow)
  {
    blocks_[plan_[position_]].left_out_until = asked_at_ + seconds(POSTPONED_S);
  }
  plan_.clear();
  position_ = 0;
}

bool Refresh::takeComplete()
{
  const bool complete = complete_;
  complete_ = false;
  return complete;
}

drive::Monitor Refresh::monitor(TimePoint now) const
{
  drive::Monitor monitor = fresh_;
  for (const Block& block : blocks_)
  {
    if (block.kind == Class::Slow && block.ever && now - block.last <= seconds(OLDEST_SLOW_VALUE_S))
    {
      mergeMonitor(block.values, monitor);
    }
  }
  return monitor;
}

const drive::Monitor& Refresh::fresh() const
{
  return fresh_;
}

TimePoint Refresh::freshSentAt() const
{
  return fresh_sent_at_;
}

const drive::Monitor& Refresh::words() const
{
  return scratch_;
}

void Refresh::restartNoted()
{
  scratch_.restarted.reset();
}

void Refresh::suspectRestart()
{
  restart_suspected_ = true;
}

void Refresh::askForRun()
{
  run_heard_ = false;
}

TimePoint Refresh::wordsSentAt() const
{
  return scratch_sent_at_;
}

TimePoint Refresh::stamp() const
{
  return stamp_;
}

bool Refresh::hasStamp() const
{
  return has_stamp_;
}

void Refresh::forget()
{
  failed();
  fresh_ = drive::Monitor();
  complete_ = false;
  run_heard_ = false;
  restart_suspected_ = false;
  block_.reset();
  chosen_values_.clear();
  // Reads that were split or left out are tried in full again.
  buildBlocks();
}

std::vector<drive::ReadBlock> Refresh::fastBlocks() const
{
  std::vector<drive::ReadBlock> reads;
  for (const Block& block : blocks_)
  {
    if (block.kind == Class::Fast)
    {
      reads.push_back(block.read);
    }
  }
  return reads;
}

std::vector<drive::ReadBlock> Refresh::slowBlocks() const
{
  std::vector<drive::ReadBlock> reads;
  for (const Block& block : blocks_)
  {
    if (block.kind == Class::Slow)
    {
      reads.push_back(block.read);
    }
  }
  return reads;
}
}  // namespace bus
}  // namespace inverter_bus

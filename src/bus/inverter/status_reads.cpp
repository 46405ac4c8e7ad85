// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/status_reads.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bus/inverter/merge_monitor.h"
#include "bus/rules/slow_share.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, 8.3: a slow value is shown until it is older than so many of its periods, and for so long in any case.
constexpr double OLDEST_SLOW_VALUE_PERIODS = 2.5;
constexpr double OLDEST_SLOW_VALUE_S = 10.0;
// What decides safety is never slowed, and is dropped sooner.
constexpr double OLDEST_GUARD_S = 1.0;

bool isSame(const drive::ReadBlock& one, const drive::ReadBlock& other)
{
  return one.space == other.space && one.area == other.area && one.number == other.number && one.count == other.count &&
         one.fields == other.fields && one.chosen == other.chosen;
}

unsigned lastAddress(const drive::Item& item)
{
  return item.address + item.size - 1U;
}
}  // namespace

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

bool StatusRead::brings(const char* field) const
{
  return std::find(block.fields.begin(), block.fields.end(), field) != block.fields.end();
}

bool StatusRead::tellsRun() const
{
  return kind == Kind::Fast && (brings("run_seen") || brings("operation") || brings("running"));
}

bool StatusRead::isSlowed() const
{
  return kind == Kind::Slow && bus::isSlowed(block);
}

StatusReads::StatusReads(const drive::Drive& drive) : drive_(drive)
{
  build(std::nullopt);
}

void StatusReads::build(const std::optional<drive::ReadBlock>& chosen)
{
  std::vector<StatusRead> before = std::move(reads_);
  before.insert(before.end(), shelved_.begin(), shelved_.end());
  reads_.clear();
  add(chosen ? drive_.slowBlocksBeside(*chosen) : drive_.slowBlocks(), StatusRead::Kind::Slow);
  add(drive_.faultBlocks(), StatusRead::Kind::Fault);
  add(chosen ? drive_.fastBlocksBeside(*chosen) : drive_.fastBlocks(), StatusRead::Kind::Fast);
  if (chosen)
  {
    add({ *chosen }, StatusRead::Kind::Fast);
  }
  for (std::size_t index = 0; index < reads_.size(); ++index)
  {
    while (holes_.count({ reads_[index].block.address, reads_[index].block.count }) != 0 && halve(index))
    {
    }
  }
  for (StatusRead& read : reads_)
  {
    const auto same = std::find_if(before.begin(), before.end(), [&](const StatusRead& old) {
      return old.kind == read.kind && isSame(old.block, read.block);
    });
    if (same != before.end())
    {
      read = *same;
      read.left_out_until = TimePoint();
      before.erase(same);
    }
  }
  shelved_ = std::move(before);
}

void StatusReads::change(const std::optional<drive::ReadBlock>& chosen, const std::vector<drive::ReadBlock>& proof)
{
  build(chosen);
  add(proof, StatusRead::Kind::Proof);
}

void StatusReads::forget()
{
  reads_.clear();
  shelved_.clear();
  build(std::nullopt);
}

void StatusReads::add(const std::vector<drive::ReadBlock>& blocks, StatusRead::Kind kind)
{
  for (const drive::ReadBlock& block : blocks)
  {
    StatusRead read;
    read.block = block;
    read.kind = kind;
    reads_.push_back(read);
  }
}

bool StatusReads::split(std::size_t index, bool for_good)
{
  const auto whole = std::make_pair(reads_[index].block.address, reads_[index].block.count);
  const bool halved = halve(index);
  if (halved && for_good)
  {
    holes_.insert(whole);
  }
  return halved;
}

bool StatusReads::halve(std::size_t index)
{
  const std::vector<drive::ReadBlock> halves = splitBlock(drive_, reads_[index].block);
  if (halves.size() < 2)
  {
    return false;
  }
  StatusRead second = reads_[index];
  second.block = halves[1];
  reads_[index].block = halves[0];
  reads_.insert(reads_.begin() + static_cast<std::ptrdiff_t>(index) + 1, second);
  return true;
}

std::size_t StatusReads::size() const
{
  return reads_.size();
}

StatusRead& StatusReads::operator[](std::size_t index)
{
  return reads_[index];
}

const StatusRead& StatusReads::operator[](std::size_t index) const
{
  return reads_[index];
}

std::vector<std::size_t> StatusReads::open(StatusRead::Kind kind, TimePoint now) const
{
  std::vector<std::size_t> found;
  for (std::size_t index = 0; index < reads_.size(); ++index)
  {
    if (reads_[index].kind == kind && now >= reads_[index].left_out_until)
    {
      found.push_back(index);
    }
  }
  return found;
}

bool StatusReads::tellRun() const
{
  return std::any_of(reads_.begin(), reads_.end(), [](const StatusRead& read) { return read.tellsRun(); });
}

bool StatusReads::othersTellRun(std::size_t index, TimePoint now) const
{
  return std::any_of(reads_.begin(), reads_.end(), [&](const StatusRead& other) {
    return &other != &reads_[index] && other.tellsRun() && now >= other.left_out_until;
  });
}

std::vector<drive::ReadBlock> StatusReads::blocks(StatusRead::Kind kind) const
{
  std::vector<drive::ReadBlock> found;
  for (const StatusRead& read : reads_)
  {
    if (read.kind == kind)
    {
      found.push_back(read.block);
    }
  }
  return found;
}

void StatusReads::planPeriod(Duration period)
{
  planned_ = period;
}

Duration StatusReads::slowPeriod() const
{
  Duration period = planned_;
  for (const StatusRead& read : reads_)
  {
    period = read.isSlowed() ? std::max(period, read.period) : period;
  }
  return period;
}

Duration StatusReads::slowNeeds(Duration gap, Duration unread) const
{
  Duration needs{ 0 };
  for (const StatusRead& read : reads_)
  {
    const Duration own = read.ever ? gap + read.took : unread;
    needs += read.isSlowed() ? own : Duration{ 0 };
  }
  return needs;
}

std::optional<Duration> StatusReads::slowAge(TimePoint now) const
{
  std::optional<Duration> age;
  for (const StatusRead& read : reads_)
  {
    if (read.isSlowed() && read.ever)
    {
      age = std::max(age.value_or(Duration{ 0 }), now - read.last);
    }
  }
  return age;
}

void StatusReads::addSlowValues(TimePoint now, drive::Monitor& monitor) const
{
  const Duration oldest =
      std::max(seconds(OLDEST_SLOW_VALUE_S), seconds(toSeconds(slowPeriod()) * OLDEST_SLOW_VALUE_PERIODS));
  for (const StatusRead& read : reads_)
  {
    const Duration age = read.isSlowed() ? oldest : seconds(OLDEST_GUARD_S);
    if (read.kind == StatusRead::Kind::Slow && read.ever && now - read.last <= age)
    {
      mergeMonitor(read.values, monitor);
    }
  }
}
}  // namespace bus
}  // namespace inverter_bus

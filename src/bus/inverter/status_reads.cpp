// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/status_reads.h"

#include <algorithm>
#include <string>

#include "bus/inverter/merge_monitor.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
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

StatusReads::StatusReads(const drive::Drive& drive) : drive_(drive)
{
  build(std::nullopt);
}

void StatusReads::build(const std::optional<drive::ReadBlock>& chosen)
{
  reads_.clear();
  add(chosen ? drive_.slowBlocksBeside(*chosen) : drive_.slowBlocks(), StatusRead::Kind::Slow);
  add(drive_.faultBlocks(), StatusRead::Kind::Fault);
  add(chosen ? drive_.fastBlocksBeside(*chosen) : drive_.fastBlocks(), StatusRead::Kind::Fast);
  if (chosen)
  {
    add({ *chosen }, StatusRead::Kind::Fast);
  }
}

void StatusReads::change(const std::optional<drive::ReadBlock>& chosen, const std::vector<drive::ReadBlock>& proof)
{
  const std::vector<StatusRead> before = std::move(reads_);
  build(chosen);
  add(proof, StatusRead::Kind::Proof);
  for (StatusRead& read : reads_)
  {
    const auto old = std::find_if(before.begin(), before.end(), [&read](const StatusRead& one) {
      return one.kind == read.kind && one.block.space == read.block.space && one.block.number == read.block.number &&
             one.block.count == read.block.count;
    });
    read = old == before.end() ? read : *old;
  }
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

bool StatusReads::split(std::size_t index)
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

void StatusReads::addSlowValues(TimePoint now, Duration age, drive::Monitor& monitor) const
{
  for (const StatusRead& read : reads_)
  {
    if (read.kind == StatusRead::Kind::Slow && read.ever && now - read.last <= age)
    {
      mergeMonitor(read.values, monitor);
    }
  }
}
}  // namespace bus
}  // namespace inverter_bus

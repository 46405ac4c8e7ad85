// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/chosen_block.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr unsigned MOST_REFUSALS = 2;
}  // namespace

ChosenBlock::ChosenBlock(const drive::Drive& drive) : drive_(drive)
{
}

bool ChosenBlock::use(const std::optional<drive::ReadBlock>& block)
{
  const bool same = block.has_value() == read_.has_value() && (!block || block->chosen == read_->chosen);
  if (same)
  {
    return false;
  }
  read_ = block;
  proven_ = false;
  refusals_ = 0;
  values_.clear();
  return true;
}

const std::optional<drive::ReadBlock>& ChosenBlock::read() const
{
  return read_;
}

const std::vector<std::pair<std::string, std::string>>& ChosenBlock::values() const
{
  return values_;
}

/// Slots that were changed but don't count yet bring other words, or zeros. The status word must be what the direct read
/// before it was; a drive that changes its state just then is read directly until its next return, which costs little.
bool ChosenBlock::isChosenWord(const wire::Reply& reply, const drive::Ratings& ratings,
                               const drive::Monitor& direct) const
{
  drive::Monitor values;
  drive_.decode(*read_, reply.pdu, values, ratings);
  return !values.raw_status || !direct.raw_status || *values.raw_status == *direct.raw_status;
}

bool ChosenBlock::received(const wire::Reply& reply, const drive::Ratings& ratings, const drive::Monitor& direct)
{
  if (!proven_ && !isChosenWord(reply, ratings, direct))
  {
    return false;
  }
  proven_ = true;
  refusals_ = 0;
  values_ = drive_.chosenValues(*read_, reply.pdu, ratings);
  return true;
}

bool ChosenBlock::refused(bool for_good)
{
  ++refusals_;
  return for_good || refusals_ >= MOST_REFUSALS;
}

void ChosenBlock::drop()
{
  use(std::nullopt);
  dropped_ = true;
}

bool ChosenBlock::takeRefusal()
{
  const bool dropped = dropped_;
  dropped_ = false;
  return dropped;
}

void ChosenBlock::forget()
{
  read_.reset();
  values_.clear();
}
}  // namespace bus
}  // namespace inverter_bus

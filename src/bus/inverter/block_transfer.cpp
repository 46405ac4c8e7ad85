// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/block_transfer.h"

#include <algorithm>

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
BlockTransfer::BlockTransfer(const drive::Drive& drive, const InverterConfig& config) : drive_(drive), config_(config)
{
}

bool BlockTransfer::fits(const std::optional<BlockSlots>& slots) const
{
  return slots && slots->read == config_.block_read && slots->write == wantedWriteCodes();
}

std::optional<drive::ReadBlock> BlockTransfer::read(const std::optional<BlockSlots>& slots) const
{
  return dropped_.empty() && fits(slots) ? drive_.chosenRead(config_.block_read) : std::nullopt;
}

std::vector<std::pair<std::string, std::uint32_t>> BlockTransfer::takeWrites(const std::optional<BlockSlots>& slots)
{
  std::vector<std::pair<std::string, std::uint32_t>> writes;
  if (!config_.configure_block || configured_ || !slots || fits(slots))
  {
    return writes;
  }
  configured_ = true;
  const drive::Block& block = *drive_.profile().block;
  const auto add = [&](const std::string& name, std::uint32_t raw) {
    if (drive_.findParameter(name, true))
    {
      writes.emplace_back(name, raw);
    }
  };
  for (std::size_t slot = 0; slot < block.write_slots.size(); ++slot)
  {
    if (slots->write[slot] != static_cast<int>(block.select[slot].second))
    {
      add(block.write_slots[slot], block.select[slot].second);
    }
  }
  for (std::size_t slot = 0; slot < block.read_slots.size() && slot < config_.block_read.size(); ++slot)
  {
    if (slots->read[slot] != config_.block_read[slot])
    {
      add(block.read_slots[slot], static_cast<std::uint32_t>(config_.block_read[slot]));
    }
  }
  if (!block.apply_parameter.empty())
  {
    add(block.apply_parameter, block.apply_value);
  }
  return writes;
}

bool BlockTransfer::isSelectedBy(const std::string& parameter) const
{
  const auto& block = drive_.profile().block;
  const auto among = [&parameter](const std::vector<std::string>& slots) {
    return std::find(slots.begin(), slots.end(), parameter) != slots.end();
  };
  return block && (among(block->read_slots) || among(block->write_slots));
}

void BlockTransfer::drop(const std::string& why)
{
  dropped_ = why;
}

void BlockTransfer::tryAgain()
{
  dropped_.clear();
}

std::string BlockTransfer::whyNot(const BlockSlots& slots) const
{
  if (!dropped_.empty())
  {
    return "block read and write are not used: " + dropped_;
  }
  if (fits(slots))
  {
    return "block read is selected but not in effect: direct reads are used; switch the drive off and on";
  }
  return "block read and write are not used, since the drive has selected " + util::joined(slots.write) + " and " +
         util::joined(slots.read) + " instead of " + util::joined(wantedWriteCodes()) + " and " +
         util::joined(config_.block_read) + "; direct reads are used; set the drive, or configure_block: true";
}

std::vector<int> BlockTransfer::wantedWriteCodes() const
{
  std::vector<int> codes;
  for (const auto& entry : drive_.profile().block->select)
  {
    codes.push_back(static_cast<int>(entry.second));
  }
  return codes;
}
}  // namespace bus
}  // namespace inverter_bus

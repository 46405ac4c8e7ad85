// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/codec/read_plan.h"

#include <algorithm>

#include "drive/codec/codec.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
struct Entry
{
  const std::string* field;
  const Item* item;
};

std::vector<Entry> sortedByPlace(const std::map<std::string, Item>& items)
{
  std::vector<Entry> entries;
  entries.reserve(items.size());
  for (const auto& [field, item] : items)
  {
    entries.push_back({ &field, &item });
  }
  const auto before = [](const Entry& a, const Entry& b) {
    if (a.item->space != b.item->space || a.item->area != b.item->area)
    {
      return a.item->space != b.item->space ? a.item->space < b.item->space : a.item->area < b.item->area;
    }
    // At the same start the longest first: the others then fall into its block.
    return a.item->number != b.item->number ? a.item->number < b.item->number : a.item->size > b.item->size;
  };
  std::stable_sort(entries.begin(), entries.end(), before);
  return entries;
}

/// True if every number from \p first to \p last is known to be answered.
bool insideSpan(unsigned first, unsigned last, Space space, const Profile& profile)
{
  if (space != Space::Coil && space != Space::Register)
  {
    return false;
  }
  const auto& spans = space == Space::Coil ? profile.coil_spans : profile.register_spans;
  return std::any_of(spans.begin(), spans.end(),
                     [first, last](const auto& span) { return span.first <= first && last <= span.second; });
}

unsigned readLimit(Space space, const Profile& profile)
{
  if (space == Space::ControllerStatus)
  {
    return 1;
  }
  return space == Space::Coil ? profile.read_coils : profile.read_registers;
}

unsigned positionOf(std::uint16_t number, Space space, const Profile& profile)
{
  return space == Space::Register ? profile.position(number) : number;
}

/// Words from the block's first to the end of \p item.
unsigned reach(const ReadBlock& block, const Item& item, const Profile& profile)
{
  return positionOf(item.number, item.space, profile) + item.size - positionOf(block.number, block.space, profile);
}

bool fits(const ReadBlock& block, const Item& item, const Profile& profile)
{
  if (block.space != item.space || block.area != item.area)
  {
    return false;
  }
  if (std::max(block.count, reach(block, item, profile)) > readLimit(item.space, profile))
  {
    return false;
  }
  // Items that touch or overlap leave no gap; a gap must lie in one span as a whole.
  const unsigned gap_first = block.number + block.count;
  const bool touches = reach(block, item, profile) <= block.count + item.size;
  return touches || insideSpan(gap_first, item.number - 1U, item.space, profile);
}
}  // namespace

std::vector<ReadBlock> planReads(const std::map<std::string, Item>& items, const Profile& profile)
{
  std::vector<ReadBlock> blocks;
  for (const Entry& entry : sortedByPlace(items))
  {
    const Item& item = *entry.item;
    if (blocks.empty() || !fits(blocks.back(), item, profile))
    {
      blocks.push_back(blockAround(item));
    }
    ReadBlock& block = blocks.back();
    block.count = std::max(block.count, reach(block, item, profile));
    block.fields.push_back(*entry.field);
  }
  return blocks;
}
}  // namespace drive
}  // namespace inverter_bus

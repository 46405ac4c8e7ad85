// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "read_plan.h"

#include <algorithm>

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
  for (const auto& [field, item] : items)
  {
    entries.push_back({ &field, &item });
  }
  const auto before = [](const Entry& a, const Entry& b) {
    if (a.item->space != b.item->space)
    {
      return a.item->space == Space::Coil;
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
  const auto& spans = space == Space::Coil ? profile.coil_spans : profile.register_spans;
  return std::any_of(spans.begin(), spans.end(),
                     [first, last](const auto& span) { return span.first <= first && last <= span.second; });
}

bool fits(const ReadBlock& block, const Item& item, const Profile& profile)
{
  if (block.space != item.space)
  {
    return false;
  }
  const unsigned block_end = block.number + block.count;
  const unsigned end = std::max<unsigned>(block_end, item.number + item.size);
  const unsigned limit = item.space == Space::Coil ? profile.read_coils : profile.read_registers;
  if (end - block.number > limit)
  {
    return false;
  }
  // Items that touch or overlap leave no gap; a gap must lie in one span as a whole.
  return item.number <= block_end || insideSpan(block_end, item.number - 1U, item.space, profile);
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
      blocks.push_back({ item.space, item.number, item.address, item.size, {} });
    }
    ReadBlock& block = blocks.back();
    block.count = std::max<unsigned>(block.count, item.number + item.size - block.number);
    block.fields.push_back(*entry.field);
  }
  return blocks;
}
}  // namespace drive
}  // namespace inverter_bus

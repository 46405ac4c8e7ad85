// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Sections block and ratings.

#include "config/numerals.h"
#include "drive/profile/profile_builder.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
std::optional<Item> readWindow(Section& map, const Numbering& numbering)
{
  ItemRules rules;
  rules.coil = false;
  rules.scale = false;
  return readItem(map, numbering, rules);
}

std::vector<std::string> readSlots(Section& map)
{
  std::vector<std::string> slots;
  if (const auto cursor = map.require("slots"))
  {
    for (const Cursor& entry : cursor->list())
    {
      slots.push_back(entry.name().value_or(""));
    }
  }
  return slots;
}

void readBlockRead(Section& map, const Numbering& numbering, Block& block)
{
  if (const auto cursor = map.require("read"))
  {
    Section read(*cursor);
    block.read = readWindow(read, numbering).value_or(Item());
    block.read_slots = readSlots(read);
    read.finish();
  }
}

void readBlockWrite(Section& map, const Numbering& numbering, Block& block)
{
  const auto cursor = map.require("write");
  if (!cursor)
  {
    return;
  }
  Section write(*cursor);
  block.write = readWindow(write, numbering).value_or(Item());
  block.write_slots = readSlots(write);
  if (const auto select = write.require("select"))
  {
    for (const auto& [point, code] : select->entries())
    {
      block.select.emplace_back(point, static_cast<std::uint32_t>(code.integer(0, 0xFFFF).value_or(0)));
    }
    if (block.select.size() != block.write_slots.size())
    {
      select->complain("names " + std::to_string(block.select.size()) + " points for " +
                       std::to_string(block.write_slots.size()) + " slots: allowed: one point for each slot");
    }
  }
  write.finish();
}

void readCode(const std::string& key, const Cursor& cursor, const Numbering& numbering, Block& block)
{
  const auto code = config::parseInteger(key);
  Section map(cursor);
  BlockCode entry;
  entry.title = map.text("title");
  ItemRules rules;
  rules.coil = false;
  rules.base = true;
  if (map.has("register"))
  {
    entry.item = readItem(map, numbering, rules);
  }
  map.text("source");
  map.finish();
  if (!code || *code < 0 || *code > 0xFFFF)
  {
    cursor.complain("the selection code '" + key + "': allowed: an integer from 0 to 65535");
    return;
  }
  block.codes[static_cast<unsigned>(*code)] = entry;
}
}  // namespace

void readBlock(Section& root, const Numbering& numbering, Profile& profile)
{
  const auto cursor = numbering.variables ? std::nullopt : root.find("block");
  if (!cursor)
  {
    return;
  }
  Section map(*cursor);
  Block block;
  readBlockRead(map, numbering, block);
  readBlockWrite(map, numbering, block);
  if (const auto codes = map.require("codes"))
  {
    for (const auto& [code, entry] : codes->entries())
    {
      readCode(code, entry, numbering, block);
    }
  }
  if (const auto apply_cursor = map.find("apply"))
  {
    Section apply(*apply_cursor);
    block.apply_parameter = apply.name("parameter");
    block.apply_value = static_cast<std::uint32_t>(apply.integer("value", 0, 0xFFFF, 1));
    apply.finish();
  }
  map.text("source");
  map.finish();
  profile.block = block;
}

void readRatings(Section& root, Profile& profile)
{
  if (const auto cursor = root.find("ratings"))
  {
    Section map(*cursor);
    profile.rated_current_parameter = map.name("current");
    profile.rated_voltage_parameter = map.name("voltage");
    map.text("source");
    map.finish();
  }
}
}  // namespace drive
}  // namespace inverter_bus

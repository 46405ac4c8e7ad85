// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "item_reader.h"

#include <algorithm>
#include <string>

#include "numbers.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
constexpr std::int64_t MAX_NUMBER = 0xFFFF;

void readAddress(const YamlCursor& cursor, const Numbering& numbering, Item& item, bool& good)
{
  const auto number = cursor.integer(numbering.lowest(item.space), numbering.highest(item.space));
  if (!number)
  {
    good = false;
    return;
  }
  item.number = static_cast<std::uint16_t>(*number);
  item.address = static_cast<std::uint16_t>(*number + numbering.offset(item.space));
}

void checkEnd(const YamlMap& map, const Numbering& numbering, const Item& item)
{
  const std::int64_t last = static_cast<std::int64_t>(item.number) + item.size - 1;
  if (last > numbering.highest(item.space))
  {
    map.cursor().complain("reaches beyond " + formatHex(static_cast<std::uint32_t>(numbering.highest(item.space))));
  }
}

void readValues(const YamlCursor& cursor, Item& item)
{
  for (const auto& [key, meaning] : cursor.entries())
  {
    const auto raw = parseInteger(key);
    const auto value = meaning.integer(-1, 1);
    if (!raw || *raw < 0 || *raw > 0xFFFF)
    {
      meaning.complain("the raw value '" + key + "': allowed: an integer from 0 to 65535");
    }
    else if (value)
    {
      item.values[static_cast<std::uint32_t>(*raw)] = static_cast<int>(*value);
    }
  }
}

void readScale(YamlMap& map, Item& item)
{
  if (const auto cursor = map.find("resolution"))
  {
    item.resolution = cursor->positive().value_or(1.0);
  }
  item.unit = map.text("unit");
  item.is_signed = map.flag("signed", false);
}

void readBits(YamlMap& map, const ItemRules& rules, Item& item)
{
  const bool has_bit = rules.bit && map.has("bit");
  if (rules.bit)
  {
    const std::int64_t bit = map.integer("bit", 0, 15, 0);
    if (has_bit)
    {
      item.bit = static_cast<unsigned>(bit);
    }
  }
  const std::int64_t largest = item.size == 2 ? 0xFFFFFFFFLL : 0xFFFF;
  item.mask = static_cast<std::uint32_t>(map.integer("mask", 1, largest, 0xFFFFFFFFLL));
  if (has_bit && (item.size != 1 || map.has("mask") || map.has("signed") || map.has("resolution") || map.has("values")))
  {
    map.cursor().complain("a bit has a register of one word and neither mask, signed, resolution nor values");
  }
  if (map.has("mask") && item.is_signed)
  {
    map.cursor().complain("mask and signed exclude each other");
  }
}

void readRegister(YamlMap& map, const ItemRules& rules, Item& item)
{
  item.size = static_cast<unsigned>(map.integer("words", 1, 2, 1));
  if (rules.scale)
  {
    readScale(map, item);
  }
  readBits(map, rules, item);
}

void readCoil(YamlMap& map, const ItemRules& rules, Item& item)
{
  if (rules.packed_coils)
  {
    item.size = static_cast<unsigned>(map.integer("count", 1, 32, 1));
  }
}

void checkValues(const YamlMap& map, const Item& item)
{
  if (!item.values.empty() && (item.is_signed || map.has("resolution")))
  {
    map.cursor().complain("values exclude signed and resolution");
  }
}
}  // namespace

std::int64_t Numbering::offset(Space space) const
{
  return space == Space::Coil ? coil_offset : register_offset;
}

std::int64_t Numbering::lowest(Space space) const
{
  return -offset(space);
}

std::int64_t Numbering::highest(Space) const
{
  // Offsets are never positive, so that the largest 16-bit number is the end of both counts.
  return MAX_NUMBER;
}

std::optional<Item> readItem(YamlMap& map, const Numbering& numbering, const ItemRules& rules)
{
  const auto coil = rules.coil ? map.find("coil") : std::nullopt;
  const auto reg = map.find("register");
  Item item;
  item.unconfirmed = map.name("unconfirmed");
  map.text("source");
  if (!map.cursor().isMap())
  {
    return std::nullopt;
  }
  if (static_cast<bool>(coil) == static_cast<bool>(reg))
  {
    const std::string what = rules.coil ? "one of the keys coil and register" : "the key register";
    map.cursor().complain("needs exactly " + what);
    return std::nullopt;
  }
  bool good = true;
  item.space = coil ? Space::Coil : Space::Register;
  readAddress(coil ? *coil : *reg, numbering, item, good);
  if (coil)
  {
    readCoil(map, rules, item);
  }
  else
  {
    readRegister(map, rules, item);
  }
  if (const auto values = rules.values ? map.find("values") : std::nullopt)
  {
    readValues(*values, item);
  }
  checkValues(map, item);
  if (!good)
  {
    return std::nullopt;
  }
  checkEnd(map, numbering, item);
  return item;
}

std::vector<std::pair<unsigned, unsigned>> readSpans(const YamlCursor& cursor, const Numbering& numbering, Space space)
{
  std::vector<std::pair<unsigned, unsigned>> spans;
  for (const YamlCursor& pair : cursor.list())
  {
    const std::vector<YamlCursor> ends = pair.list();
    if (ends.size() != 2)
    {
      pair.reject("two numbers, first and last");
      continue;
    }
    const auto first = ends[0].integer(numbering.lowest(space), numbering.highest(space));
    const auto last = ends[1].integer(numbering.lowest(space), numbering.highest(space));
    if (!first || !last)
    {
      continue;
    }
    if (*last < *first || (!spans.empty() && *first <= static_cast<std::int64_t>(spans.back().second)))
    {
      pair.complain("allowed: first <= last, and spans in ascending order that don't overlap");
      continue;
    }
    spans.emplace_back(static_cast<unsigned>(*first), static_cast<unsigned>(*last));
  }
  return spans;
}

std::uint32_t largestRaw(const Item& item)
{
  if (item.space == Space::Coil)
  {
    return item.size >= 32 ? 0xFFFFFFFFU : (1U << item.size) - 1U;
  }
  return item.size == 2 ? 0xFFFFFFFFU : 0xFFFFU;
}
}  // namespace drive
}  // namespace inverter_bus

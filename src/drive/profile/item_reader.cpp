// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/item_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <string>

#include "config/numerals.h"
#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
constexpr std::int64_t MAX_NUMBER = 0xFFFF;

bool isUnknown(const Cursor& cursor)
{
  return cursor.value().isScalar() && cursor.value().text == UNKNOWN;
}

/// An unknown place or value must have a name, or it would look like one that may be used.
void noteMissing(const Section& map, Item& item)
{
  item.missing = true;
  if (item.unconfirmed.empty())
  {
    map.cursor().complain("is unknown: needs unconfirmed: NAME");
  }
}

const Constant* findConstant(const Cursor& cursor, const Numbering& numbering)
{
  const auto found = numbering.constants.find(cursor.value().text);
  if (cursor.value().isScalar() && found != numbering.constants.end())
  {
    return &found->second;
  }
  return nullptr;
}

/// An item that depends on a constant is as unconfirmed as the constant.
void inheritMark(const Constant& constant, Item& item)
{
  if (!constant.unconfirmed.empty())
  {
    item.own_mark = item.own_mark.empty() ? item.unconfirmed : item.own_mark;
    item.unconfirmed = constant.unconfirmed;
    item.missing = item.missing || !constant.value;
  }
}

/// The number that `register` counts from; 0 without `base`.
std::int64_t readBase(Section& map, const Numbering& numbering, Item& item)
{
  const auto cursor = map.find("base");
  if (!cursor)
  {
    return 0;
  }
  const Constant* constant = findConstant(*cursor, numbering);
  if (constant == nullptr)
  {
    cursor->reject("a name of the section constants");
    return 0;
  }
  inheritMark(*constant, item);
  const double base = constant->value.value_or(0.0);
  if (base != std::floor(base) || base < 0.0 || base > static_cast<double>(MAX_NUMBER))
  {
    cursor->complaints().complain({ constant->place, constant->key },
                                  "value " + util::exactText(base) + ": allowed: an integer from 0 to 65535");
    return 0;
  }
  return static_cast<std::int64_t>(base);
}

void checkDigits(const Cursor& cursor, const Numbering& numbering, std::int64_t number)
{
  if (numbering.decimal && ((number & 0xF) > 9 || ((number >> 4) & 0xF) > 9))
  {
    cursor.complain(util::hexNumber(static_cast<std::uint32_t>(number)) +
                    " does not exist on this drive: the last two digits count decimally (numbering.decimal)");
  }
}

void readAddress(Section& map, const Cursor& cursor, const Numbering& numbering, Item& item, bool& good)
{
  const bool based = map.has("base");
  const std::int64_t base = readBase(map, numbering, item);
  if (isUnknown(cursor))
  {
    noteMissing(map, item);
    return;
  }
  const std::int64_t lowest = based ? 0 : numbering.lowest(item.space);
  const auto number = cursor.integer(lowest, numbering.highest(item.space) - base);
  if (!number)
  {
    good = false;
    return;
  }
  item.number = static_cast<std::uint16_t>(base + *number);
  item.address = static_cast<std::uint16_t>(base + *number + numbering.offset(item.space));
  if (item.space == Space::Register && !item.missing)
  {
    checkDigits(cursor, numbering, base + *number);
  }
}

/// "C1/0000": variable type and address as the manual writes them.
void readVariable(const Section& map, const Cursor& cursor, Item& item, bool& good)
{
  item.space = Space::Variable;
  if (isUnknown(cursor))
  {
    noteMissing(map, item);
    return;
  }
  static const std::regex FORM("([0-9A-F]{2})/([0-9A-F]{4})");
  std::smatch match;
  const std::string text = cursor.text().value_or("");
  if (!std::regex_match(text, match, FORM))
  {
    cursor.reject("variable type and address in upper-case hexadecimal digits, such as C1/0000");
    good = false;
    return;
  }
  item.area = static_cast<std::uint8_t>(std::strtoul(match[1].str().c_str(), nullptr, 16));
  item.number = static_cast<std::uint16_t>(std::strtoul(match[2].str().c_str(), nullptr, 16));
  item.address = item.number;
}

void checkEnd(const Section& map, const Numbering& numbering, const Item& item)
{
  const std::int64_t last = static_cast<std::int64_t>(item.number) + item.size - 1;
  if (!item.missing && last > numbering.highest(item.space))
  {
    map.cursor().complain("reaches beyond " +
                          util::hexNumber(static_cast<std::uint32_t>(numbering.highest(item.space))));
  }
}

void readValues(const Cursor& cursor, Item& item)
{
  for (const auto& [key, meaning] : cursor.entries())
  {
    const auto raw = config::parseInteger(key);
    const auto value = meaning.integer(-1, 1);
    const std::int64_t highest = largestRaw(item);
    if (!raw || *raw < 0 || *raw > highest)
    {
      meaning.complain("the raw value '" + util::printable(key) + "': allowed: an integer from 0 to " +
                       std::to_string(highest));
    }
    else if (value)
    {
      item.values[static_cast<std::uint32_t>(*raw)] = static_cast<int>(*value);
    }
  }
}

void readResolution(const Cursor& cursor, const Numbering& numbering, Item& item)
{
  const Constant* constant = findConstant(cursor, numbering);
  if (constant == nullptr)
  {
    item.resolution = cursor.positive().value_or(1.0);
    return;
  }
  inheritMark(*constant, item);
  item.resolution = constant->value.value_or(1.0);
  if (!(item.resolution > 0.0))
  {
    cursor.complaints().complain({ constant->place, constant->key },
                                 "value " + util::exactText(item.resolution) + ": allowed: a number above 0");
    item.resolution = 1.0;
  }
}

void readScale(Section& map, const Numbering& numbering, const ItemRules& rules, Item& item)
{
  if (const auto cursor = map.find("resolution"))
  {
    readResolution(*cursor, numbering, item);
  }
  item.unit = map.text("unit");
  item.is_signed = map.flag("signed", false);
  const auto of = rules.base ? map.find("of") : std::nullopt;
  if (!of)
  {
    return;
  }
  item.base = of->choice({ "rated_current", "rated_voltage" }).value_or("") == "rated_current" ? Base::RatedCurrent
                                                                                               : Base::RatedVoltage;
  if (item.unit != "%")
  {
    of->complain("needs the unit %: the resolution is then in percent of the rating");
  }
}

void readBits(Section& map, const ItemRules& rules, Item& item)
{
  const bool has_bit = rules.bit && map.has("bit");
  if (rules.bit)
  {
    const std::int64_t bit = map.integer("bit", 0, item.space == Space::Variable ? 31 : 15, 0);
    if (has_bit)
    {
      item.bit = static_cast<unsigned>(bit);
    }
  }
  if (const auto nonzero = rules.bit ? map.find("nonzero") : std::nullopt)
  {
    item.nonzero = nonzero->flag().value_or(true);
    if (!item.nonzero)
    {
      nonzero->reject("true");
    }
  }
  const std::int64_t largest = largestRaw(item);
  item.mask = static_cast<std::uint32_t>(map.integer("mask", 1, largest, 0xFFFFFFFFLL));
  if (has_bit && (item.size != 1 || map.has("mask") || map.has("signed") || map.has("resolution") || map.has("values")))
  {
    map.cursor().complain("a bit has a register of one word and neither mask, signed, resolution nor values");
  }
  if (map.has("nonzero") && (has_bit || map.has("values") || map.has("signed") || map.has("resolution")))
  {
    map.cursor().complain("nonzero excludes bit, values, signed and resolution");
  }
  if (map.has("mask") && item.is_signed)
  {
    map.cursor().complain("mask and signed exclude each other");
  }
}

void readRegister(Section& map, const Numbering& numbering, const ItemRules& rules, Item& item)
{
  if (item.space == Space::Register)
  {
    item.size = static_cast<unsigned>(map.integer("words", 1, 2, 1));
  }
  if (rules.scale)
  {
    readScale(map, numbering, rules, item);
  }
  readBits(map, rules, item);
}

void readCoil(Section& map, const ItemRules& rules, Item& item)
{
  if (rules.packed_coils)
  {
    item.size = static_cast<unsigned>(map.integer("count", 1, 32, 1));
  }
}

void checkValues(const Section& map, const Item& item)
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

namespace
{
/// The keys that say where an item lies on this protocol.
std::vector<std::string> placeKeys(const Numbering& numbering, const ItemRules& rules)
{
  if (!numbering.variables)
  {
    return rules.coil ? std::vector<std::string>{ "coil", "register" } : std::vector<std::string>{ "register" };
  }
  // An operation code may be written; the controller's status is only read.
  return rules.written                               ? std::vector<std::string>{ "variable", "operation" }
         : rules.coil || rules.values || rules.scale ? std::vector<std::string>{ "variable", "controller_status" }
                                                     : std::vector<std::string>{ "variable" };
}

/// The one key that says where the item lies; none after a complaint.
std::string readPlaceKey(Section& map, const std::vector<std::string>& keys)
{
  std::string found;
  std::size_t count = 0;
  for (const std::string& key : keys)
  {
    if (map.find(key))
    {
      found = key;
      ++count;
    }
  }
  if (count == 1)
  {
    return found;
  }
  map.cursor().complain("needs exactly " +
                        (keys.size() == 1 ? "the key " + keys[0] : "one of the keys " + keys[0] + " and " + keys[1]));
  return "";
}

void readPlace(Section& map, const std::string& key, const Numbering& numbering, Item& item, bool& good)
{
  const Cursor cursor = *map.find(key);
  if (key == "variable")
  {
    readVariable(map, cursor, item, good);
    return;
  }
  if (key == "operation" || key == "controller_status")
  {
    item.space = key == "operation" ? Space::Operation : Space::ControllerStatus;
    good = cursor.flag().value_or(false);
    if (!good)
    {
      cursor.reject("true");
    }
    return;
  }
  item.space = key == "coil" ? Space::Coil : Space::Register;
  readAddress(map, cursor, numbering, item, good);
}
}  // namespace

std::optional<Item> readItem(Section& map, const Numbering& numbering, const ItemRules& rules)
{
  Item item;
  item.unconfirmed = map.name("unconfirmed");
  map.text("source");
  if (!map.cursor().isMap())
  {
    return std::nullopt;
  }
  const std::string key = readPlaceKey(map, placeKeys(numbering, rules));
  if (key.empty())
  {
    return std::nullopt;
  }
  bool good = true;
  readPlace(map, key, numbering, item, good);
  if (item.space == Space::Coil)
  {
    readCoil(map, rules, item);
  }
  else
  {
    readRegister(map, numbering, rules, item);
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

std::vector<std::pair<unsigned, unsigned>> readSpans(const Cursor& cursor, const Numbering& numbering, Space space)
{
  std::vector<std::pair<unsigned, unsigned>> spans;
  for (const Cursor& pair : cursor.list())
  {
    const std::vector<Cursor> ends = pair.list();
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
    if (space == Space::Register)
    {
      checkDigits(ends[0], numbering, *first);
      checkDigits(ends[1], numbering, *last);
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
  return item.size == 2 || item.space == Space::Variable ? 0xFFFFFFFFU : 0xFFFFU;
}
}  // namespace drive
}  // namespace inverter_bus

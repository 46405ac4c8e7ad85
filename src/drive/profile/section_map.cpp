// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Section map.

#include <algorithm>

#include "config/numerals.h"
#include "drive/profile/profile_builder.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
constexpr std::int64_t MOST_REGISTERS = 125;  // of one read: Modbus V1.1b3, 6.3

void readWord(const std::string& key, const Cursor& cursor, RegisterMap& map)
{
  const auto number = config::parseInteger(key);
  Section entry(cursor);
  MirroredCoils word;
  if (const auto coil = entry.require("coils"))
  {
    word.first_coil = static_cast<std::uint16_t>(coil->integer(0, 0xFFFF).value_or(0));
  }
  entry.text("source");
  entry.finish();
  if (!number || *number < 0 || *number > 0xFFFF)
  {
    cursor.complain("the register '" + key + "': allowed: an integer from 0 to 65535");
    return;
  }
  word.number = static_cast<std::uint16_t>(*number);
  map.words.push_back(word);
}

/// One value of the table, for the parameter at register \p number.
void addEntry(unsigned number, const Cursor& cursor, const Profile& profile, RegisterMap& map)
{
  const auto raw = cursor.integer(0, 0xFFFF);
  const auto found = std::find_if(profile.parameters.begin(), profile.parameters.end(), [number](const auto& entry) {
    return entry.second.item.number == number && entry.second.item.space == Space::Register;
  });
  if (found == profile.parameters.end() || found->second.item.size != 1 || found->second.read_only)
  {
    cursor.complain("is for register " + util::hexNumber(number) +
                    ": allowed: a register that the section parameters has with one word, and not read only");
    return;
  }
  map.table.emplace_back(found->first, static_cast<std::uint32_t>(raw.value_or(0)));
}

/// The first parameter of a row of registers, and the value of each of them; or one parameter and its value.
void readRow(const std::string& name, const Cursor& cursor, const Profile& profile, RegisterMap& map)
{
  const auto first = profile.parameters.find(name);
  if (first == profile.parameters.end())
  {
    cursor.complain("names the unknown parameter '" + name + "': allowed: a name of the section parameters");
    return;
  }
  unsigned number = first->second.item.number;
  for (const Cursor& value : cursor.isList() ? cursor.list() : std::vector<Cursor>{ cursor })
  {
    addEntry(number++, value, profile, map);
  }
}
}  // namespace

void readMap(Section& root, const Numbering& numbering, Profile& profile)
{
  const auto cursor = numbering.variables ? std::nullopt : root.find("map");
  if (!cursor)
  {
    return;
  }
  Section section(*cursor);
  RegisterMap map;
  if (const auto read_cursor = section.require("read"))
  {
    ItemRules rules;
    rules.coil = false;
    rules.scale = false;
    Section read(*read_cursor);
    map.read = readItem(read, numbering, rules).value_or(Item());
    map.read.size = static_cast<unsigned>(read.integer("count", 1, MOST_REGISTERS, 1));
    read.finish();
  }
  if (const auto words = section.require("words"))
  {
    for (const auto& [key, entry] : words->entries())
    {
      readWord(key, entry, map);
    }
  }
  if (const auto table = section.require("table"))
  {
    for (const auto& [name, entry] : table->entries())
    {
      readRow(name, entry, profile, map);
    }
  }
  map.unconfirmed = section.name("unconfirmed");
  section.text("source");
  section.finish();
  profile.map = map;
}
}  // namespace drive
}  // namespace inverter_bus

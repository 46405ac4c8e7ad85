// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Sections faults and warnings: why the drive tripped, now and before.

#include "config/numerals.h"
#include "drive/profile/profile_builder.h"
#include "drive/profile/status_fields.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
constexpr std::int64_t MAX_ENTRIES = 100;

/// A text, or {text: ..., unconfirmed: NAME} where it isn't from the drive's own manual.
std::optional<std::string> readReason(const Cursor& cursor, Profile& profile)
{
  if (!cursor.isMap())
  {
    return cursor.text();
  }
  Section map(cursor);
  const auto text_cursor = map.require("text");
  auto text = text_cursor ? text_cursor->text() : std::nullopt;
  const std::string mark = map.name("unconfirmed");
  map.text("source");
  map.finish();
  if (text && !mark.empty())
  {
    profile.unconfirmed_tables.insert(mark);
    // Better than nothing for the person at the machine, as long as it says what it is.
    *text += " (unconfirmed for this drive)";
  }
  return text;
}

FaultTable readTable(const Cursor& cursor, Profile& profile)
{
  FaultTable table;
  for (const auto& [key, reason] : cursor.entries())
  {
    const auto code = config::parseInteger(key);
    if (!code || *code < 1 || *code > 0xFFFF)
    {
      reason.complain("the code '" + key + "': allowed: an integer from 1 to 65535");
      continue;
    }
    const auto text = readReason(reason, profile);
    if (text && text->empty())
    {
      reason.complain("has an empty text");
    }
    else if (text)
    {
      table[static_cast<std::uint16_t>(*code)] = *text;
    }
  }
  return table;
}

bool isRecordField(const std::string& field)
{
  return field == "code" || recordFields().count(field) != 0;
}

std::string allowedRecordFields()
{
  std::set<std::string> names = { "code" };
  for (const auto& entry : recordFields())
  {
    names.insert(entry.first);
  }
  return util::joined(names);
}

void noteMark(const Item& item, Profile& profile)
{
  if (!item.unconfirmed.empty())
  {
    profile.unconfirmed.insert(item.unconfirmed);
  }
}

/// One field of a trip as {offset: 2, words: 2, ...}: an item that is counted from the entry's first register.
std::optional<Item> readOffsetItem(const Cursor& cursor)
{
  Section map(cursor);
  Item item;
  const auto offset = map.require("offset");
  item.number = static_cast<std::uint16_t>(offset ? offset->integer(0, 255).value_or(0) : 0);
  item.size = static_cast<unsigned>(map.integer("words", 1, 2, 1));
  if (const auto resolution = map.find("resolution"))
  {
    item.resolution = resolution->positive().value_or(1.0);
  }
  item.unit = map.text("unit");
  item.is_signed = map.flag("signed", false);
  item.mask = static_cast<std::uint32_t>(map.integer("mask", 1, 0xFFFFFFFFLL, 0xFFFFFFFFLL));
  item.unconfirmed = map.name("unconfirmed");
  map.text("source");
  map.finish();
  return cursor.isMap() ? std::optional<Item>(item) : std::nullopt;
}

std::map<std::string, Item> readOffsetFields(const Cursor& cursor, Profile& profile)
{
  std::map<std::string, Item> fields;
  for (const auto& [name, field] : cursor.entries())
  {
    if (!isRecordField(name))
    {
      field.complain("unknown key: allowed: " + allowedRecordFields());
      continue;
    }
    const auto item = readOffsetItem(field);
    if (item && !leftOutForUnit(name, *item, field, profile))
    {
      fields[name] = *item;
      noteMark(*item, profile);
    }
  }
  return fields;
}

/// history: {first: 0x0012, stride: 10, count: 6, fields: {...}}: equal blocks, newest first.
void readRegularHistory(const Cursor& cursor, const Numbering& numbering, Profile& profile)
{
  Section map(cursor);
  const auto first_cursor = map.require("first");
  const auto first = first_cursor
                         ? first_cursor->integer(numbering.lowest(Space::Register), numbering.highest(Space::Register))
                         : std::nullopt;
  const std::int64_t stride = map.integer("stride", 1, 1000, 1);
  const std::int64_t count = map.integer("count", 1, MAX_ENTRIES, 1);
  const auto fields_cursor = map.require("fields");
  map.text("source");
  map.finish();
  if (!first || !fields_cursor)
  {
    return;
  }
  const std::map<std::string, Item> fields = readOffsetFields(*fields_cursor, profile);
  for (std::int64_t i = 0; i < count; ++i)
  {
    std::map<std::string, Item> entry;
    for (const auto& [name, field] : fields)
    {
      const std::int64_t number = *first + i * stride + field.number;
      if (number + field.size - 1 > numbering.highest(Space::Register))
      {
        cursor.complain("reaches beyond " + util::hexNumber(0xFFFF));
        return;
      }
      Item item = field;
      item.number = static_cast<std::uint16_t>(number);
      item.address = static_cast<std::uint16_t>(number + numbering.register_offset);
      entry[name] = item;
    }
    profile.history.entries.push_back(entry);
  }
}

/// history: [{code: {register: 0xFE10}}, ...]: entries that lie anywhere, newest first.
void readListedHistory(const Cursor& cursor, const Numbering& numbering, Profile& profile)
{
  ItemRules rules;
  rules.coil = false;
  for (const Cursor& listed : cursor.list())
  {
    std::map<std::string, Item> entry;
    for (const auto& [name, field] : listed.entries())
    {
      if (!isRecordField(name))
      {
        field.complain("unknown key: allowed: " + allowedRecordFields());
        continue;
      }
      Section map(field);
      const auto item = readItem(map, numbering, rules);
      map.finish();
      if (item && !leftOutForUnit(name, *item, field, profile))
      {
        entry[name] = *item;
        noteMark(*item, profile);
      }
    }
    profile.history.entries.push_back(entry);
  }
}

void checkHistory(const Cursor& cursor, const Profile& profile)
{
  for (const auto& entry : profile.history.entries)
  {
    const auto code = entry.find("code");
    if (code == entry.end() || code->second.size != 1)
    {
      cursor.complain("every entry needs the field code, of one word");
      return;
    }
  }
}
}  // namespace

void readFaults(Section& root, const Numbering& numbering, Profile& profile)
{
  if (const auto cursor = root.find("faults"))
  {
    Section faults(*cursor);
    if (const auto table = faults.find("table"))
    {
      profile.faults = readTable(*table, profile);
    }
    if (const auto history = faults.find("history"))
    {
      history->isList() ? readListedHistory(*history, numbering, profile)
                        : readRegularHistory(*history, numbering, profile);
      checkHistory(*history, profile);
    }
    faults.finish();
  }
  if (const auto cursor = root.find("warnings"))
  {
    Section warnings(*cursor);
    if (const auto table = warnings.find("table"))
    {
      profile.warnings = readTable(*table, profile);
    }
    profile.warning_bits = warnings.flag("bits", false);
    warnings.finish();
  }
}
}  // namespace drive
}  // namespace inverter_bus

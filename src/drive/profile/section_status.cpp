// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Section status: what the driver reads in every refresh.

#include <algorithm>

#include "drive/profile/profile_builder.h"
#include "drive/profile/status_fields.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
enum class FieldKind
{
  Unknown,
  Flag,
  Direction,
  Code,
  Quantity
};

FieldKind fieldKind(const std::string& field)
{
  if (field == "direction")
  {
    return FieldKind::Direction;
  }
  if (flagFields().count(field) != 0)
  {
    return FieldKind::Flag;
  }
  if (quantityFields().count(field) != 0)
  {
    return FieldKind::Quantity;
  }
  return codeFields().count(field) != 0 ? FieldKind::Code : FieldKind::Unknown;
}

std::string allowedFields()
{
  std::set<std::string> names = codeFields();
  names.insert("direction");
  for (const auto& entry : flagFields())
  {
    names.insert(entry.first);
  }
  for (const auto& entry : quantityFields())
  {
    names.insert(entry.first);
  }
  return util::joined(names);
}

ItemRules rulesOf(FieldKind kind)
{
  ItemRules rules;
  rules.coil = kind != FieldKind::Quantity;
  rules.packed_coils = kind == FieldKind::Code;
  rules.bit = kind == FieldKind::Flag;
  rules.values = kind == FieldKind::Flag || kind == FieldKind::Direction;
  rules.scale = kind == FieldKind::Quantity;
  rules.base = kind == FieldKind::Quantity;
  return rules;
}

void checkMeaning(FieldKind kind, const std::string& field, const Item& item, const Cursor& cursor)
{
  if (kind == FieldKind::Direction && item.values.empty())
  {
    cursor.complain("needs values: the raw values that mean -1 (reverse), 0 (at rest) and 1 (forward)");
  }
  if (kind == FieldKind::Flag)
  {
    if (item.space != Space::Coil && !item.bit && !item.nonzero && item.values.empty())
    {
      cursor.complain("a register that is true or false needs bit, values or nonzero");
    }
    for (const auto& [raw, meaning] : item.values)
    {
      if (meaning < 0)
      {
        cursor.complain("raw value " + std::to_string(raw) + ": allowed meanings: 0, 1");
      }
    }
  }
  const auto means_no_trip = [](const auto& entry) { return entry.second == 0; };
  if (field == "faulted" && !item.values.empty() && std::none_of(item.values.begin(), item.values.end(), means_no_trip))
  {
    cursor.complain("no value means 0 (no trip), and a value that is in no table counts as a trip");
  }
  if (field == "fault_code" && largestRaw(item) > 0xFFFF)
  {
    cursor.complain("a fault code has at most 16 bits");
  }
}

void readField(const std::string& field, const Cursor& cursor, const Numbering& numbering, Profile& profile)
{
  const FieldKind kind = fieldKind(field);
  if (kind == FieldKind::Unknown)
  {
    cursor.complain("unknown key: allowed: " + allowedFields());
    return;
  }
  Section map(cursor);
  const auto item = readItem(map, numbering, rulesOf(kind));
  const bool slow = map.flag("slow", false);
  const auto when = map.find("when");
  const bool when_faulted = when && when->choice({ "faulted" });
  map.flag("shared", false);
  map.finish();
  if (slow && when_faulted)
  {
    cursor.complain("slow and when exclude each other");
  }
  if (field == "faulted" && (slow || when_faulted))
  {
    cursor.complain("is read in every refresh, since a trip must not be missed: neither slow nor when");
  }
  if (!item)
  {
    return;
  }
  checkMeaning(kind, field, *item, cursor);
  if (leftOutForUnit(field, *item, cursor, profile))
  {
    return;
  }
  profile.status[field] = *item;
  if (slow)
  {
    profile.slow.insert(field);
  }
  if (when_faulted)
  {
    profile.when_faulted.insert(field);
  }
  for (const std::string& mark : { item->unconfirmed, item->own_mark })
  {
    if (!mark.empty())
    {
      profile.unconfirmed.insert(mark);
    }
  }
}
}  // namespace

void readKeepAlive(Section& root, const Numbering& numbering, Profile& profile)
{
  const auto cursor = root.find("keep_alive");
  if (!cursor)
  {
    return;
  }
  ItemRules rules;
  rules.scale = false;
  Section map(*cursor);
  profile.keep_alive = readItem(map, numbering, rules);
  map.finish();
  if (profile.keep_alive && !profile.keep_alive->unconfirmed.empty())
  {
    cursor->complain("must be confirmed: something must be read from a drive that reports nothing else");
  }
}

void readStatus(Section& root, const Numbering& numbering, Profile& profile)
{
  readKeepAlive(root, numbering, profile);
  if (const auto cursor = root.require("status"))
  {
    for (const auto& [field, item] : cursor->entries())
    {
      readField(field, item, numbering, profile);
    }
  }
}
}  // namespace drive
}  // namespace inverter_bus

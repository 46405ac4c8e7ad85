// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/profile_overrides.h"

#include <algorithm>

#include "drive/profile/item_reader.h"
#include "drive/profile/yaml_reader.h"
#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
const std::string MARK = "unconfirmed";
const std::string RANGE_MARK = "range_unconfirmed";

/// Keys that `unconfirmed` is about. A title or `slow` says nothing about whether the address is right.
bool confirms(const YamlEntry& entry)
{
  static const std::set<std::string> KEYS = {
    "register",         "coil",   "count", "words", "signed", "resolution", "bit", "mask",     "values",
    "nonzero",          "offset", "steps", "text",  "value",  "base",       "of",  "variable", "operation",
    "controller_status"
  };
  return KEYS.count(entry.key) != 0;
}

/// {coil: 5} over {register: 7, words: 2}: another place, so nothing of the old one is left.
bool changesSpace(const YamlValue& base, const YamlValue& change)
{
  static const std::vector<std::string> PLACES = { "register", "coil", "variable", "operation", "controller_status" };
  const auto in = [](const YamlValue& map) {
    return std::find_if(PLACES.begin(), PLACES.end(),
                        [&map](const std::string& key) { return map.find(key) != nullptr; });
  };
  return in(base) != PLACES.end() && in(change) != PLACES.end() && in(base) != in(change);
}

void removeMarks(YamlValue& base, const YamlValue& change)
{
  if (std::any_of(change.entries.begin(), change.entries.end(), confirms))
  {
    base.erase(MARK);
  }
  if (change.find("range") != nullptr)
  {
    base.erase(RANGE_MARK);
  }
}

/// {bit: 3} over {values: ...}, {nonzero: true} over {bit: 3}: another way to read the place, so the old one goes.
void removeOtherReading(YamlValue& base, const YamlValue& change)
{
  static const std::vector<std::string> READINGS = { "bit", "values", "nonzero" };
  const auto given = [&change](const std::string& key) { return change.find(key) != nullptr; };
  if (std::none_of(READINGS.begin(), READINGS.end(), given))
  {
    return;
  }
  for (const std::string& key : READINGS)
  {
    if (!given(key))
    {
      base.erase(key);
    }
  }
  if (given("bit"))
  {
    base.erase("mask");
  }
}

bool isMark(const YamlEntry& entry)
{
  return (entry.key == MARK || entry.key == RANGE_MARK) && entry.value.kind == YamlValue::Kind::Scalar;
}

void collect(const YamlValue& value, std::set<std::string>& names)
{
  for (const YamlEntry& entry : value.entries)
  {
    if (isMark(entry))
    {
      names.insert(entry.value.text);
    }
    collect(entry.value, names);
  }
  for (const YamlValue& item : value.items)
  {
    collect(item, names);
  }
}

/// {value: unknown}, {register: unknown}: nothing is there that could be confirmed.
bool isUnknown(const YamlValue& map)
{
  return std::any_of(map.entries.begin(), map.entries.end(), [](const YamlEntry& entry) {
    const bool place =
        entry.key == "value" || entry.key == "register" || entry.key == "coil" || entry.key == "variable";
    return place && entry.value.kind == YamlValue::Kind::Scalar && entry.value.text == UNKNOWN;
  });
}

void removeNames(YamlValue& value, const std::set<std::string>& names)
{
  const bool unknown = isUnknown(value);
  const auto confirmed = [&names, unknown](const YamlEntry& entry) {
    return isMark(entry) && !unknown && names.count(entry.value.text) != 0;
  };
  value.entries.erase(std::remove_if(value.entries.begin(), value.entries.end(), confirmed), value.entries.end());
  for (YamlEntry& entry : value.entries)
  {
    removeNames(entry.value, names);
  }
  for (YamlValue& item : value.items)
  {
    removeNames(item, names);
  }
}
}  // namespace

std::set<std::string> unconfirmedNames(const YamlValue& root)
{
  std::set<std::string> names;
  collect(root, names);
  return names;
}

std::map<std::string, std::string> constantMarks(const YamlValue& root)
{
  std::map<std::string, std::string> marks;
  for (const char* group : { "constants", "operation_codes" })
  {
    const YamlValue* constants = root.find(group);
    for (const YamlEntry& entry : constants == nullptr ? std::vector<YamlEntry>() : constants->entries)
    {
      if (const YamlValue* mark = entry.value.find(MARK))
      {
        marks[entry.key] = mark->text;
      }
    }
  }
  return marks;
}

void nameConstants(const YamlValue& root, YamlValue& changes)
{
  const YamlValue* constants = root.find("constants");
  if (constants == nullptr || changes.kind != YamlValue::Kind::Map)
  {
    return;
  }
  YamlValue moved;
  moved.kind = YamlValue::Kind::Map;
  moved.where = changes.where;
  for (auto entry = changes.entries.begin(); entry != changes.entries.end();)
  {
    const bool constant = constants->find(entry->key) != nullptr && root.find(entry->key) == nullptr;
    if (!constant)
    {
      ++entry;
      continue;
    }
    moved.entries.push_back(*entry);
    entry = changes.entries.erase(entry);
  }
  if (moved.entries.empty())
  {
    return;
  }
  if (YamlValue* given = changes.find("constants"))
  {
    given->entries.insert(given->entries.end(), moved.entries.begin(), moved.entries.end());
    return;
  }
  YamlEntry entry;
  entry.key = "constants";
  entry.where = changes.where;
  entry.value = moved;
  changes.entries.push_back(entry);
}

void mergeOverrides(YamlValue& root, const YamlValue& changes)
{
  YamlValue* const value = root.find("value");
  if (root.kind == YamlValue::Kind::Map && value != nullptr && changes.kind == YamlValue::Kind::Scalar)
  {
    // A plain number stands for the whole constant.
    *value = changes;
    root.erase(MARK);
    return;
  }
  if (root.kind != YamlValue::Kind::Map || changes.kind != YamlValue::Kind::Map || changesSpace(root, changes))
  {
    root = changes;
    return;
  }
  removeMarks(root, changes);
  removeOtherReading(root, changes);
  for (const YamlEntry& change : changes.entries)
  {
    if (YamlValue* found = root.find(change.key))
    {
      mergeOverrides(*found, change.value);
    }
    else
    {
      root.entries.push_back(change);
    }
  }
}

void confirm(YamlValue& root, const std::vector<std::string>& names, const std::set<std::string>& known,
             const std::string& place, Problems& problems)
{
  std::set<std::string> confirmed;
  for (const std::string& name : names)
  {
    if (name == "all")
    {
      confirmed = known;
    }
    else if (known.count(name) != 0)
    {
      confirmed.insert(name);
    }
    else
    {
      problems.add(
          place, "confirm",
          "value '" + util::printable(name) +
              "': " + (known.empty() ? "this profile has nothing to confirm" : "allowed: all, " + util::joined(known)));
    }
  }
  removeNames(root, confirmed);
}
}  // namespace drive
}  // namespace inverter_bus

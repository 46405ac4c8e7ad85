// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/profile_overrides.h"

#include <algorithm>
#include <functional>

#include "drive/profile/item_reader.h"
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
bool confirms(const Entry& entry)
{
  static const std::set<std::string> KEYS = {
    "register",         "coil",   "count", "words", "signed", "resolution", "bit", "mask",     "values",
    "nonzero",          "offset", "steps", "text",  "value",  "base",       "of",  "variable", "operation",
    "controller_status"
  };
  return KEYS.count(entry.key) != 0;
}

/// {coil: 5} over {register: 7, words: 2}: another place, so nothing of the old one is left.
bool changesSpace(const Value& base, const Value& change)
{
  static const std::vector<std::string> PLACES = { "register", "coil", "variable", "operation", "controller_status" };
  const auto in = [](const Value& map) {
    return std::find_if(PLACES.begin(), PLACES.end(),
                        [&map](const std::string& key) { return map.find(key) != nullptr; });
  };
  return in(base) != PLACES.end() && in(change) != PLACES.end() && in(base) != in(change);
}

void removeMarks(Value& base, const Value& change)
{
  if (std::any_of(change.map.begin(), change.map.end(), confirms))
  {
    base.erase(MARK);
  }
  if (change.find("range") != nullptr)
  {
    base.erase(RANGE_MARK);
  }
}

/// {bit: 3} over {values: ...}, {nonzero: true} over {bit: 3}: another way to read the place, so the old one goes.
void removeOtherReading(Value& base, const Value& change)
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

bool isMark(const Entry& entry)
{
  return (entry.key == MARK || entry.key == RANGE_MARK) && entry.value.isScalar();
}

void collect(const Value& value, std::set<std::string>& names)
{
  for (const Entry& entry : value.map)
  {
    if (isMark(entry))
    {
      names.insert(entry.value.text);
    }
    collect(entry.value, names);
  }
  for (const Value& item : value.list)
  {
    collect(item, names);
  }
}

/// {value: unknown}, {register: unknown}: nothing is there that could be confirmed.
bool isUnknown(const Value& map)
{
  return std::any_of(map.map.begin(), map.map.end(), [](const Entry& entry) {
    const bool place =
        entry.key == "value" || entry.key == "register" || entry.key == "coil" || entry.key == "variable";
    return place && entry.value.isScalar() && entry.value.text == UNKNOWN;
  });
}

void removeNames(Value& value, const std::set<std::string>& names)
{
  const bool unknown = isUnknown(value);
  const auto confirmed = [&names, unknown](const Entry& entry) {
    return isMark(entry) && !unknown && names.count(entry.value.text) != 0;
  };
  value.map.erase(std::remove_if(value.map.begin(), value.map.end(), confirmed), value.map.end());
  for (Entry& entry : value.map)
  {
    removeNames(entry.value, names);
  }
  for (Value& item : value.list)
  {
    removeNames(item, names);
  }
}
}  // namespace

std::set<std::string> unconfirmedNames(const Value& root)
{
  std::set<std::string> names;
  collect(root, names);
  return names;
}

std::map<std::string, std::string> constantMarks(const Value& root)
{
  std::map<std::string, std::string> marks;
  for (const char* group : { "constants", "operation_codes" })
  {
    const Value* constants = root.find(group);
    for (const Entry& entry : constants == nullptr ? std::vector<Entry>() : constants->map)
    {
      if (const Value* mark = entry.value.find(MARK))
      {
        marks[entry.key] = mark->text;
      }
    }
  }
  return marks;
}

void nameConstants(const Value& root, Value& changes)
{
  const Value* constants = root.find("constants");
  if (constants == nullptr || changes.type != Value::Type::Map)
  {
    return;
  }
  const auto is_constant = [&root, constants](const Entry& entry) {
    return constants->find(entry.key) != nullptr && root.find(entry.key) == nullptr;
  };
  const auto first = std::stable_partition(changes.map.begin(), changes.map.end(), std::not_fn(is_constant));
  const std::vector<Entry> moved(first, changes.map.end());
  changes.map.erase(first, changes.map.end());
  if (moved.empty())
  {
    return;
  }
  if (changes.find("constants") == nullptr)
  {
    Value section = Value::ofMap({});
    section.place = changes.place;
    changes.map.push_back({ "constants", section });
  }
  Value& given = *changes.find("constants");
  given.map.insert(given.map.end(), moved.begin(), moved.end());
}

void mergeOverrides(Value& root, const Value& changes)
{
  Value* const value = root.find("value");
  if (root.type == Value::Type::Map && value != nullptr && changes.isScalar())
  {
    // A plain number stands for the whole constant.
    *value = changes;
    root.erase(MARK);
    return;
  }
  if (root.type != Value::Type::Map || changes.type != Value::Type::Map || changesSpace(root, changes))
  {
    root = changes;
    return;
  }
  removeMarks(root, changes);
  removeOtherReading(root, changes);
  for (const Entry& change : changes.map)
  {
    if (Value* found = root.find(change.key))
    {
      mergeOverrides(*found, change.value);
    }
    else
    {
      root.map.push_back(change);
    }
  }
}

void confirm(Value& root, const std::vector<std::string>& names, const std::set<std::string>& known,
             const std::string& place, config::Complaints& complaints)
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
      complaints.complain(
          { place, "confirm" },
          "value '" + util::printable(name) +
              "': " + (known.empty() ? "this profile has nothing to confirm" : "allowed: all, " + util::joined(known)));
    }
  }
  removeNames(root, confirmed);
}
}  // namespace drive
}  // namespace inverter_bus

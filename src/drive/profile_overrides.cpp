// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "profile_overrides.h"

#include <algorithm>

#include "yaml_reader.h"

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
  static const std::set<std::string> KEYS = { "register", "coil", "count",  "words",  "signed", "resolution",
                                              "bit",      "mask", "values", "offset", "steps",  "text" };
  return KEYS.count(entry.key) != 0;
}

/// {coil: 5} over {register: 7, words: 2}: another place, so nothing of the old one is left.
bool changesSpace(const YamlValue& base, const YamlValue& change)
{
  return (base.find("register") != nullptr && change.find("coil") != nullptr) ||
         (base.find("coil") != nullptr && change.find("register") != nullptr);
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

void removeNames(YamlValue& value, const std::set<std::string>& names)
{
  const auto confirmed = [&names](const YamlEntry& entry) {
    return isMark(entry) && names.count(entry.value.text) != 0;
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

void mergeOverrides(YamlValue& root, const YamlValue& changes)
{
  if (root.kind != YamlValue::Kind::Map || changes.kind != YamlValue::Kind::Map || changesSpace(root, changes))
  {
    root = changes;
    return;
  }
  removeMarks(root, changes);
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
      problems.add(place, "confirm",
                   "value '" + name + "': " +
                       (known.empty() ? "this profile has nothing to confirm" : "allowed: all, " + join(known)));
    }
  }
  removeNames(root, confirmed);
}
}  // namespace drive
}  // namespace inverter_bus

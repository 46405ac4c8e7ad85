// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Sections points, sequences, store_busy, writes: what the driver sends.

#include <algorithm>

#include "profile_builder.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
constexpr double MAX_PAUSE = 10.0;

const std::vector<std::string>& sequenceNames()
{
  static const std::vector<std::string> NAMES = { "forward", "reverse", "stop",    "coast",
                                                  "quick",   "reset",   "release", "store" };
  return NAMES;
}

void readPoint(const std::string& name, const YamlCursor& cursor, const Numbering& numbering, Profile& profile)
{
  ItemRules rules;
  YamlMap map(cursor);
  const auto item = readItem(map, numbering, rules);
  map.finish();
  if (map.has("mask"))
  {
    cursor.complain("mask is for reading; a point is written as a whole");
  }
  if (item)
  {
    profile.points[name] = Point{ name, *item };
    if (!item->unconfirmed.empty())
    {
      profile.unconfirmed.insert(item->unconfirmed);
    }
  }
}

/// {run: 1}, {frequency: setpoint}, {trip_reset: 1, pause: 0.1}
void readStep(const YamlCursor& cursor, Sequence& sequence)
{
  Step step;
  std::size_t points = 0;
  for (const auto& [key, value] : cursor.entries())
  {
    if (key == "pause")
    {
      step.pause = value.number(0.0, MAX_PAUSE).value_or(0.0);
      continue;
    }
    ++points;
    step.point = key;
    if (value.value().text == "setpoint")
    {
      if (key != "frequency")
      {
        value.complain("setpoint is the value of the point frequency only");
      }
    }
    else
    {
      step.value = static_cast<std::uint32_t>(value.integer(0, 0xFFFFFFFFLL).value_or(0));
    }
  }
  if (cursor.isMap() && points != 1)
  {
    cursor.complain("a step names exactly one point, and may have a pause");
    return;
  }
  if (points == 1)
  {
    sequence.steps.push_back(step);
  }
}

void readSequence(const std::string& name, const YamlCursor& cursor, Profile& profile)
{
  Sequence sequence;
  std::optional<YamlCursor> steps = cursor;
  if (cursor.isMap())
  {
    YamlMap map(cursor);
    steps = map.require("steps");
    sequence.unconfirmed = map.name("unconfirmed");
    map.text("source");
    map.finish();
  }
  if (!steps)
  {
    return;
  }
  for (const YamlCursor& step : steps->list())
  {
    readStep(step, sequence);
  }
  if (steps->isList() && steps->value().items.empty())
  {
    steps->complain("has no steps");
  }
  if (!sequence.unconfirmed.empty())
  {
    profile.unconfirmed.insert(sequence.unconfirmed);
  }
  profile.sequences[name] = sequence;
}

void readSequences(const YamlCursor& cursor, Profile& profile)
{
  const auto& names = sequenceNames();
  for (const auto& [name, sequence] : cursor.entries())
  {
    if (std::find(names.begin(), names.end(), name) == names.end())
    {
      sequence.complain("unknown key: allowed: " + join(names));
      continue;
    }
    readSequence(name, sequence, profile);
  }
}

void readStoreBusy(YamlMap& root, const Numbering& numbering, Profile& profile)
{
  const auto cursor = root.find("store_busy");
  if (!cursor)
  {
    return;
  }
  ItemRules rules;
  rules.bit = true;
  rules.scale = false;
  YamlMap map(*cursor);
  profile.store_busy = readItem(map, numbering, rules);
  map.finish();
  if (profile.store_busy && !profile.store_busy->unconfirmed.empty())
  {
    profile.unconfirmed.insert(profile.store_busy->unconfirmed);
  }
}
}  // namespace

void readCommands(YamlMap& root, const Numbering& numbering, Profile& profile)
{
  if (const auto cursor = root.require("points"))
  {
    for (const auto& [name, point] : cursor->entries())
    {
      if (name == "pause")
      {
        point.complain("'pause' is a word of the sequences: allowed: any other name");
        continue;
      }
      readPoint(name, point, numbering, profile);
    }
  }
  if (const auto cursor = root.require("sequences"))
  {
    readSequences(*cursor, profile);
  }
  readStoreBusy(root, numbering, profile);
  if (const auto cursor = root.find("writes"))
  {
    profile.writes_reach_eeprom = cursor->choice({ "ram", "eeprom" }).value_or("ram") == "eeprom";
  }
}
}  // namespace drive
}  // namespace inverter_bus

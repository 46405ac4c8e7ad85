// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Sections points, sequences, store_busy, writes: what the driver sends.

#include <algorithm>
#include <cmath>

#include "drive/profile/profile_builder.h"
#include "drive/profile/units.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
constexpr double MAX_PAUSE = 10.0;

const std::vector<std::string>& sequenceNames()
{
  static const std::vector<std::string> NAMES = { "forward", "reverse", "stop",    "coast",      "quick",      "reset",
                                                  "release", "store",   "connect", "open_setup", "close_setup" };
  return NAMES;
}

void readPoint(const std::string& name, const Cursor& cursor, const Numbering& numbering, Profile& profile)
{
  ItemRules rules;
  rules.written = true;
  Section map(cursor);
  const auto item = readItem(map, numbering, rules);
  const bool wears = map.flag("wears", false);
  map.finish();
  const std::string unit_mistake = item && name == "frequency" ? unitMistake("output_frequency", *item) : "";
  if (!unit_mistake.empty())
  {
    // Not harmless: the motor would turn at another speed than commanded.
    cursor.complain(unit_mistake);
  }
  if (map.has("mask"))
  {
    cursor.complain("mask is for reading; a point is written as a whole");
  }
  if (item)
  {
    profile.points[name] = Point{ name, *item, wears };
    if (!item->unconfirmed.empty())
    {
      profile.unconfirmed.insert(item->unconfirmed);
    }
  }
}

/// The number behind a name of the sections constants and operation_codes.
bool readNamedValue(const Cursor& value, const Numbering& numbering, Step& step)
{
  const auto constant = numbering.constants.find(value.value().text);
  if (!value.value().isScalar() || constant == numbering.constants.end())
  {
    return false;
  }
  step.unconfirmed = constant->second.unconfirmed;
  const double number = constant->second.value.value_or(0.0);
  if (number != std::floor(number) || number < 0.0 || number > 4294967295.0)
  {
    value.complaints().complain({ constant->second.place, constant->second.key },
                                "value " + util::exactText(number) + ": allowed: an integer of 0 or more");
    return true;
  }
  step.value = static_cast<std::uint32_t>(number);
  return true;
}

/// {run: 1}, {frequency: setpoint}, {trip_reset: 1, pause: 0.1}, {command: 0xE000, reply: none}
void readStep(const Cursor& cursor, const Numbering& numbering, Sequence& sequence)
{
  Step step;
  std::size_t points = 0;
  for (const auto& [key, value] : cursor.entries())
  {
    if (key == "pause")
    {
      step.pause = value.number({ 0.0, MAX_PAUSE }).value_or(0.0);
      continue;
    }
    if (key == "reply")
    {
      step.expects_reply = !value.choice({ "none" });
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
    else if (!readNamedValue(value, numbering, step))
    {
      step.value = static_cast<std::uint32_t>(value.integer(0, 0xFFFFFFFFLL).value_or(0));
    }
  }
  if (cursor.isMap() && points != 1)
  {
    cursor.complain("a step names exactly one point, and may have pause and reply");
    return;
  }
  if (points == 1)
  {
    sequence.steps.push_back(step);
  }
}

void readSequence(const std::string& name, const Cursor& cursor, const Numbering& numbering, Profile& profile)
{
  Sequence sequence;
  std::optional<Cursor> steps = cursor;
  if (cursor.isMap())
  {
    Section map(cursor);
    steps = map.require("steps");
    sequence.unconfirmed = map.name("unconfirmed");
    map.text("source");
    map.finish();
  }
  if (!steps)
  {
    return;
  }
  for (const Cursor& step : steps->list())
  {
    readStep(step, numbering, sequence);
  }
  if (steps->isList() && steps->value().list.empty())
  {
    steps->complain("has no steps");
  }
  if (!sequence.unconfirmed.empty())
  {
    profile.unconfirmed.insert(sequence.unconfirmed);
  }
  profile.sequences[name] = sequence;
}

void readSequences(const Cursor& cursor, const Numbering& numbering, Profile& profile)
{
  const auto& names = sequenceNames();
  for (const auto& [name, sequence] : cursor.entries())
  {
    if (std::find(names.begin(), names.end(), name) == names.end())
    {
      sequence.complain("unknown key: allowed: " + util::joined(names));
      continue;
    }
    readSequence(name, sequence, numbering, profile);
  }
}

void readStoreBusy(Section& root, const Numbering& numbering, Profile& profile)
{
  const auto cursor = root.find("store_busy");
  if (!cursor)
  {
    return;
  }
  ItemRules rules;
  rules.bit = true;
  rules.scale = false;
  Section map(*cursor);
  profile.store_busy = readItem(map, numbering, rules);
  map.finish();
  if (profile.store_busy && !profile.store_busy->unconfirmed.empty())
  {
    profile.unconfirmed.insert(profile.store_busy->unconfirmed);
  }
}
}  // namespace

void readCommands(Section& root, const Numbering& numbering, Profile& profile)
{
  if (const auto cursor = root.require("points"))
  {
    for (const auto& [name, point] : cursor->entries())
    {
      if (name == "pause" || name == "reply")
      {
        point.complain("'" + name + "' is a keyword of the sequences: allowed: any other name");
        continue;
      }
      readPoint(name, point, numbering, profile);
    }
  }
  if (const auto cursor = root.require("sequences"))
  {
    readSequences(*cursor, numbering, profile);
  }
  readStoreBusy(root, numbering, profile);
  if (const auto cursor = root.find("writes"))
  {
    const std::string writes = cursor->choice({ "ram", "eeprom", "unknown" }).value_or("ram");
    profile.writes = writes == "ram" ? Writes::Ram : writes == "eeprom" ? Writes::Eeprom : Writes::Unknown;
  }
}
}  // namespace drive
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Checks across the sections of a profile.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <tuple>
#include <vector>

#include "drive/profile/numbers.h"
#include "drive/profile/profile_builder.h"
#include "drive/profile/status_fields.h"
#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
void checkSteps(const std::string& name, const Sequence& sequence, const Profile& profile, const Cursor& place)
{
  for (const Step& step : sequence.steps)
  {
    const auto point = profile.points.find(step.point);
    if (point == profile.points.end())
    {
      std::vector<std::string> names;
      for (const auto& entry : profile.points)
      {
        names.push_back(entry.first);
      }
      place.complain("the step names the unknown point '" + step.point + "': allowed: " + util::joined(names));
    }
    else if (step.value && *step.value > largestRaw(point->second.item))
    {
      place.complain("value " + std::to_string(*step.value) + " of the step '" + step.point + "': allowed: 0 to " +
                     std::to_string(largestRaw(point->second.item)));
    }
  }
  const bool moves = name == "forward" || name == "reverse";
  if (moves && profile.sequences.count("stop") == 0)
  {
    place.complain("can start a motor, but the sequence stop is missing: must be given");
  }
}

void checkSetpoint(const Value& root, const Profile& profile, config::Complaints& complaints)
{
  const auto point = profile.points.find("frequency");
  if (point == profile.points.end())
  {
    return;
  }
  const Item& item = point->second.item;
  const double counts = toCounts(profile.maximum_frequency, item.resolution);
  if (item.space == Space::Coil || item.space == Space::Operation || counts > largestRaw(item) || counts < 1.0)
  {
    locate(root, "points.frequency", complaints)
        .complain("frequency.maximum " + util::exactText(profile.maximum_frequency) + " Hz is " +
                  util::exactText(counts) + " counts: must fit into the register");
  }
}

void checkParameterName(const Value& root, const std::string& key, const std::string& name, const Profile& profile,
                        config::Complaints& complaints)
{
  if (!name.empty() && profile.parameters.count(name) == 0)
  {
    locate(root, key, complaints)
        .complain("value '" + util::printable(name) + "': allowed: a name of the section parameters");
  }
}

/// Times are compared with seconds, so their parameters must come in a unit that can be.
void checkUnit(const Value& root, const std::string& key, const std::string& name,
               const std::vector<std::string>& units, const Profile& profile, config::Complaints& complaints)
{
  const auto parameter = profile.parameters.find(name);
  if (parameter == profile.parameters.end())
  {
    return;
  }
  const std::string& unit = parameter->second.item.unit;
  if (std::find(units.begin(), units.end(), unit) == units.end())
  {
    const Cursor place = locate(root, key, complaints);
    place.complain("value '" + util::printable(name) + "': a parameter with the unit '" + unit +
                   "': allowed: " + util::joined(units));
  }
}

void checkExpectations(const Value& root, const std::string& key, const std::vector<Expectation>& expectations,
                       const Profile& profile, config::Complaints& complaints)
{
  for (const Expectation& expectation : expectations)
  {
    checkParameterName(root, key, expectation.parameter, profile, complaints);
  }
}

/// A parameter that needs the setup area needs commands that lead into it and out of it again.
void checkSetupParameters(const Value& root, const Profile& profile, config::Complaints& complaints)
{
  for (const auto& [name, parameter] : profile.parameters)
  {
    const bool both = profile.sequences.count("open_setup") != 0 && profile.sequences.count("close_setup") != 0;
    if (parameter.setup && !both)
    {
      locate(root, "parameters." + name, complaints)
          .complain("setup needs the sequences open_setup and close_setup: must be given");
    }
  }
}

/// Which abilities of the drive an item needs.
class Abilities
{
public:
  Abilities(const Value& root, const Profile& profile, config::Complaints& complaints)
    : root_(root), profile_(profile), complaints_(complaints)
  {
  }

  void needRead(const std::string& key, const Item& item) const
  {
    if (profile_.protocol == "compoway_f")
    {
      need(key, { item.space == Space::ControllerStatus ? 0x0601U : 0x0101U });
      return;
    }
    const bool coil = item.space == Space::Coil;
    need(key, { coil ? 0x01U : 0x03U });
    const unsigned limit = coil ? profile_.read_coils : profile_.read_registers;
    if (item.size > limit)
    {
      at(key).complain("needs a read of " + std::to_string(item.size) + (coil ? " coils" : " registers") +
                       ": limits allow " + std::to_string(limit));
    }
  }

  void needWrite(const std::string& key, const Item& item) const
  {
    if (profile_.protocol == "compoway_f")
    {
      need(key, { item.space == Space::Operation ? 0x3005U : 0x0102U });
      return;
    }
    if (item.space == Space::Coil)
    {
      need(key, { 0x05, 0x0F });
    }
    else if (item.size == 1)
    {
      need(key, { 0x06, 0x10 });
    }
    else
    {
      need(key, { 0x10 });
      if (profile_.write_registers < item.size)
      {
        at(key).complain("needs a write of " + std::to_string(item.size) + " registers: limits allow " +
                         std::to_string(profile_.write_registers));
      }
    }
  }

private:
  Cursor at(const std::string& key) const
  {
    return locate(root_, key, complaints_);
  }

  void need(const std::string& key, const std::vector<unsigned>& any_of) const
  {
    const auto has = [this](unsigned function) { return profile_.functions.count(function) != 0; };
    if (std::none_of(any_of.begin(), any_of.end(), has))
    {
      std::vector<std::string> names;
      std::transform(any_of.begin(), any_of.end(), std::back_inserter(names), util::hexNumber);
      const bool services = profile_.protocol == "compoway_f";
      at(key).complain("needs " + std::string(services ? "service " : "function ") + util::joined(names, " or ") +
                       ": limits." + (services ? "services" : "functions") + " lacks it");
    }
  }

  const Value& root_;
  const Profile& profile_;
  config::Complaints& complaints_;
};

bool overlap(const Item& a, const Item& b)
{
  return !a.missing && !b.missing && a.space == b.space && a.area == b.area && a.number < b.number + b.size &&
         b.number < a.number + a.size;
}

bool inCommandArea(const Item& item, const Profile& profile)
{
  for (const auto& span : profile.command_registers)
  {
    if (!item.missing && item.space == Space::Register && item.number <= span.second &&
        item.number + item.size > span.first)
    {
      return true;
    }
  }
  return std::any_of(profile.points.begin(), profile.points.end(),
                     [&item](const auto& point) { return overlap(point.second.item, item); });
}

void checkPointOverlaps(const Value& root, const Profile& profile, config::Complaints& complaints)
{
  for (auto a = profile.points.begin(); a != profile.points.end(); ++a)
  {
    for (auto b = std::next(a); b != profile.points.end(); ++b)
    {
      if (overlap(a->second.item, b->second.item))
      {
        locate(root, "points." + b->first, complaints)
            .complain("lies on the point '" + a->first + "': allowed: a place of its own");
      }
    }
  }
}

void checkParameterOverlaps(const Value& root, const Profile& profile, config::Complaints& complaints)
{
  std::vector<const Parameter*> sorted;
  for (const auto& entry : profile.parameters)
  {
    sorted.push_back(&entry.second);
    if (!entry.second.read_only && inCommandArea(entry.second.item, profile))
    {
      locate(root, "parameters." + entry.first, complaints)
          .complain("lies on a command register, which is never writable as a parameter: needs read_only: true");
    }
  }
  std::sort(sorted.begin(), sorted.end(), [](const Parameter* a, const Parameter* b) {
    return std::tie(a->item.area, a->item.number) < std::tie(b->item.area, b->item.number);
  });
  for (std::size_t i = 1; i < sorted.size(); ++i)
  {
    if (overlap(sorted[i - 1]->item, sorted[i]->item))
    {
      locate(root, "parameters." + sorted[i]->name, complaints)
          .complain("register " + util::hexNumber(sorted[i]->item.number) + " belongs to '" + sorted[i - 1]->name +
                    "' (" + util::hexNumber(sorted[i - 1]->item.number) + ", " +
                    std::to_string(sorted[i - 1]->item.size) + " words): allowed: a place of its own");
    }
  }
}

/// Two flags on one bit are nearly always a slip of the pen; `shared: true` says that it is meant.
void checkFlagOverlaps(const Value& root, const Profile& profile, config::Complaints& complaints)
{
  const auto is_flag = [](const std::string& field) { return flagFields().count(field) != 0; };
  for (auto a = profile.status.begin(); a != profile.status.end(); ++a)
  {
    for (auto b = std::next(a); b != profile.status.end(); ++b)
    {
      const bool same_bit = overlap(a->second, b->second) && a->second.bit == b->second.bit &&
                            a->second.values == b->second.values && a->second.mask == b->second.mask;
      const Cursor place = locate(root, "status." + b->first, complaints);
      if (is_flag(a->first) && is_flag(b->first) && same_bit && place.value().find("shared") == nullptr &&
          locate(root, "status." + a->first, complaints).value().find("shared") == nullptr)
      {
        place.complain("is the same bit as '" + a->first + "': allowed: a bit of its own, or shared: true");
      }
    }
  }
}
}  // namespace

void checkReferences(const Value& root, const Profile& profile, config::Complaints& complaints)
{
  for (const auto& [name, sequence] : profile.sequences)
  {
    checkSteps(name, sequence, profile, locate(root, "sequences." + name, complaints));
  }
  checkSetpoint(root, profile, complaints);
  checkExpectations(root, "identity", profile.identity, profile, complaints);
  checkExpectations(root, "command_source", profile.command_source, profile, complaints);
  checkExpectations(root, "self_restart", profile.self_restart, profile, complaints);
  checkParameterName(root, "ratings.current", profile.rated_current_parameter, profile, complaints);
  checkParameterName(root, "ratings.voltage", profile.rated_voltage_parameter, profile, complaints);
  checkUnit(root, "ratings.current", profile.rated_current_parameter, { "A" }, profile, complaints);
  checkUnit(root, "ratings.voltage", profile.rated_voltage_parameter, { "V" }, profile, complaints);
  checkSetupParameters(root, profile, complaints);
  const CommunicationLoss& loss = profile.communication_loss;
  checkParameterName(root, "communication_loss.timeout_parameter", loss.timeout_parameter, profile, complaints);
  checkParameterName(root, "communication_loss.action_parameter", loss.action_parameter, profile, complaints);
  checkParameterName(root, "timing.reply_delay_parameter", profile.reply_delay_parameter, profile, complaints);
  checkUnit(root, "communication_loss.timeout_parameter", loss.timeout_parameter, { "s" }, profile, complaints);
  checkUnit(root, "timing.reply_delay_parameter", profile.reply_delay_parameter, { "s", "ms" }, profile, complaints);
}

void checkAbilities(const Value& root, const Profile& profile, config::Complaints& complaints)
{
  const Abilities abilities(root, profile, complaints);
  for (const auto& [name, point] : profile.points)
  {
    abilities.needWrite("points." + name, point.item);
  }
  for (const auto& [field, item] : profile.status)
  {
    abilities.needRead("status." + field, item);
  }
  for (const auto& entry : profile.history.entries)
  {
    for (const auto& [field, item] : entry)
    {
      abilities.needRead("faults.history", item);
    }
  }
  for (const auto& [name, parameter] : profile.parameters)
  {
    abilities.needRead("parameters." + name, parameter.item);
    if (!parameter.read_only)
    {
      abilities.needWrite("parameters." + name, parameter.item);
    }
  }
  if (profile.store_busy)
  {
    abilities.needRead("store_busy", *profile.store_busy);
  }
  const bool asks = std::any_of(profile.status.begin(), profile.status.end(), [&profile](const auto& entry) {
    const bool fast = profile.slow.count(entry.first) == 0 && profile.when_faulted.count(entry.first) == 0;
    return fast && entry.second.unconfirmed.empty();
  });
  if (profile.keep_alive)
  {
    abilities.needRead("keep_alive", *profile.keep_alive);
  }
  else if (!asks)
  {
    locate(root, "status", complaints)
        .complain(
            "has no confirmed field that is read in every refresh: needs one (that is not left out), or keep_alive");
  }
}

void checkBlock(const Value& root, const Profile& profile, config::Complaints& complaints)
{
  if (!profile.block)
  {
    return;
  }
  const Block& block = *profile.block;
  for (const std::string& name : block.read_slots)
  {
    checkParameterName(root, "block.read.slots", name, profile, complaints);
  }
  for (const std::string& name : block.write_slots)
  {
    checkParameterName(root, "block.write.slots", name, profile, complaints);
  }
  checkParameterName(root, "block.apply.parameter", block.apply_parameter, profile, complaints);
  for (const auto& entry : block.select)
  {
    if (profile.points.count(entry.first) == 0)
    {
      locate(root, "block.write.select", complaints)
          .complain("names the unknown point '" + entry.first + "': allowed: a name of the section points");
    }
  }
  for (const unsigned function : { 0x03U, 0x10U, 0x17U })
  {
    if (profile.functions.count(function) == 0)
    {
      locate(root, "block", complaints)
          .complain("needs function " + util::hexNumber(function) + ": limits.functions lacks it");
    }
  }
}

void checkMap(const Value& root, const Profile& profile, config::Complaints& complaints)
{
  if (!profile.map)
  {
    return;
  }
  const RegisterMap& map = *profile.map;
  if (map.read.size > profile.read_registers)
  {
    locate(root, "map.read", complaints)
        .complain("reads more registers than limits.read_registers allows (" + std::to_string(profile.read_registers) +
                  ")");
  }
  for (const MirroredCoils& word : map.words)
  {
    const bool inside = word.number >= map.read.number && word.number < map.read.number + map.read.size;
    const bool in_table = std::any_of(map.table.begin(), map.table.end(),
                                      [&word](const auto& entry) { return entry.second == word.number; });
    if (!inside || !in_table)
    {
      locate(root, "map.words", complaints)
          .complain("register " + util::hexNumber(word.number) +
                    (inside ? ": the table lays nothing over it" : ": is not in the read of the map"));
    }
  }
  if (profile.block)
  {
    locate(root, "map", complaints).complain("stands beside a section block: allowed: one of them");
  }
}

void checkOverlaps(const Value& root, const Profile& profile, config::Complaints& complaints)
{
  checkPointOverlaps(root, profile, complaints);
  checkParameterOverlaps(root, profile, complaints);
  checkFlagOverlaps(root, profile, complaints);
}
}  // namespace drive
}  // namespace inverter_bus

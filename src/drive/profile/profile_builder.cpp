// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/profile_builder.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "drive/profile/units.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
/// An unconfirmed parameter isn't read: what depends on it then uses the assumed values.
void dropIfUnconfirmed(std::string& name, const Profile& profile)
{
  const auto parameter = profile.parameters.find(name);
  if (parameter != profile.parameters.end() && !parameter->second.item.unconfirmed.empty())
  {
    name.clear();
  }
}

void settleUnconfirmed(Profile& profile)
{
  dropIfUnconfirmed(profile.communication_loss.timeout_parameter, profile);
  dropIfUnconfirmed(profile.communication_loss.action_parameter, profile);
  dropIfUnconfirmed(profile.reply_delay_parameter, profile);
  dropIfUnconfirmed(profile.rated_current_parameter, profile);
  dropIfUnconfirmed(profile.rated_voltage_parameter, profile);
  for (const std::string& name : profile.unconfirmed)
  {
    profile.unconfirmed_tables.erase(name);
  }
}
}  // namespace

Profile buildProfile(const Value& root, Problems& problems)
{
  Profile profile;
  Section map(Cursor(root, "", problems));
  Numbering numbering = readNumbering(map);
  profile.first_register = static_cast<unsigned>(numbering.lowest(Space::Register));
  profile.decimal_numbers = numbering.decimal;
  readConstants(map, numbering, profile);
  readIdentity(map, profile);
  readLine(map, profile);
  readLimits(map, numbering, profile);
  readTiming(map, profile);
  readCommands(map, numbering, profile);
  readStatus(map, numbering, profile);
  readFaults(map, numbering, profile);
  readParameters(map, numbering, profile);
  readBlock(map, numbering, profile);
  readMap(map, numbering, profile);
  readRatings(map, profile);
  readSupervision(map, profile);
  map.finish();
  if (problems.empty())
  {
    // Only on a complete profile: after a mistake these would report what merely follows from it.
    checkReferences(root, profile, problems);
    checkAbilities(root, profile, problems);
    checkBlock(root, profile, problems);
    checkMap(root, profile, problems);
    checkOverlaps(root, profile, problems);
    settleUnconfirmed(profile);
  }
  return profile;
}

bool leftOutForUnit(const std::string& field, const Item& item, const Cursor& cursor, Profile& profile)
{
  const std::string mistake = unitMistake(field, item);
  if (mistake.empty())
  {
    return false;
  }
  // With more of them than these, the first ones are corrected first.
  constexpr std::size_t MOST_MISTAKES = 50;
  if (profile.mistakes.size() < MOST_MISTAKES)
  {
    profile.mistakes.push_back(config::lineOf(cursor.spot(), mistake + "; it is not shown until this is corrected"));
  }
  return true;
}

unsigned Profile::position(std::uint16_t number) const
{
  if (!decimal_numbers)
  {
    return number;
  }
  // E6581913 p68: after FD09 comes FD10.
  return (number >> 8U) * 100U + ((number >> 4U) & 0xFU) * 10U + (number & 0xFU);
}

Cursor locate(const Value& root, const std::string& path, config::Complaints& complaints)
{
  const Value* value = &root;
  std::size_t start = 0;
  while (start <= path.size())
  {
    const std::size_t dot = std::min(path.find('.', start), path.size());
    const Value* next = value->find(path.substr(start, dot - start));
    if (next == nullptr)
    {
      break;
    }
    value = next;
    start = dot + 1;
  }
  return Cursor(*value, path, complaints);
}
}  // namespace drive
}  // namespace inverter_bus

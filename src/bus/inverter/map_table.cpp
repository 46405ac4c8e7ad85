// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/map_table.h"

#include <algorithm>

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
MapTable::MapTable(const drive::Drive& drive, bool wanted)
  : drive_(drive), reads_(wanted ? drive.mapTableReads() : std::vector<drive::ReadBlock>())
{
}

void MapTable::restart()
{
  next_ = 0;
  refused_ = false;
  values_.clear();
}

const drive::ReadBlock* MapTable::next() const
{
  return refused_ || next_ >= reads_.size() ? nullptr : &reads_[next_];
}

void MapTable::done(const wire::Reply& reply)
{
  const drive::ReadBlock* read = next();
  if (read == nullptr || !isAnswered(reply))
  {
    return;
  }
  if (reply.outcome == wire::Outcome::Exception)
  {
    refused_ = true;
    return;
  }
  for (const auto& entry : drive_.profile().map->table)
  {
    if (const auto value = drive_.mapEntry(entry.first, *read, reply.pdu))
    {
      values_[entry.first] = *value;
    }
  }
  ++next_;
}

bool MapTable::known() const
{
  return !reads_.empty() && next_ >= reads_.size() && values_.size() == drive_.profile().map->table.size();
}

bool MapTable::refused() const
{
  return refused_;
}

bool MapTable::fits() const
{
  return known() && differences().empty();
}

bool MapTable::inOtherUse() const
{
  if (!known())
  {
    return false;
  }
  const auto& table = drive_.profile().map->table;
  const auto foreign = [this](const auto& entry) {
    const std::uint32_t value = values_.at(entry.first);
    return value != 0 && value != entry.second;
  };
  const auto& switched_by = table.back();
  return values_.at(switched_by.first) == switched_by.second && std::any_of(table.begin(), table.end(), foreign);
}

std::vector<std::pair<std::string, std::uint32_t>> MapTable::differences() const
{
  std::vector<std::pair<std::string, std::uint32_t>> found;
  for (const auto& entry : drive_.profile().map->table)
  {
    const auto value = values_.find(entry.first);
    if (value == values_.end() || value->second != entry.second)
    {
      found.push_back(entry);
    }
  }
  return found;
}

bool MapTable::has(const std::string& parameter) const
{
  const auto& map = drive_.profile().map;
  return map && std::any_of(map->table.begin(), map->table.end(),
                            [&parameter](const auto& entry) { return entry.first == parameter; });
}

std::string MapTable::text() const
{
  return differing(false);
}

std::string MapTable::wantedText() const
{
  return differing(true);
}

std::string MapTable::differing(bool wanted) const
{
  std::vector<std::string> parts;
  for (const auto& entry : drive_.profile().map->table)
  {
    const std::uint32_t value = values_.at(entry.first);
    if (value != entry.second)
    {
      parts.push_back(entry.first + " = " + util::hexNumber(wanted ? entry.second : value));
    }
  }
  return util::joined(parts);
}
}  // namespace bus
}  // namespace inverter_bus

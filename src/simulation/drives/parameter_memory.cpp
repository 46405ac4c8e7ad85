// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/parameter_memory.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace inverter_bus
{
namespace simulation
{
constexpr ParameterMemory::Index ParameterMemory::NONE;

ParameterMemory::ParameterMemory(std::vector<Parameter> table) : table_(std::move(table))
{
  for (Index index = 0; index < table_.size(); ++index)
  {
    const Parameter& parameter = table_[index];
    bool fresh = by_code_.emplace(parameter.code, index).second;
    for (int word = 0; word < parameter.words; ++word)
    {
      fresh = by_number_.emplace(static_cast<std::uint16_t>(parameter.number + word), index).second && fresh;
    }
    if (!fresh)
    {
      throw std::invalid_argument("parameter " + parameter.code + " is in the table twice, or its register is");
    }
    ram_.push_back(parameter.initial);
  }
  eeprom_ = ram_;
}

ParameterMemory::Index ParameterMemory::find(const std::string& code) const
{
  const auto found = by_code_.find(code);
  return found == by_code_.end() ? NONE : found->second;
}

ParameterMemory::Index ParameterMemory::at(std::uint16_t number) const
{
  const auto found = by_number_.find(number);
  return found == by_number_.end() ? NONE : found->second;
}

const Parameter& ParameterMemory::info(Index index) const
{
  return table_[index];
}

std::uint32_t ParameterMemory::ram(Index index) const
{
  return ram_[index];
}

std::uint32_t ParameterMemory::eeprom(Index index) const
{
  return eeprom_[index];
}

bool ParameterMemory::accepts(Index index, std::uint32_t raw) const
{
  const Parameter& parameter = table_[index];
  if (raw < parameter.minimum || raw > parameter.maximum)
  {
    return false;
  }
  return parameter.allowed == 0 || (raw < 32 && ((parameter.allowed >> raw) & 1U) != 0);
}

void ParameterMemory::writeRam(Index index, std::uint32_t raw)
{
  ram_[index] = raw;
}

void ParameterMemory::writeBoth(Index index, std::uint32_t raw)
{
  commission(index, raw);
  ++eeprom_writes_;
  ++stored_values_;
}

void ParameterMemory::commission(Index index, std::uint32_t raw)
{
  ram_[index] = raw;
  eeprom_[index] = raw;
}

void ParameterMemory::store()
{
  stored_values_ += ramChanges();
  eeprom_ = ram_;
  ++eeprom_writes_;
}

void ParameterMemory::reload()
{
  ram_ = eeprom_;
}

std::size_t ParameterMemory::ramChanges() const
{
  std::size_t changes = 0;
  for (Index index = 0; index < table_.size(); ++index)
  {
    changes += ram_[index] != eeprom_[index] ? 1 : 0;
  }
  return changes;
}

std::uint64_t ParameterMemory::eepromWrites() const
{
  return eeprom_writes_;
}

std::uint64_t ParameterMemory::storedValues() const
{
  return stored_values_;
}

std::string panelText(const Parameter& parameter, std::uint32_t raw)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.*f", parameter.decimals, raw / std::pow(10.0, parameter.decimals));
  return text;
}
}  // namespace simulation
}  // namespace inverter_bus

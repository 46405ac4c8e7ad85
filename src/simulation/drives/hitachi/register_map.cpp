// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/hitachi/register_map.h"

#include <algorithm>
#include <cmath>

namespace inverter_bus
{
namespace simulation
{
namespace
{
// Registers as printed.
constexpr std::uint16_t P200 = 0x16C8;
constexpr std::uint16_t P201 = 0x16C9;
constexpr std::uint16_t P211 = 0x16D3;
constexpr std::uint16_t P221 = 0x16DD;
constexpr std::uint16_t P301 = 0x16E7;
constexpr int SLOTS = 10;
constexpr double RATIO_STEP = 0.001;

double numberOf(std::uint16_t word, bool has_sign)
{
  return has_sign ? static_cast<double>(static_cast<std::int16_t>(word)) : static_cast<double>(word);
}

double lowest(bool has_sign)
{
  return has_sign ? -32768.0 : 0.0;
}

double highest(bool has_sign)
{
  return has_sign ? 32767.0 : 65535.0;
}

std::uint16_t wordOf(double number)
{
  return static_cast<std::uint16_t>(std::lround(number) & 0xFFFF);
}
}  // namespace

std::uint16_t RegisterMap::Slot::shown(std::uint16_t internal_value) const
{
  const double value = numberOf(internal_value, has_sign) / ratio;
  return wordOf(std::min(std::max(value, lowest(has_sign)), highest(has_sign)));
}

std::optional<std::uint16_t> RegisterMap::Slot::taken(std::uint16_t external_value) const
{
  const double value = std::round(numberOf(external_value, has_sign) * ratio);
  const bool fits = value >= lowest(has_sign) && value <= highest(has_sign);
  return fits ? std::optional<std::uint16_t>(wordOf(value)) : std::nullopt;
}

void RegisterMap::latch(const ParameterMemory& memory)
{
  slots_.clear();
  twice_.clear();
  const auto word = [&memory](int number) {
    return static_cast<std::uint16_t>(memory.ram(memory.at(static_cast<std::uint16_t>(number))));
  };
  if (memory.at(P200) == ParameterMemory::NONE || word(P200) != 1)
  {
    return;
  }
  for (int i = 0; i < SLOTS; ++i)
  {
    const std::uint16_t external = word(P201 + i);
    const Slot slot{ word(P301 + i), word(P211 + i) == 1, word(P221 + i) * RATIO_STEP };
    if (external != 0 && !slots_.emplace(external, slot).second)
    {
      twice_.insert(external);
    }
  }
}

bool RegisterMap::on() const
{
  return !slots_.empty();
}

bool RegisterMap::covers(std::uint16_t number) const
{
  return slots_.count(number) != 0;
}

const RegisterMap::Slot* RegisterMap::slot(std::uint16_t number) const
{
  const auto found = slots_.find(number);
  const bool good = found != slots_.end() && found->second.internal != 0 && twice_.count(number) == 0;
  return good ? &found->second : nullptr;
}
}  // namespace simulation
}  // namespace inverter_bus

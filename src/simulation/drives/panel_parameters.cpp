// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/panel_parameters.h"

#include <cmath>
#include <stdexcept>

namespace inverter_bus
{
namespace simulation
{
namespace
{
double stepsPerUnit(const Parameter& parameter)
{
  return std::pow(10.0, parameter.decimals);
}

/// @return the raw value, or nothing when the parameter doesn't take it
std::optional<std::uint32_t> rawOf(const ParameterMemory& memory, ParameterMemory::Index index, double value)
{
  const double raw = std::round(value * stepsPerUnit(memory.info(index)));
  const bool fits = raw >= 0.0 && raw <= 4294967295.0 && memory.accepts(index, static_cast<std::uint32_t>(raw));
  return fits ? std::optional<std::uint32_t>(static_cast<std::uint32_t>(raw)) : std::nullopt;
}

std::string rangeOf(const Parameter& parameter)
{
  return "(" + panelText(parameter, parameter.minimum) + "-" + panelText(parameter, parameter.maximum) + ")";
}
}  // namespace

double panelValue(const ParameterMemory& memory, ParameterMemory::Index index)
{
  return memory.ram(index) / stepsPerUnit(memory.info(index));
}

void commissionAtPanel(ParameterMemory& memory, const std::string& model, const std::string& code, double value)
{
  const ParameterMemory::Index index = memory.find(code);
  if (index == ParameterMemory::NONE)
  {
    throw std::invalid_argument(model + " has no parameter " + code);
  }
  const std::optional<std::uint32_t> raw = rawOf(memory, index, value);
  if (!raw)
  {
    throw std::invalid_argument("value out of range for " + code + " " + rangeOf(memory.info(index)));
  }
  memory.commission(index, *raw);
}

Refusal setAtPanel(ParameterMemory& memory, const std::string& model, const std::string& code, double value)
{
  const ParameterMemory::Index index = memory.find(code);
  if (index == ParameterMemory::NONE)
  {
    return model + " has no parameter " + code;
  }
  const std::optional<std::uint32_t> raw = rawOf(memory, index, value);
  if (!raw)
  {
    return "value out of range " + rangeOf(memory.info(index));
  }
  memory.writeBoth(index, *raw);
  return std::nullopt;
}

Refusal showAtPanel(const ParameterMemory& memory, const std::string& model, const std::string& code, KeyValues& values)
{
  const ParameterMemory::Index index = memory.find(code);
  if (index == ParameterMemory::NONE)
  {
    return model + " has no parameter " + code;
  }
  const Parameter& info = memory.info(index);
  values.emplace_back("ram", panelText(info, memory.ram(index)));
  values.emplace_back("eeprom", panelText(info, memory.eeprom(index)));
  return std::nullopt;
}
}  // namespace simulation
}  // namespace inverter_bus

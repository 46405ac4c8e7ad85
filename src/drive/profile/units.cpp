// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/units.h"

#include <cctype>
#include <cstddef>
#include <map>

#include "util/printable.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
const std::map<std::string, std::string>& fieldUnits()
{
  // As InverterStatus.msg and Fault.msg say.
  static const std::map<std::string, std::string> UNITS = {
    { "output_frequency", "Hz" }, { "output_current", "A" }, { "output_voltage", "V" },
    { "dc_voltage", "V" },        { "torque", "%" },         { "temperature", "degC" },
    { "run_hours", "h" },         { "power_on_hours", "h" },
  };
  return UNITS;
}

/// "°C", "C", "deg C" and "degC" are one unit, and so are "hz" and "Hz". Never a prefix: mA is no A.
std::string plainUnit(const std::string& unit)
{
  static const std::string DEGREE_SIGN = "\xC2\xB0";
  std::string text = unit;
  const std::size_t degree = text.find(DEGREE_SIGN);
  if (degree != std::string::npos)
  {
    text.erase(degree, DEGREE_SIGN.size());
  }
  std::string plain;
  for (const char character : text)
  {
    const auto byte = static_cast<unsigned char>(character);
    if (std::isspace(byte) == 0)
    {
      plain += static_cast<char>(std::tolower(byte));
    }
  }
  return plain == "c" || plain == "celsius" ? "degc" : plain;
}

std::string baseName(Base base)
{
  return base == Base::RatedCurrent ? "rated_current" : "rated_voltage";
}
}  // namespace

std::string unitOfField(const std::string& field)
{
  const auto unit = fieldUnits().find(field);
  return unit == fieldUnits().end() ? "" : unit->second;
}

std::string unitMistake(const std::string& field, const Item& item)
{
  const std::string wanted = unitOfField(field);
  if (wanted.empty())
  {
    return "";
  }
  const std::string of_rating = wanted == "A" ? "rated_current" : wanted == "V" ? "rated_voltage" : "";
  if (item.base != Base::None)
  {
    return baseName(item.base) == of_rating ? ""
                                            : "percent of " + baseName(item.base) + " can't be shown in " + wanted +
                                                  ": allowed: " + (of_rating.empty() ? "no 'of'" : "of: " + of_rating);
  }
  if (item.unit.empty() || plainUnit(item.unit) == plainUnit(wanted))
  {
    return "";
  }
  return "unit '" + util::printable(item.unit) + "': this field is shown in " + wanted + ": allowed: " + wanted +
         (of_rating.empty() ? "" : ", or \"%\" with of: " + of_rating) + " (resolution is one count in that unit)";
}
}  // namespace drive
}  // namespace inverter_bus

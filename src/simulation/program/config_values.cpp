// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/program/config_values.h"

#include "inverter_bus/simulation/bus_config.h"
#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
std::string describe(const Value& value)
{
  return value.isScalar()                  ? util::printable(value.text)
         : value.type == Value::Type::List ? "a list"
         : value.type == Value::Type::Map  ? "a map"
                                           : "nothing";
}
}  // namespace

void Refusals::complain(const config::Spot& spot, const std::string& what)
{
  constexpr std::size_t LONGEST = 1000;
  const std::string place = spot.place.empty() ? "" : spot.place + ": ";
  throw ConfigError(util::printable(place + (spot.path.empty() ? "" : spot.path + ": ") + what, LONGEST));
}

void Refusals::refuse(const config::Spot& spot, const Value& value, const std::string& /*problem*/,
                      const std::string& allowed)
{
  complain(spot, describe(value) + " (allowed: " + allowed + ")");
}

void Refusals::miss(const config::Spot& spot, const std::string& allowed)
{
  refuse(spot, Value(), "", allowed);
}

void Refusals::refuseKey(const config::Spot& spot, const config::Entry& /*entry*/,
                         const std::vector<std::string>& known)
{
  complain(spot, "unknown key (allowed: " + util::joined(known) + ")");
}

bool readLineKey(const std::string& key, const Cursor& value, LineSettings& line)
{
  if (key == "baud_rate")
  {
    // All that a drive or a port may have; each drive itself says which it really has.
    line.baud_rate = static_cast<int>(value.integer(300, 1000000).value_or(0));
  }
  else if (key == "data_bits")
  {
    line.data_bits = static_cast<int>(value.integerOf({ 7, 8 }).value_or(0));
  }
  else if (key == "stop_bits")
  {
    line.stop_bits = static_cast<int>(value.integerOf({ 1, 2 }).value_or(0));
  }
  else if (key == "parity")
  {
    const std::string parity = value.choice({ "none", "even", "odd" }).value_or("");
    line.parity = parity == "even" ? Parity::Even : parity == "odd" ? Parity::Odd : Parity::None;
  }
  else
  {
    return false;
  }
  return true;
}
}  // namespace simulation
}  // namespace inverter_bus

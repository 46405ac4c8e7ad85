// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SRC_SIMULATION_CONFIG_VALUES_H
#define INVERTER_BUS_SRC_SIMULATION_CONFIG_VALUES_H

#include <set>
#include <string>

#include "inverter_bus/config/value.h"
#include "inverter_bus/simulation/line_settings.h"

namespace inverter_bus
{
namespace simulation
{
using config::Value;

/// \throws ConfigError "place: value (allowed: ...)"
[[noreturn]] void refuse(const std::string& place, const Value* value, const std::string& allowed);

/// Null where there is no such key, or \p map is none.
const Value* find(const Value* map, const std::string& key);

// Each throws ConfigError where the value has another type or is not allowed; nullptr: it is missing.
const Value& toMap(const Value* value, const std::string& place, const std::string& allowed);
double toNumber(const Value* value, const std::string& place, double minimum, double maximum);
int toInteger(const Value* value, const std::string& place, const std::set<int>& allowed);
int toIntegerBetween(const Value* value, const std::string& place, int minimum, int maximum);
bool toFlag(const Value* value, const std::string& place);
std::string toText(const Value* value, const std::string& place);
Parity toParity(const Value* value, const std::string& place);

/// Key `baud_rate`, `parity`, `data_bits` or `stop_bits`, into \p line. False for another key. \throws ConfigError
bool readLineKey(const std::string& key, const Value& value, const std::string& place, LineSettings& line);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_SIMULATION_CONFIG_VALUES_H

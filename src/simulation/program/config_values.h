// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SRC_SIMULATION_CONFIG_VALUES_H
#define INVERTER_BUS_SRC_SIMULATION_CONFIG_VALUES_H

#include <string>
#include <vector>

#include "config/complaints.h"
#include "config/cursor.h"
#include "inverter_bus/simulation/line_settings.h"

namespace inverter_bus
{
namespace simulation
{
using config::Cursor;
using config::Section;
using config::Value;

/// The first mistake ends the reading: each function throws ConfigError "place: path: value (allowed: ...)".
class Refusals : public config::Complaints
{
public:
  void complain(const config::Spot& spot, const std::string& what) override;
  void refuse(const config::Spot& spot, const Value& value, const std::string& problem,
              const std::string& allowed) override;
  void miss(const config::Spot& spot, const std::string& allowed) override;
  void refuseKey(const config::Spot& spot, const config::Entry& entry, const std::vector<std::string>& known) override;
};

/// Key `baud_rate`, `parity`, `data_bits` or `stop_bits`, into \p line. False for another key. \throws ConfigError
bool readLineKey(const std::string& key, const Cursor& value, LineSettings& line);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_SIMULATION_CONFIG_VALUES_H

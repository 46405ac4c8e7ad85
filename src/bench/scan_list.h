// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BENCH_SCAN_LIST_H
#define INVERTER_BUS_BENCH_SCAN_LIST_H

#include <string>
#include <vector>

#include "inverter_bus/config/value.h"
#include "inverter_bus/simulation/bus_config.h"

namespace inverter_bus
{
namespace bench
{
/// The room in which driver and simulation meet: the programs that simulate a bus judge its scan list by the driver's own
/// rules, and play drives that only a profile describes. The simulated drives themselves know nothing of it.

/// A bus to simulate, and what the driver would say about its scan list.
struct SimulatedScanList
{
  simulation::BusConfig config;
  std::vector<std::string> warnings;
};

/// \p place names the source in messages (a file, or "~"), \p profile_directory holds the profiles.
/// \throws drive::ConfigurationError in the driver's words for what the driver refuses
/// \throws simulation::ConfigError for a wrong `simulation`, and for a drive that can't be simulated
SimulatedScanList readScanList(config::Value parameters, const std::string& place, const std::string& profile_directory,
                               const simulation::SerialOptions& drives_serial = {});
}  // namespace bench
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BENCH_SCAN_LIST_H

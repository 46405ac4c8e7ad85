// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_BUS_CONFIG_H
#define INVERTER_BUS_SIMULATION_BUS_CONFIG_H

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "inverter_bus/simulation/drive_options.h"
#include "inverter_bus/simulation/simulated_drive.h"

namespace inverter_bus
{
namespace simulation
{
/// One line that names key, value, place and what is allowed.
class ConfigError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

struct DriveConfig
{
  std::string model;  ///< see driveModels()
  DriveOptions options;
};

/// A bus as a scan list describes it.
struct BusConfig
{
  LineSettings line;
  std::vector<DriveConfig> drives;  ///< in the order of the list
};

/// Reads the driver's own parameters file: `protocol`, `baud_rate`, `parity`, `data_bits`, `stop_bits`, `defaults` and
/// `scan_list` (a list, or a bit mask as integer or string: 0x.. or #..) count here, other keys of the driver are passed
/// over. A CompoWay/F bus has 7 data bits, even parity and 2 stop bits unless the file says otherwise. An optional
/// top-level map `simulation` says more about the simulated drives, by name:
///
///     simulation:
///       belt_1: {model: omron_mx2, parameters: {C077: 1.0}, turnaround: 0.005, start_up_time: 1.0, reset_silence: 1.0,
///                eeprom_time: 0.3, load: 0.3, restart_after_timeout: false, self_clearing_coils: false}
///       pump: {model: teco_7200ma, reverse_word: 2, monitor_base: 0x0020}
///       fan: {model: omron_3g3je, operation_codes: {run_forward: "1101"}, area_1_readable: true}
///
/// `model` is needed where `drive` is not one of driveModels() (a profile of one's own).
/// @param overrides top-level keys that replace the text's, e.g. { "baud_rate", "9600" }
/// @throws ConfigError
BusConfig busConfigFromText(const std::string& yaml, const std::map<std::string, std::string>& overrides = {});

/// The same from a file. @throws ConfigError, also when the file can't be read
BusConfig busConfigFromFile(const std::string& path, const std::map<std::string, std::string>& overrides = {});

/// Names that `drive` and `model` know.
std::vector<std::string> driveModels();

/// What the drive's bus speaks. @throws ConfigError for an unknown model
Protocol protocolOf(const DriveConfig& config);

/// @throws ConfigError for an unknown model, and for what the drive itself refuses
std::unique_ptr<SimulatedDrive> makeDrive(const DriveConfig& config);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_BUS_CONFIG_H

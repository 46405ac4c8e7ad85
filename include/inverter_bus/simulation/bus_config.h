// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_BUS_CONFIG_H
#define INVERTER_BUS_SIMULATION_BUS_CONFIG_H

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "inverter_bus/config/value.h"
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
  std::string model;  ///< see driveModels(); "profile": played by a profile's values, needs `make`
  DriveOptions options;
  /// Makes the drive in place of the model; empty: the model's own.
  std::function<std::unique_ptr<SimulatedDrive>(const DriveOptions&)> make;
};

/// A bus as a scan list describes it.
struct BusConfig
{
  LineSettings line;                ///< as the master talks
  std::vector<DriveConfig> drives;  ///< in the order of the list; each with serial settings of its own
};

/// What all drives are set to in place of the scan list's settings, to rehearse a wrong setting.
struct SerialOptions
{
  std::optional<int> baud_rate;
  std::optional<Parity> parity;
  std::optional<int> stop_bits;

  void apply(LineSettings& line) const;
};

/// Reads the driver's own parameters: `protocol`, `baud_rate`, `parity`, `data_bits`, `stop_bits`, `defaults` and
/// `scan_list` (a list, or a bit mask as integer or string: 0x.. or #..) count here, other keys of the driver are
/// ignored: the programs have them judged by the driver's own rules first. A CompoWay/F bus has 7 data bits, even parity and
/// 2 stop bits unless the file says otherwise. An optional top-level map `simulation` says more about the simulated drives,
/// by name:
///
///     simulation:
///       belt_1: {model: omron_mx2, parameters: {C077: 1.0}, turnaround: 0.005, start_up_time: 1.0, reset_silence: 1.0,
///                eeprom_time: 0.3, load: 0.3, restart_after_timeout: false, self_clearing_coils: false,
///                mapped_reads_in_blocks: true, reserved_readable: true,
///                baud_rate: 9600, parity: even, data_bits: 8, stop_bits: 1, station: 4}
///       pump: {model: teco_7200ma, reverse_word: 2, monitor_base: 0x0020}
///       fan: {model: omron_3g3je, operation_codes: {run_forward: "1101"}, area_1_readable: true}
///       stranger: {model: omron_mx2, station: 1}
///
/// `model` is needed where `drive` is not one of driveModels(); a path as `drive` is played as "profile". Serial settings and
/// `station` are what the drive is really set to, right or wrong. A name that is not in the scan list is a further drive.
/// \throws ConfigError, in one line: place, value, what is allowed
BusConfig busConfigFromParameters(const config::Value& parameters, const SerialOptions& drives_serial = {});

/// The same from the text of a file. \throws ConfigError, also for what is no YAML
BusConfig busConfigFromText(const std::string& yaml);

/// Names that `drive` and `model` know.
std::vector<std::string> driveModels();

/// What the drive's bus speaks. \throws ConfigError for an unknown model
Protocol protocolOf(const DriveConfig& config);

/// A drive as \p config describes it. \throws ConfigError for an unknown model, and for what the drive itself refuses
std::unique_ptr<SimulatedDrive> makeDrive(const DriveConfig& config);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_BUS_CONFIG_H

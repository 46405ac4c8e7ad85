// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/configuration/configuration_keys.h"

#include <algorithm>

#include "config/complaints.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using Keys = std::vector<std::string>;

bool contains(const Keys& keys, const std::string& key)
{
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Keys that the contract has for a later version: ignoring them would promise what is not done.
const Keys& laterKeys()
{
  static const Keys KEYS{ "in_service", "parameters", "parameters_on_difference" };
  return KEYS;
}

/// Of the map `simulation`, which the simulated bus reads.
const Keys& simulationKeys()
{
  static const Keys KEYS{ "model",
                          "station",
                          "turnaround",
                          "start_up_time",
                          "load",
                          "reset_silence",
                          "eeprom_time",
                          "restart_after_timeout",
                          "reverse_word",
                          "monitor_base",
                          "operation_codes",
                          "self_clearing_coils",
                          "area_1_readable",
                          "mapped_reads_in_blocks",
                          "reserved_readable" };
  return KEYS;
}

/// Parameters that many ROS nodes have, and that a launch file sets at its top level for all of them; they are not this
/// node's, although `baud_rate` shares a word with them.
bool isOrdinaryRosName(const std::string& key)
{
  static const Keys NAMES{ "rate", "publish_rate", "update_rate", "loop_rate", "control_rate" };
  return contains(NAMES, key);
}

Keys allKeys()
{
  Keys keys = busKeys();
  for (const Keys* more : { &entryKeys(), &laterKeys(), &simulationKeys() })
  {
    keys.insert(keys.end(), more->begin(), more->end());
  }
  return keys;
}
}  // namespace

const Keys& busKeys()
{
  /// `simulation` belongs to the simulated bus, which reads the same file.
  static const Keys KEYS{ "port",
                          "protocol",
                          "baud_rate",
                          "parity",
                          "data_bits",
                          "stop_bits",
                          "rs485",
                          "interval",
                          "slow_interval",
                          "response_timeout",
                          "gateway_timeout",
                          "pause_in_reply",
                          "limit",
                          "retries",
                          "offline_after",
                          "exclusive",
                          "realtime_priority",
                          "idle_divisor",
                          "parameter_access",
                          "trace_directory",
                          "defaults",
                          "scan_list",
                          "simulation" };
  return KEYS;
}

const Keys& sharedKeys()
{
  static const Keys KEYS{ "drive",
                          "hz_per_unit",
                          "max_velocity",
                          "min_velocity",
                          "command_timeout",
                          "response_timeout",
                          "rated_current",
                          "rated_voltage",
                          "configure_block",
                          "block_read",
                          "configure_map",
                          "stop_unexpected_motion",
                          "release_on_exit",
                          "overrides",
                          "confirm",
                          "limit",
                          "skip" };
  return KEYS;
}

const Keys& entryKeys()
{
  static const Keys KEYS = [] {
    Keys keys = sharedKeys();
    keys.insert(keys.begin(), { "name", "node" });
    return keys;
  }();
  return KEYS;
}

bool isLibraryKey(const std::string& key)
{
  return key == "diagnostic_period";
}

std::string remarkOn(const std::string& key)
{
  if (contains(laterKeys(), key))
  {
    return "a later version will have it; this one does not";
  }
  if (contains(entryKeys(), key))
  {
    return "it belongs in scan_list or defaults";
  }
  if (contains(busKeys(), key))
  {
    return "it belongs to the bus, at the top";
  }
  if (contains(simulationKeys(), key))
  {
    return "it belongs in simulation";
  }
  const std::string meant = isOrdinaryRosName(key) ? "" : config::nearest(key, allKeys());
  return meant.empty() ? "" : "did you mean '" + meant + "'?";
}
}  // namespace bus
}  // namespace inverter_bus

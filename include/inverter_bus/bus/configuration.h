// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_CONFIGURATION_H
#define INVERTER_BUS_BUS_CONFIGURATION_H

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/config/value.h"
#include "inverter_bus/drive/drive.h"
#include "inverter_bus/wire/line.h"
#include "inverter_bus/wire/serial_port.h"
#include "inverter_bus/wire/tcp_port.h"

namespace inverter_bus
{
namespace bus
{
/// A configuration value as it came from the parameter server or from a YAML file, before it is judged.
using config::Value;

/// A scan list file as roslaunch would put it onto the parameter server (config/yaml.h).
/// \throws drive::ConfigurationError one line: file, line, key, what is wrong, what is allowed
Value readYamlFile(const std::string& path);

/// What happens to a velocity beyond the maximum (contract, 8.5).
enum class Limit
{
  Refuse,
  Saturate
};

/// One inverter of the scan list. Times in seconds, velocities in the user's unit.
struct InverterConfig
{
  std::string name;
  std::uint8_t node = 0;
  bool modbus_tcp = false;  ///< resolved: on tcp://
  std::string drive;
  double hz_per_unit = 1.0;
  double max_velocity = 0.0;  ///< resolved: never above the profile's maximum / |hz_per_unit|
  double min_velocity = 0.0;
  double command_timeout = 0.5;   ///< 0: never
  double response_timeout = 0.1;  ///< resolved: entry, profile, bus
  std::optional<double> rated_current;
  std::optional<double> rated_voltage;
  bool configure_block = false;
  std::vector<int> block_read{ 1, 2, 3, 4, 14 };
  bool configure_map = false;
  bool stop_unexpected_motion = false;
  bool release_on_exit = false;
  Limit limit = Limit::Refuse;  ///< resolved: entry, bus
  /// Status fields that are left out: not read, NaN, and their unconfirmed items are not reported.
  std::vector<std::string> skip;
  drive::ProfileChanges changes;

  /// A unit number that no station of a serial line has (Modbus over serial line V1.02, section 2.2): of a drive with an
  /// Ethernet port of its own. Only on tcp://.
  bool ownPort() const
  {
    return modbus_tcp && (node == 0 || node > LAST_SERIAL_STATION);
  }
  static constexpr std::uint8_t LAST_SERIAL_STATION = 247;
};

/// The private parameters of the node.
struct BusConfig
{
  std::string port = "/dev/ttyUSB0";
  std::string protocol = "modbus_rtu";
  /// Of the port, or of the line behind a gateway.
  wire::SerialSettings serial;
  /// tcp:// and rtu+tcp://: where the gateway is.
  std::optional<wire::TcpAddress> gateway;
  /// tcp://: the gateway speaks Modbus TCP; otherwise it passes RTU frames on as they are.
  bool modbus_tcp = false;
  double interval = 0.0;       ///< [s] 0-655.35
  double slow_interval = 1.0;  ///< [s] shortest period of the slow values, 0: they are never read
  double response_timeout = 0.1;
  double gateway_timeout = 3.0;  ///< [s] tcp://: after that a gateway has given up a request that it left unanswered
  /// [s] longest pause inside a reply; resolved by makeTiming() where it is not given.
  std::optional<double> pause_in_reply;
  Limit limit = Limit::Refuse;
  int retries = 1;
  int offline_after = 3;
  bool exclusive = true;
  int realtime_priority = 0;
  int idle_divisor = 1;
  bool parameters_read_only = false;
  std::string trace_directory = "~/.ros/inverter_bus";
  /// In node order.
  std::vector<InverterConfig> inverters;
};

/// Framing and port that a judged configuration asks for.
std::unique_ptr<wire::Protocol> makeProtocol(const BusConfig& config);
std::unique_ptr<wire::Port> makePort(const BusConfig& config);
wire::LineTiming makeTiming(const BusConfig& config);

/// A judged configuration and the drives that belong to it, in the same order.
struct Configuration
{
  BusConfig bus;
  std::vector<drive::Drive> drives;
  /// What was accepted but should be corrected: one line each, for the log and for programs that check a file.
  std::vector<std::string> warnings;
};

/// Judges the node's parameters (contract, section 2). \p place names the source in messages ("~" for ROS parameters or a
/// file), \p profile_directory holds the profiles.
/// \throws drive::ConfigurationError one line: key, value, place, what is allowed
Configuration readConfiguration(Value parameters, const std::string& place, const std::string& profile_directory);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_CONFIGURATION_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/status_conversion.h"

#include <chrono>
#include <cmath>
#include <limits>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
constexpr double UNKNOWN = std::numeric_limits<double>::quiet_NaN();

/// Puts a field of the drive into the message and sets its bit, or leaves both as they are.
template <typename From, typename To>
void put(const std::optional<From>& value, To& field, std::uint32_t bit, std::uint32_t& known)
{
  if (value)
  {
    field = static_cast<To>(*value);
    known |= bit;
  }
}

bool atRest(const drive::Monitor& monitor)
{
  return !monitor.running.value_or(true) || monitor.output_frequency.value_or(1.0) == 0.0;
}

/// Rotation in the user's sense; empty: can't tell.
std::optional<int> direction(const drive::Monitor& monitor, double hz_per_unit)
{
  if (!monitor.direction)
  {
    return std::nullopt;
  }
  // A drive at rest reports the direction of its next start.
  const int drive_sense = atRest(monitor) ? 0 : *monitor.direction;
  return hz_per_unit < 0.0 ? -drive_sense : drive_sense;
}

/// Velocity in the user's unit; empty: can't tell.
std::optional<double> velocity(const drive::Monitor& monitor, double hz_per_unit)
{
  const std::optional<int> sense = direction(monitor, hz_per_unit);
  if (monitor.output_frequency && *monitor.output_frequency == 0.0)
  {
    return 0.0;
  }
  if (!monitor.output_frequency || !sense)
  {
    return std::nullopt;
  }
  return *sense == 0 ? 0.0 : *sense * *monitor.output_frequency / std::abs(hz_per_unit);
}

void putFlags(const drive::Monitor& monitor, InverterStatus& message)
{
  std::uint32_t& known = message.known;
  put(monitor.operation, message.operation, InverterStatus::KNOWN_OPERATION, known);
  put(monitor.running, message.running, InverterStatus::KNOWN_RUNNING, known);
  put(monitor.ready, message.ready, InverterStatus::KNOWN_READY, known);
  put(monitor.at_speed, message.at_speed, InverterStatus::KNOWN_AT_SPEED, known);
  put(monitor.at_set_frequency, message.at_set_frequency, InverterStatus::KNOWN_AT_SET_FREQUENCY, known);
  put(monitor.overload_warning, message.overload_warning, InverterStatus::KNOWN_OVERLOAD_WARNING, known);
  put(monitor.pid_deviation, message.pid_deviation, InverterStatus::KNOWN_PID_DEVIATION, known);
  put(monitor.faulted, message.faulted, InverterStatus::KNOWN_FAULTED, known);
}

void putCodes(const drive::Monitor& monitor, const drive::Drive& drive, InverterStatus& message)
{
  put(monitor.raw_status, message.raw_status, InverterStatus::KNOWN_RAW_STATUS, message.known);
  put(monitor.fault_code, message.fault_code, InverterStatus::KNOWN_FAULT_CODE, message.known);
  put(monitor.warning_code, message.warning_code, InverterStatus::KNOWN_WARNING_CODE, message.known);
  if (monitor.fault_code)
  {
    message.fault_text = drive.faultText(*monitor.fault_code);
  }
  if (monitor.unknown_trip)
  {
    message.fault_text = drive.tripText(monitor);
  }
  if (monitor.warning_code)
  {
    message.warning_text = drive.warningText(*monitor.warning_code);
  }
}

void putQuantities(const drive::Monitor& monitor, InverterStatus& message)
{
  std::uint32_t& known = message.known;
  put(monitor.output_frequency, message.output_frequency, InverterStatus::KNOWN_OUTPUT_FREQUENCY, known);
  put(monitor.output_current, message.output_current, InverterStatus::KNOWN_OUTPUT_CURRENT, known);
  put(monitor.output_voltage, message.output_voltage, InverterStatus::KNOWN_OUTPUT_VOLTAGE, known);
  put(monitor.dc_voltage, message.dc_voltage, InverterStatus::KNOWN_DC_VOLTAGE, known);
  put(monitor.torque, message.torque, InverterStatus::KNOWN_TORQUE, known);
  put(monitor.temperature, message.temperature, InverterStatus::KNOWN_TEMPERATURE, known);
}

/// A message of a drive that reports nothing.
InverterStatus emptyMessage()
{
  InverterStatus message;
  message.velocity = UNKNOWN;
  message.output_frequency = UNKNOWN;
  message.output_current = UNKNOWN;
  message.output_voltage = UNKNOWN;
  message.dc_voltage = UNKNOWN;
  message.torque = UNKNOWN;
  message.temperature = UNKNOWN;
  message.slow_age = UNKNOWN;
  return message;
}

void putOwn(const bus::InverterStatus& status, InverterStatus& message)
{
  message.run_command = status.run_command;
  message.communication_error = status.communication_error && !status.refuses;
  message.move_velocity_active = status.move_velocity_active;
  message.reset_active = status.reset_active;
  message.stop_active = status.stop_active;
  message.locked = status.locked;
  message.error_id = status.error_id;
  message.error_text = status.error_text;
  message.commanded_velocity = status.commanded_velocity;
}
}  // namespace

Moment Moment::now()
{
  return Moment{ std::chrono::steady_clock::now(), ros::Time::now() };
}

ros::Time toRosTime(TimePoint time, const Moment& moment)
{
  const std::int64_t age = std::chrono::duration_cast<Duration>(moment.steady - time).count();
  const std::int64_t now = static_cast<std::int64_t>(moment.ros.toNSec());
  ros::Time result;
  if (age < now)
  {
    result.fromNSec(static_cast<std::uint64_t>(now - age));
  }
  return result;
}

InverterStatus toMessage(const bus::InverterStatus& status, const bus::InverterConfig& config,
                         const drive::Drive& drive, const Moment& moment)
{
  InverterStatus message = emptyMessage();
  message.header.stamp = status.has_stamp ? toRosTime(status.stamp, moment) : ros::Time();
  message.name = config.name;
  message.node = config.node;
  message.drive = drive.profile().name + (status.model.empty() ? "" : " " + status.model);
  putOwn(status, message);
  // The bus empties the monitor of an offline inverter; should it not, what the drive reported last is no longer a status.
  const drive::Monitor nothing;
  const drive::Monitor& monitor = status.communication_error ? nothing : status.monitor;
  putFlags(monitor, message);
  putCodes(monitor, drive, message);
  putQuantities(monitor, message);
  message.slow_age = status.slow_age && !status.communication_error ? toSeconds(*status.slow_age) : UNKNOWN;
  put(direction(monitor, config.hz_per_unit), message.direction, InverterStatus::KNOWN_DIRECTION, message.known);
  put(velocity(monitor, config.hz_per_unit), message.velocity, InverterStatus::KNOWN_VELOCITY, message.known);
  return message;
}

BusStatus toMessage(const bus::BusStatus& status, const std::string& port, const Moment& moment)
{
  BusStatus message;
  message.header.stamp = moment.ros;
  message.port = port;
  message.connected = status.connected;
  message.busy = status.busy;
  message.node = status.node;
  message.error = status.error;
  message.error_id = status.error_id;
  message.requests = status.counters.requests;
  message.replies = status.counters.replies;
  message.timeouts = status.counters.timeouts;
  message.corrupt_replies = status.counters.corrupt_replies;
  message.exceptions = status.counters.exceptions;
  message.late_replies = status.counters.late_replies;
  message.reconnects = status.reconnects;
  message.cycle_time = status.cycle_time;
  message.utilization = status.utilization;
  message.efficiency = status.efficiency;
  message.stop_latency_max = status.stop_latency_max;
  message.offline_nodes = status.offline_nodes;
  return message;
}

Fault toMessage(const drive::FaultRecord& record)
{
  Fault message;
  message.code = record.code;
  message.text = record.text;
  message.output_frequency = record.output_frequency.value_or(UNKNOWN);
  message.output_current = record.output_current.value_or(UNKNOWN);
  message.dc_voltage = record.dc_voltage.value_or(UNKNOWN);
  message.run_hours = record.run_hours.value_or(UNKNOWN);
  message.power_on_hours = record.power_on_hours.value_or(UNKNOWN);
  return message;
}
}  // namespace ros_node
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/program/bus_config_drives.h"

#include <algorithm>
#include <functional>
#include <map>
#include <vector>

#include "simulation/program/config_values.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr int LAST_STATION = 255;

void readParameters(const Cursor& cursor, DriveOptions& options)
{
  for (const auto& [code, value] : cursor.entries())
  {
    options.parameters[code] = value.number({ 0.0, 4294967295.0 }).value_or(0.0);
  }
}

void readOperationCodes(const Cursor& cursor, DriveOptions& options)
{
  for (const auto& [operation, code] : cursor.entries())
  {
    options.operation_codes[operation] = code.filledText().value_or("");
  }
}

using Reading = std::function<void(const Cursor& value, DriveConfig& drive)>;

Reading numberInto(double DriveOptions::*member, double maximum)
{
  return [member, maximum](const Cursor& value, DriveConfig& drive) {
    drive.options.*member = value.number({ 0.0, maximum }).value_or(0.0);
  };
}

Reading flagInto(bool DriveOptions::*member)
{
  return [member](const Cursor& value, DriveConfig& drive) { drive.options.*member = value.flag().value_or(false); };
}

const std::map<std::string, Reading>& readings()
{
  static const std::map<std::string, Reading> READINGS = {
    { "model", [](const Cursor& value, DriveConfig& drive) { drive.model = value.filledText().value_or(""); } },
    { "station",
      [](const Cursor& value, DriveConfig& drive) {
        drive.options.station = static_cast<int>(value.integer(0, LAST_STATION).value_or(0));
      } },
    { "parameters", [](const Cursor& value, DriveConfig& drive) { readParameters(value, drive.options); } },
    { "operation_codes", [](const Cursor& value, DriveConfig& drive) { readOperationCodes(value, drive.options); } },
    { "reverse_word",
      [](const Cursor& value, DriveConfig& drive) {
        drive.options.reverse_word = static_cast<int>(value.integerOf({ 2, 3 }).value_or(0));
      } },
    { "monitor_base",
      [](const Cursor& value, DriveConfig& drive) {
        drive.options.monitor_base = static_cast<int>(value.integer(0, 0xFFFF).value_or(0));
      } },
    { "turnaround", numberInto(&DriveOptions::turnaround, 10.0) },
    { "start_up_time", numberInto(&DriveOptions::start_up_time, 60.0) },
    { "reset_silence", numberInto(&DriveOptions::reset_silence, 60.0) },
    { "eeprom_time", numberInto(&DriveOptions::eeprom_time, 60.0) },
    { "load", numberInto(&DriveOptions::load, 3.0) },
    { "restart_after_timeout", flagInto(&DriveOptions::restart_after_timeout) },
    { "self_clearing_coils", flagInto(&DriveOptions::self_clearing_coils) },
    { "mapped_reads_in_blocks", flagInto(&DriveOptions::mapped_reads_in_blocks) },
    { "reserved_readable", flagInto(&DriveOptions::reserved_readable) },
    { "area_1_readable", flagInto(&DriveOptions::area_1_readable) },
  };
  return READINGS;
}

std::vector<std::string> detailKeys()
{
  std::vector<std::string> keys{ "baud_rate", "parity", "data_bits", "stop_bits" };
  for (const auto& known : readings())
  {
    keys.push_back(known.first);
  }
  return keys;
}

/// The drive of that name; a new one, which the scan list doesn't know, where the map says what it is and where.
DriveConfig& driveFor(const std::string& name, const Section& details, const LineSettings& line, BusConfig& config)
{
  const auto known = std::find_if(config.drives.begin(), config.drives.end(),
                                  [&name](const DriveConfig& one) { return one.options.name == name; });
  if (known != config.drives.end())
  {
    return *known;
  }
  if (!details.has("model") || !details.has("station"))
  {
    details.cursor().complain(
        "no inverter of the scan list (allowed: their names; or any name, with model and station, "
        "for a further drive on the line)");
  }
  DriveConfig drive;
  drive.options.name = name;
  drive.options.line = line;
  config.drives.push_back(drive);
  return config.drives.back();
}
}  // namespace

void readSimulation(const Cursor& simulation, const LineSettings& line, BusConfig& config)
{
  for (const auto& [name, details] : simulation.entries())
  {
    const Section section(details);
    section.allowOnly(detailKeys());
    DriveConfig& drive = driveFor(name, section, line, config);
    for (const auto& [key, value] : details.entries())
    {
      const auto reading = readings().find(key);
      if (reading != readings().end())
      {
        reading->second(value, drive);
        continue;
      }
      readLineKey(key, value, drive.options.line);
    }
  }
}
}  // namespace simulation
}  // namespace inverter_bus

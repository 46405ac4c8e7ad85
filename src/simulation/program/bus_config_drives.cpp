// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/program/bus_config_drives.h"

#include <algorithm>
#include <functional>
#include <map>

#include "simulation/program/config_values.h"
#include "util/printable.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr int LAST_STATION = 255;

void readParameters(const Value& value, const std::string& place, DriveOptions& options)
{
  for (const auto& entry : toMap(&value, place, "a map of parameter codes to values").map)
  {
    options.parameters[entry.first] = toNumber(&entry.second, place + "/" + entry.first, 0.0, 4294967295.0);
  }
}

void readOperationCodes(const Value& value, const std::string& place, DriveOptions& options)
{
  for (const auto& entry : toMap(&value, place, "a map of operations to codes of four hexadecimal digits").map)
  {
    options.operation_codes[entry.first] = toText(&entry.second, place + "/" + entry.first);
  }
}

using Reading = std::function<void(const Value& value, const std::string& place, DriveConfig& drive)>;

Reading numberInto(double DriveOptions::*member, double maximum)
{
  return [member, maximum](const Value& value, const std::string& place, DriveConfig& drive) {
    drive.options.*member = toNumber(&value, place, 0.0, maximum);
  };
}

Reading flagInto(bool DriveOptions::*member)
{
  return [member](const Value& value, const std::string& place, DriveConfig& drive) {
    drive.options.*member = toFlag(&value, place);
  };
}

const std::map<std::string, Reading>& readings()
{
  static const std::map<std::string, Reading> READINGS = {
    { "model",
      [](const Value& value, const std::string& place, DriveConfig& drive) { drive.model = toText(&value, place); } },
    { "station", [](const Value& value, const std::string& place,
                    DriveConfig& drive) { drive.options.station = toIntegerBetween(&value, place, 0, LAST_STATION); } },
    { "parameters", [](const Value& value, const std::string& place,
                       DriveConfig& drive) { readParameters(value, place, drive.options); } },
    { "operation_codes", [](const Value& value, const std::string& place,
                            DriveConfig& drive) { readOperationCodes(value, place, drive.options); } },
    { "reverse_word",
      [](const Value& value, const std::string& place, DriveConfig& drive) {
        drive.options.reverse_word = toInteger(&value, place, { 2, 3 });
      } },
    { "monitor_base",
      [](const Value& value, const std::string& place, DriveConfig& drive) {
        drive.options.monitor_base = toIntegerBetween(&value, place, 0, 0xFFFF);
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

void readDetail(const std::string& key, const Value& value, const std::string& place, DriveConfig& drive)
{
  const auto reading = readings().find(key);
  if (reading != readings().end())
  {
    reading->second(value, place, drive);
    return;
  }
  if (readLineKey(key, value, place, drive.options.line))
  {
    return;
  }
  std::string allowed = "baud_rate, parity, data_bits, stop_bits";
  for (const auto& known : readings())
  {
    allowed += ", " + known.first;
  }
  throw ConfigError(util::printable(place, 500) + ": unknown key (allowed: " + allowed + ")");
}

/// The drive of that name; a new one, which the scan list doesn't know, where the map says what it is and where.
DriveConfig& driveFor(const std::string& name, const Value& details, const LineSettings& line, BusConfig& config)
{
  const auto known = std::find_if(config.drives.begin(), config.drives.end(),
                                  [&name](const DriveConfig& one) { return one.options.name == name; });
  if (known != config.drives.end())
  {
    return *known;
  }
  if (details.map.count("model") == 0 || details.map.count("station") == 0)
  {
    throw ConfigError(
        "simulation/" + util::printable(name) +
        ": no inverter of the scan list (allowed: their names; or any name, with model and station, for a "
        "further drive on the line)");
  }
  DriveConfig drive;
  drive.options.name = name;
  drive.options.line = line;
  config.drives.push_back(drive);
  return config.drives.back();
}
}  // namespace

void readSimulation(const Value* simulation, const LineSettings& line, BusConfig& config)
{
  if (simulation == nullptr)
  {
    return;
  }
  for (const auto& entry : toMap(simulation, "simulation", "a map of inverter names").map)
  {
    const std::string place = "simulation/" + entry.first;
    const Value& details = toMap(&entry.second, place, "a map");
    DriveConfig& drive = driveFor(entry.first, details, line, config);
    for (const auto& detail : details.map)
    {
      readDetail(detail.first, detail.second, place + "/" + detail.first, drive);
    }
  }
}
}  // namespace simulation
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "inverter_bus/simulation/bus_config.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

#include "config/yaml.h"
#include "simulation/program/bus_config_drives.h"
#include "simulation/program/config_values.h"
#include "util/printable.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
/// A drive that is played by what a profile says of it (key `model`, or a path as `drive`).
const char* const BY_PROFILE = "profile";

LineSettings readLine(const Value& root)
{
  LineSettings line;
  const Value* protocol = find(&root, "protocol");
  const std::string name = protocol == nullptr ? nameOf(Protocol::ModbusRtu) : toText(protocol, "protocol");
  if (name != nameOf(Protocol::ModbusRtu) && name != nameOf(Protocol::CompowayF))
  {
    refuse("protocol", protocol, "modbus_rtu, compoway_f");
  }
  if (name == nameOf(Protocol::CompowayF))
  {
    line.protocol = Protocol::CompowayF;
    line.data_bits = 7;
    line.parity = Parity::Even;
    line.stop_bits = 2;
  }
  for (const char* key : { "baud_rate", "parity", "data_bits", "stop_bits" })
  {
    if (const Value* value = find(&root, key))
    {
      readLineKey(key, *value, key, line);
    }
  }
  return line;
}

/// A key of the entry, else of the defaults.
const Value* pick(const Value* entry, const Value* defaults, const char* key)
{
  const Value* own = find(entry, key);
  return own != nullptr ? own : find(defaults, key);
}

DriveConfig readDrive(const Value* entry, const Value* defaults, const std::string& place)
{
  DriveConfig drive;
  drive.model = toText(pick(entry, defaults, "drive"), place + "/drive");
  if (drive.model[0] == '/')
  {
    drive.model = BY_PROFILE;
  }
  if (const Value* current = pick(entry, defaults, "rated_current"))
  {
    drive.options.rated_current = toNumber(current, place + "/rated_current", 0.01, 10000.0);
  }
  if (const Value* voltage = pick(entry, defaults, "rated_voltage"))
  {
    drive.options.rated_voltage = toNumber(voltage, place + "/rated_voltage", 1.0, 1000.0);
  }
  return drive;
}

void readList(const Value& list, const Value* defaults, BusConfig& config)
{
  for (std::size_t i = 0; i < list.list.size(); ++i)
  {
    const std::string place = "scan_list[" + std::to_string(i) + "]";
    const Value& entry = toMap(&list.list[i], place, "a map with name, node and drive");
    DriveConfig drive = readDrive(&entry, defaults, place);
    drive.options.name = toText(find(&entry, "name"), place + "/name");
    drive.options.station = toIntegerBetween(find(&entry, "node"), place + "/node", 0, 255);
    config.drives.push_back(drive);
  }
}

std::uint32_t maskOf(const Value& value)
{
  const char* const allowed = "a list of inverters, or a 32-bit mask such as 6, \"0x80000002\" or \"#80000002\"";
  if (value.type == Value::Type::Integer)
  {
    return static_cast<std::uint32_t>(value.integer);
  }
  if (value.type != Value::Type::Text)
  {
    refuse("scan_list", &value, allowed);
  }
  const bool number_sign = value.text.compare(0, 1, "#") == 0;
  const std::string digits = value.text.substr(number_sign ? 1 : std::min<std::size_t>(2, value.text.size()));
  const bool prefix = number_sign || value.text.compare(0, 2, "0x") == 0 || value.text.compare(0, 2, "0X") == 0;
  const bool good = prefix && !digits.empty() && digits.size() <= 8 &&
                    digits.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
  if (!good)
  {
    refuse("scan_list", &value, allowed);
  }
  return static_cast<std::uint32_t>(std::strtoul(digits.c_str(), nullptr, 16));
}

void readMask(const Value& value, const Value* defaults, BusConfig& config)
{
  const std::uint32_t mask = maskOf(value);
  for (int station = 1; station < 32; ++station)
  {
    if (((mask >> static_cast<unsigned int>(station)) & 1U) != 0U)
    {
      DriveConfig drive = readDrive(nullptr, defaults, "defaults");
      drive.options.name = "inverter_" + std::to_string(station);
      drive.options.station = station;
      config.drives.push_back(drive);
    }
  }
}

void readScanList(const Value& root, BusConfig& config)
{
  const Value* list = find(&root, "scan_list");
  const Value* defaults = find(&root, "defaults");
  if (list != nullptr && list->type == Value::Type::List)
  {
    readList(*list, defaults, config);
  }
  else if (list != nullptr)
  {
    readMask(*list, defaults, config);
  }
  if (config.drives.empty())
  {
    refuse("scan_list", list, "a list of inverters, or a bit mask with at least one of the bits 1-31");
  }
}

void checkUnique(const BusConfig& config)
{
  std::set<std::string> names{ "bus", "help", "list" };
  std::set<int> stations;
  for (const DriveConfig& drive : config.drives)
  {
    const std::string& name = drive.options.name;
    if (!names.insert(name).second)
    {
      throw ConfigError("scan_list: name " + util::printable(name) +
                        " is taken (allowed: each name once, not bus, help, list)");
    }
    if (!stations.insert(drive.options.station).second)
    {
      throw ConfigError("scan_list: node " + std::to_string(drive.options.station) + " of " + util::printable(name) +
                        " is taken (allowed: each station once)");
    }
  }
}

void checkModel(const DriveConfig& drive, Protocol protocol)
{
  const std::string name = util::printable(drive.options.name);
  const std::vector<std::string> models = driveModels();
  if (drive.model == BY_PROFILE)
  {
    return;
  }
  if (std::find(models.begin(), models.end(), drive.model) == models.end())
  {
    std::string allowed;
    for (const std::string& model : models)
    {
      allowed += model + ", ";
    }
    throw ConfigError("drive: " + util::printable(drive.model) + " of " + name + " can't be simulated (allowed: " +
                      allowed + "or one of them, or profile, as simulation/" + name + "/model)");
  }
  if (protocolOf(drive) != protocol)
  {
    throw ConfigError("drive: " + drive.model + " of " + name + " speaks " + nameOf(protocolOf(drive)) +
                      ", the bus speaks " + nameOf(protocol) + " (allowed: drives of one protocol, named by protocol)");
  }
}

void finish(BusConfig& config)
{
  std::map<int, std::uint64_t> on_station;
  for (DriveConfig& drive : config.drives)
  {
    checkModel(drive, config.line.protocol);
    // Two drives on one station must not have one chance.
    std::uint64_t& others = on_station[drive.options.station];
    drive.options.seed = 1000U + static_cast<std::uint64_t>(drive.options.station) + 1000000U * others;
    ++others;
  }
}
}  // namespace

void SerialOptions::apply(LineSettings& line) const
{
  line.baud_rate = baud_rate.value_or(line.baud_rate);
  line.parity = parity.value_or(line.parity);
  line.stop_bits = stop_bits.value_or(line.stop_bits);
}

BusConfig busConfigFromParameters(const Value& parameters, const SerialOptions& drives_serial)
{
  if (parameters.type != Value::Type::Map)
  {
    refuse("scan list", &parameters, "a map with scan_list, see the README");
  }
  BusConfig config;
  config.line = readLine(parameters);
  readScanList(parameters, config);
  checkUnique(config);
  LineSettings of_drives = config.line;
  drives_serial.apply(of_drives);
  for (DriveConfig& drive : config.drives)
  {
    drive.options.line = of_drives;
  }
  readSimulation(find(&parameters, "simulation"), of_drives, config);
  finish(config);
  return config;
}

BusConfig busConfigFromText(const std::string& yaml)
{
  std::vector<config::YamlProblem> problems;
  const auto tree = config::readYaml(yaml, problems);
  const Value parameters = tree ? config::toParameters(*tree, problems) : Value();
  if (!problems.empty())
  {
    const config::YamlProblem& first = problems.front();
    throw ConfigError(util::printable((first.line > 0 ? "line " + std::to_string(first.line) + ": " : "") +
                                          (first.path.empty() ? "" : first.path + ": ") + first.what,
                                      1000));
  }
  return busConfigFromParameters(parameters);
}
}  // namespace simulation
}  // namespace inverter_bus

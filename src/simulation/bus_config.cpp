// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "inverter_bus/simulation/bus_config.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include <yaml-cpp/yaml.h>

namespace inverter_bus
{
namespace simulation
{
namespace
{
std::string shown(const YAML::Node& value)
{
  if (!value.IsDefined() || value.IsNull())
  {
    return "nothing";
  }
  return value.IsScalar() ? value.Scalar() : (value.IsMap() ? "a map" : "a list");
}

[[noreturn]] void refuse(const std::string& place, const YAML::Node& value, const std::string& allowed)
{
  throw ConfigError(place + ": " + shown(value) + " (allowed: " + allowed + ")");
}

double toNumber(const YAML::Node& value, const std::string& place, double minimum, double maximum)
{
  const std::string allowed = "a number, " + std::to_string(minimum) + " to " + std::to_string(maximum);
  try
  {
    const double number = value.as<double>();
    if (std::isfinite(number) && number >= minimum && number <= maximum)
    {
      return number;
    }
  }
  catch (const YAML::Exception&)
  {
    // not a number: refused below
  }
  refuse(place, value, allowed);
}

int toInteger(const YAML::Node& value, const std::string& place, const std::set<int>& allowed)
{
  std::string list;
  for (const int number : allowed)
  {
    list += (list.empty() ? "" : ", ") + std::to_string(number);
  }
  try
  {
    const int number = value.as<int>();
    if (allowed.count(number) != 0)
    {
      return number;
    }
  }
  catch (const YAML::Exception&)
  {
    // not an integer: refused below
  }
  refuse(place, value, list);
}

bool toFlag(const YAML::Node& value, const std::string& place)
{
  try
  {
    return value.as<bool>();
  }
  catch (const YAML::Exception&)
  {
    refuse(place, value, "true, false");
  }
}

std::string toText(const YAML::Node& value, const std::string& place)
{
  if (!value.IsScalar() || value.Scalar().empty())
  {
    refuse(place, value, "text");
  }
  return value.Scalar();
}

int toIntegerBetween(const YAML::Node& value, const std::string& place, int minimum, int maximum)
{
  try
  {
    const int number = value.as<int>();
    if (number >= minimum && number <= maximum)
    {
      return number;
    }
  }
  catch (const YAML::Exception&)
  {
    // not an integer: refused below
  }
  refuse(place, value, "an integer, " + std::to_string(minimum) + " to " + std::to_string(maximum));
}

Protocol readProtocol(const YAML::Node& root)
{
  const std::string name = root["protocol"] ? toText(root["protocol"], "protocol") : nameOf(Protocol::MODBUS_RTU);
  for (const Protocol protocol : { Protocol::MODBUS_RTU, Protocol::COMPOWAY_F })
  {
    if (name == nameOf(protocol))
    {
      return protocol;
    }
  }
  refuse("protocol", root["protocol"], "modbus_rtu, compoway_f");
}

LineSettings readLine(const YAML::Node& root)
{
  LineSettings line;
  line.protocol = readProtocol(root);
  if (line.protocol == Protocol::COMPOWAY_F)
  {
    line.data_bits = 7;
    line.parity = Parity::EVEN;
    line.stop_bits = 2;
  }
  if (root["baud_rate"])
  {
    line.baud_rate =
        toInteger(root["baud_rate"], "baud_rate", { 1200, 2400, 4800, 9600, 19200, 38400, 57600, 76800, 115200 });
  }
  if (root["data_bits"])
  {
    line.data_bits = toInteger(root["data_bits"], "data_bits", { 7, 8 });
  }
  if (root["stop_bits"])
  {
    line.stop_bits = toInteger(root["stop_bits"], "stop_bits", { 1, 2 });
  }
  if (root["parity"])
  {
    const std::string parity = toText(root["parity"], "parity");
    if (parity != "none" && parity != "even" && parity != "odd")
    {
      refuse("parity", root["parity"], "none, even, odd");
    }
    line.parity = parity == "none" ? Parity::NONE : (parity == "even" ? Parity::EVEN : Parity::ODD);
  }
  return line;
}

void readParameters(const YAML::Node& map, const std::string& place, DriveOptions& options)
{
  if (!map.IsMap())
  {
    refuse(place, map, "a map of parameter codes to values");
  }
  for (const auto& entry : map)
  {
    const std::string code = entry.first.as<std::string>();
    options.parameters[code] = toNumber(entry.second, place + "/" + code, 0.0, 4294967295.0);
  }
}

void readOperationCodes(const YAML::Node& map, const std::string& place, DriveOptions& options)
{
  if (!map.IsMap())
  {
    refuse(place, map, "a map of operations to codes of four hexadecimal digits");
  }
  for (const auto& entry : map)
  {
    const std::string operation = entry.first.as<std::string>();
    options.operation_codes[operation] = toText(entry.second, place + "/" + operation);
  }
}

void readDetail(const std::string& key, const YAML::Node& value, const std::string& place, DriveConfig& drive)
{
  DriveOptions& options = drive.options;
  if (key == "model")
  {
    drive.model = toText(value, place);
  }
  else if (key == "parameters")
  {
    readParameters(value, place, options);
  }
  else if (key == "turnaround")
  {
    options.turnaround = toNumber(value, place, 0.0, 10.0);
  }
  else if (key == "start_up_time")
  {
    options.start_up_time = toNumber(value, place, 0.0, 60.0);
  }
  else if (key == "reset_silence")
  {
    options.reset_silence = toNumber(value, place, 0.0, 60.0);
  }
  else if (key == "eeprom_time")
  {
    options.eeprom_time = toNumber(value, place, 0.0, 60.0);
  }
  else if (key == "load")
  {
    options.load = toNumber(value, place, 0.0, 3.0);
  }
  else if (key == "restart_after_timeout")
  {
    options.restart_after_timeout = toFlag(value, place);
  }
  else if (key == "self_clearing_coils")
  {
    options.self_clearing_coils = toFlag(value, place);
  }
  else if (key == "reverse_word")
  {
    options.reverse_word = toInteger(value, place, { 2, 3 });
  }
  else if (key == "monitor_base")
  {
    options.monitor_base = toIntegerBetween(value, place, 0, 0xFFFF);
  }
  else if (key == "operation_codes")
  {
    readOperationCodes(value, place, options);
  }
  else if (key == "area_1_readable")
  {
    options.area_1_readable = toFlag(value, place);
  }
  else
  {
    throw ConfigError(place +
                      ": unknown key (allowed: model, parameters, turnaround, start_up_time, reset_silence, "
                      "eeprom_time, load, restart_after_timeout, self_clearing_coils, reverse_word, monitor_base, "
                      "operation_codes, area_1_readable)");
  }
}

void readDetails(const YAML::Node& simulation, BusConfig& config)
{
  if (!simulation)
  {
    return;
  }
  if (!simulation.IsMap())
  {
    refuse("simulation", simulation, "a map of inverter names");
  }
  for (const auto& entry : simulation)
  {
    const std::string name = entry.first.as<std::string>();
    const auto drive = std::find_if(config.drives.begin(), config.drives.end(),
                                    [&name](const DriveConfig& one) { return one.options.name == name; });
    if (drive == config.drives.end() || !entry.second.IsMap())
    {
      throw ConfigError("simulation/" + name + ": no map for an inverter of the scan list (allowed: their names)");
    }
    for (const auto& detail : entry.second)
    {
      const std::string key = detail.first.as<std::string>();
      readDetail(key, detail.second, "simulation/" + name + "/" + key, *drive);
    }
  }
}

/// A key of the entry, else of the defaults.
YAML::Node pick(const YAML::Node& entry, const YAML::Node& defaults, const char* key)
{
  if (entry.IsMap() && entry[key])
  {
    return entry[key];
  }
  return defaults && defaults.IsMap() ? defaults[key] : YAML::Node(YAML::NodeType::Undefined);
}

DriveConfig readDrive(const YAML::Node& entry, const YAML::Node& defaults, const std::string& place)
{
  DriveConfig drive;
  const YAML::Node model = pick(entry, defaults, "drive");
  if (!model.IsDefined() || !model.IsScalar())
  {
    refuse(place + "/drive", model, "name of a drive profile");
  }
  drive.model = model.Scalar();
  const YAML::Node current = pick(entry, defaults, "rated_current");
  const YAML::Node voltage = pick(entry, defaults, "rated_voltage");
  if (current.IsDefined())
  {
    drive.options.rated_current = toNumber(current, place + "/rated_current", 0.01, 10000.0);
  }
  if (voltage.IsDefined())
  {
    drive.options.rated_voltage = toNumber(voltage, place + "/rated_voltage", 1.0, 1000.0);
  }
  return drive;
}

void readList(const YAML::Node& list, const YAML::Node& defaults, BusConfig& config)
{
  for (std::size_t i = 0; i < list.size(); ++i)
  {
    const std::string place = "scan_list[" + std::to_string(i) + "]";
    if (!list[i].IsMap())
    {
      refuse(place, list[i], "a map with name, node and drive");
    }
    DriveConfig drive = readDrive(list[i], defaults, place);
    drive.options.name = toText(list[i]["name"], place + "/name");
    drive.options.station = static_cast<int>(toNumber(list[i]["node"], place + "/node", 0.0, 247.0));
    config.drives.push_back(drive);
  }
}

void readMask(const YAML::Node& node, const YAML::Node& defaults, BusConfig& config)
{
  std::string text = node.Scalar();
  const bool hexadecimal = text.compare(0, 1, "#") == 0;
  text.erase(0, hexadecimal ? 1 : 0);
  char* end = nullptr;
  const long long value = std::strtoll(text.c_str(), &end, hexadecimal ? 16 : 0);
  if (text.empty() || *end != '\0' || value < -2147483648LL || value > 4294967295LL)
  {
    refuse("scan_list", node, "a list of inverters, or a 32-bit mask such as 6, \"0x80000002\" or \"#80000002\"");
  }
  const std::uint32_t mask = static_cast<std::uint32_t>(value);
  for (int station = 1; station < 32; ++station)
  {
    if (((mask >> static_cast<unsigned int>(station)) & 1U) != 0U)
    {
      DriveConfig drive = readDrive(YAML::Node(), defaults, "defaults");
      drive.options.name = "inverter_" + std::to_string(station);
      drive.options.station = station;
      config.drives.push_back(drive);
    }
  }
}

void checkModel(const DriveConfig& drive, Protocol protocol)
{
  const std::string& name = drive.options.name;
  const std::vector<std::string> models = driveModels();
  if (std::find(models.begin(), models.end(), drive.model) == models.end())
  {
    std::string allowed;
    for (const std::string& model : models)
    {
      allowed += model + ", ";
    }
    throw ConfigError("drive: " + drive.model + " of " + name + " can't be simulated (allowed: " + allowed +
                      "or one of them as simulation/" + name + "/model)");
  }
  if (protocolOf(drive) != protocol)
  {
    throw ConfigError("drive: " + drive.model + " of " + name + " speaks " + nameOf(protocolOf(drive)) +
                      ", the bus speaks " + nameOf(protocol) + " (allowed: drives of one protocol, named by protocol)");
  }
}

void finish(BusConfig& config)
{
  std::set<std::string> names{ "bus", "help", "list" };
  std::set<int> stations;
  for (DriveConfig& drive : config.drives)
  {
    const std::string& name = drive.options.name;
    if (!names.insert(name).second)
    {
      throw ConfigError("scan_list: name " + name + " is taken (allowed: each name once, not bus, help, list)");
    }
    if (!stations.insert(drive.options.station).second)
    {
      throw ConfigError("scan_list: node " + std::to_string(drive.options.station) + " of " + name +
                        " is taken (allowed: each station once)");
    }
    checkModel(drive, config.line.protocol);
    drive.options.line = config.line;
    drive.options.seed = 1000U + static_cast<std::uint64_t>(drive.options.station);
  }
}

BusConfig busConfigFromYaml(const YAML::Node& root)
{
  if (!root.IsMap())
  {
    throw ConfigError("scan list: " + shown(root) + " (allowed: a map with scan_list, see the README)");
  }
  BusConfig config;
  config.line = readLine(root);
  const YAML::Node list = root["scan_list"];
  const YAML::Node defaults = root["defaults"];
  if (list && list.IsSequence())
  {
    readList(list, defaults, config);
  }
  else if (list && list.IsScalar())
  {
    readMask(list, defaults, config);
  }
  if (config.drives.empty())
  {
    throw ConfigError("scan_list: " + (list ? shown(list) : std::string("missing")) +
                      " (allowed: a list of inverters, or a bit mask with at least one of the bits 1-31)");
  }
  readDetails(root["simulation"], config);
  finish(config);
  return config;
}

}  // namespace

BusConfig busConfigFromText(const std::string& yaml, const std::map<std::string, std::string>& overrides)
{
  try
  {
    YAML::Node root = YAML::Load(yaml);
    for (const auto& entry : overrides)
    {
      root[entry.first] = entry.second;
    }
    return busConfigFromYaml(root);
  }
  catch (const YAML::Exception& error)
  {
    throw ConfigError(std::string(error.what()) + " (allowed: YAML)");
  }
}

BusConfig busConfigFromFile(const std::string& path, const std::map<std::string, std::string>& overrides)
{
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file || text.str().empty())
  {
    throw ConfigError("--scan-list: " + path + " can't be read (allowed: a readable YAML file)");
  }
  try
  {
    return busConfigFromText(text.str(), overrides);
  }
  catch (const ConfigError& error)
  {
    throw ConfigError(path + ": " + error.what());
  }
}
}  // namespace simulation
}  // namespace inverter_bus

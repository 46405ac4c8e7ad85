// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "inverter_bus/simulation/bus_config.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <regex>
#include <set>
#include <vector>

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

LineSettings readLine(const Section& root)
{
  LineSettings line;
  const std::string protocol = root.choice("protocol", { nameOf(Protocol::ModbusRtu), nameOf(Protocol::CompowayF) },
                                           nameOf(Protocol::ModbusRtu));
  if (protocol == nameOf(Protocol::CompowayF))
  {
    line.protocol = Protocol::CompowayF;
    line.data_bits = 7;
    line.parity = Parity::Even;
    line.stop_bits = 2;
  }
  for (const char* key : { "baud_rate", "parity", "data_bits", "stop_bits" })
  {
    if (const auto value = root.find(key))
    {
      readLineKey(key, *value, line);
    }
  }
  return line;
}

/// \p entry holds the defaults too.
DriveConfig readDrive(const Section& entry)
{
  DriveConfig drive;
  const auto model = entry.require("drive", "a text");
  drive.model = model->filledText().value_or("");
  if (drive.model[0] == '/')
  {
    drive.model = BY_PROFILE;
  }
  drive.options.rated_current = entry.number("rated_current", { 0.01, 10000.0 }, drive.options.rated_current);
  drive.options.rated_voltage = entry.number("rated_voltage", { 1.0, 1000.0 }, drive.options.rated_voltage);
  return drive;
}

void readList(const Cursor& list, const Value& defaults, BusConfig& config)
{
  for (const Cursor& listed : list.list())
  {
    Value whole = listed.value();
    whole.inherit(defaults);
    const Section entry(Cursor(whole, listed.path(), listed.complaints()));
    DriveConfig drive = readDrive(entry);
    drive.options.name = entry.require("name", "a text")->filledText().value_or("");
    drive.options.station =
        static_cast<int>(entry.require("node", "an integer from 0 to 255")->integer(0, 255).value_or(0));
    config.drives.push_back(drive);
  }
}

std::uint32_t maskOf(const Cursor& mask)
{
  static const std::regex HEXADECIMAL("(0[xX]|#)([0-9a-fA-F]{1,8})");
  const Value& value = mask.value();
  std::smatch match;
  if (value.type == Value::Type::Integer)
  {
    return static_cast<std::uint32_t>(value.integer);
  }
  if (value.type != Value::Type::Text || !std::regex_match(value.text, match, HEXADECIMAL))
  {
    mask.reject("a list of inverters, or a 32-bit mask such as 6, \"0x80000002\" or \"#80000002\"");
  }
  return static_cast<std::uint32_t>(std::strtoul(match[2].str().c_str(), nullptr, 16));
}

void readMask(const Cursor& value, const Value& defaults, BusConfig& config)
{
  const std::uint32_t mask = maskOf(value);
  for (int station = 1; station < 32; ++station)
  {
    if (((mask >> static_cast<unsigned int>(station)) & 1U) != 0U)
    {
      DriveConfig drive = readDrive(Section(Cursor(defaults, "defaults", value.complaints())));
      drive.options.name = "inverter_" + std::to_string(station);
      drive.options.station = station;
      config.drives.push_back(drive);
    }
  }
}

void readScanList(const Section& root, BusConfig& config)
{
  const char* const allowed = "a list of inverters, or a bit mask with at least one of the bits 1-31";
  const auto list = root.require("scan_list", allowed);
  const auto given = root.find("defaults");
  const Value defaults = given ? given->value() : Value::ofMap({});
  list->isList() ? readList(*list, defaults, config) : readMask(*list, defaults, config);
  if (config.drives.empty())
  {
    list->reject(allowed);
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
                      allowed + "or one of them, or profile, as simulation." + name + ".model)");
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
    // Two drives on one station must not have the same random numbers.
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
  Refusals refusals;
  const Section root(Cursor(parameters, "", refusals));
  BusConfig config;
  config.line = readLine(root);
  readScanList(root, config);
  checkUnique(config);
  LineSettings of_drives = config.line;
  drives_serial.apply(of_drives);
  for (DriveConfig& drive : config.drives)
  {
    drive.options.line = of_drives;
  }
  if (const auto simulation = root.find("simulation"))
  {
    readSimulation(*simulation, of_drives, config);
  }
  finish(config);
  return config;
}

BusConfig busConfigFromText(const std::string& yaml)
{
  Refusals refusals;
  Value parameters = config::readYaml(yaml, "", config::Purpose::Parameters, refusals).value_or(Value());
  parameters.moveTo("");
  return busConfigFromParameters(parameters);
}
}  // namespace simulation
}  // namespace inverter_bus

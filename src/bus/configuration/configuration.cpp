// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/bus/configuration.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "bus/configuration/configuration_inverter.h"
#include "bus/configuration/configuration_keys.h"
#include "bus/configuration/configuration_refusals.h"
#include "bus/configuration/configuration_scan_list.h"
#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
/// "/dev/ttyUSB0", "tcp://host[:port]", "rtu+tcp://host:port".
void readPort(const Section& section, BusConfig& bus)
{
  const std::string allowed =
      "a serial device such as /dev/ttyUSB0, tcp://host[:port] (Modbus TCP gateway), or "
      "rtu+tcp://host:port (RTU frames over TCP)";
  bus.port = section.filledText("port", bus.port);
  const std::size_t scheme_end = bus.port.find("://");
  if (bus.port.empty())
  {
    fail(section, "port", "is empty", allowed);
  }
  if (scheme_end == std::string::npos)
  {
    return;
  }
  const std::string scheme = bus.port.substr(0, scheme_end);
  if (scheme != "tcp" && scheme != "rtu+tcp")
  {
    fail(section, "port", "names an unknown kind of network", allowed);
  }
  bus.modbus_tcp = scheme == "tcp";
  std::string error;
  bus.gateway =
      wire::parseTcpAddress(bus.port.substr(scheme_end + 3), bus.modbus_tcp ? wire::MODBUS_TCP_PORT : 0, error);
  if (!bus.gateway)
  {
    fail(section, "port", "is not an address: " + error, allowed);
  }
}

std::string readProtocol(const Section& section, const BusConfig& bus)
{
  std::string protocol = section.choice("protocol", { "modbus_rtu", "compoway_f" }, "modbus_rtu");
  if (protocol == "compoway_f" && bus.gateway)
  {
    fail(section, "protocol", "cannot be used over " + bus.port, "modbus_rtu, or a serial device as port");
  }
  return protocol;
}

unsigned readBaudRate(const Section& section, unsigned fallback)
{
  return static_cast<unsigned>(
      section.integer("baud_rate", wire::SLOWEST_BAUD_RATE, wire::FASTEST_BAUD_RATE, fallback));
}

wire::Parity readParity(const Section& section, const std::string& fallback)
{
  const std::string parity = section.choice("parity", { "none", "even", "odd" }, fallback);
  return parity == "even" ? wire::Parity::Even : parity == "odd" ? wire::Parity::Odd : wire::Parity::None;
}

wire::Rs485 readRs485(const Section& section)
{
  static const std::map<std::string, wire::Rs485> MODES{ { "auto", wire::Rs485::Auto },
                                                         { "kernel", wire::Rs485::Kernel },
                                                         { "rts_high", wire::Rs485::RtsHigh },
                                                         { "rts_low", wire::Rs485::RtsLow } };
  return MODES.at(section.choice("rs485", { "auto", "kernel", "rts_high", "rts_low" }, "auto"));
}

wire::SerialSettings readSerial(const Section& section, const BusConfig& bus)
{
  wire::SerialSettings serial;
  serial.device = bus.port;
  serial.baud_rate = readBaudRate(section, serial.baud_rate);
  // The factory settings of OMRON's CompoWay/F devices are 7E2; a Modbus RTU character has 8 data bits.
  const bool compoway = bus.protocol == "compoway_f";
  serial.parity = readParity(section, compoway ? "even" : "none");
  serial.data_bits = static_cast<unsigned>(section.integerOf("data_bits", { 7, 8 }, compoway ? 7 : 8));
  if (serial.data_bits != 8 && !compoway)
  {
    fail(section, "data_bits", "is too few: the characters of modbus_rtu have 8", "8");
  }
  serial.stop_bits = static_cast<unsigned>(section.integerOf("stop_bits", { 1, 2 }, compoway ? 2 : 1));
  serial.transmission = compoway ? wire::Transmission::Plain : wire::Transmission::Modbus;
  serial.rs485 = readRs485(section);
  serial.exclusive = bus.exclusive;
  return serial;
}

/// May be raised above what the port itself needs, up to the response_timeout.
void readPauseInReply(const Section& section, BusConfig& bus)
{
  const double least = toSeconds(makeTiming(bus).patience(0.0));
  const double most = std::max(least, bus.response_timeout);
  if (const auto pause = section.find("pause_in_reply"))
  {
    bus.pause_in_reply = pause->number({ least, most, false, "s (response_timeout)" });
  }
}

BusConfig readBus(const Section& section)
{
  BusConfig bus;
  readPort(section, bus);
  bus.protocol = readProtocol(section, bus);
  bus.interval = section.number("interval", { 0.0, 655.35, false, "s" }, bus.interval);
  bus.slow_interval = section.number("slow_interval", { 0.0, 3600.0, false, "s" }, bus.slow_interval);
  bus.response_timeout = section.number("response_timeout", { 0.0, 10.0, true, "s" }, bus.response_timeout);
  bus.gateway_timeout = section.number("gateway_timeout", { 0.0, 60.0, true, "s" }, bus.gateway_timeout);
  bus.limit = readLimit(section, bus.limit);
  bus.retries = static_cast<int>(section.integer("retries", 0, 10, bus.retries));
  bus.offline_after = static_cast<int>(section.integer("offline_after", 1, 100, bus.offline_after));
  bus.exclusive = section.flag("exclusive", bus.exclusive);
  bus.realtime_priority = static_cast<int>(section.integer("realtime_priority", 0, 99, bus.realtime_priority));
  bus.idle_divisor = static_cast<int>(section.integer("idle_divisor", 1, 1000, bus.idle_divisor));
  bus.parameters_read_only =
      section.choice("parameter_access", { "read_write", "read_only" }, "read_write") == "read_only";
  bus.trace_directory = section.filledText("trace_directory", bus.trace_directory);
  bus.serial = readSerial(section, bus);
  readPauseInReply(section, bus);
  return bus;
}

std::string settingText(const std::string& setting)
{
  return setting;
}

std::string settingText(unsigned setting)
{
  return std::to_string(setting);
}

/// Fails for \p key if a drive can't use its value. An empty set: the profile doesn't limit it.
template <typename Setting>
void checkSetting(const Section& section, const std::string& key, const Setting& setting,
                  const std::set<Setting>& usable, const InverterConfig& inverter)
{
  if (usable.empty() || usable.count(setting) != 0)
  {
    return;
  }
  std::vector<std::string> names;
  names.reserve(usable.size());
  for (const Setting& value : usable)
  {
    names.push_back(settingText(value));
  }
  fail(section, key, settingText(setting) + " can't be used by " + inverter.name + " (" + inverter.drive + ")",
       util::joined(names));
}

void checkSerial(const Section& section, const wire::SerialSettings& serial, const InverterConfig& inverter,
                 const drive::Profile& profile)
{
  static const std::map<wire::Parity, std::string> PARITIES{ { wire::Parity::None, "none" },
                                                             { wire::Parity::Even, "even" },
                                                             { wire::Parity::Odd, "odd" } };
  checkSetting(section, "baud_rate", serial.baud_rate, profile.baud_rates, inverter);
  checkSetting(section, "parity", PARITIES.at(serial.parity), profile.parities, inverter);
  checkSetting(section, "data_bits", serial.data_bits, profile.data_bits, inverter);
  checkSetting(section, "stop_bits", serial.stop_bits, profile.stop_bits, inverter);
  const std::string character =
      std::to_string(serial.data_bits) + wire::parityLetter(serial.parity) + std::to_string(serial.stop_bits);
  if (!profile.characters.empty() && profile.characters.count(character) == 0)
  {
    fail(section, "stop_bits", character + " can't be used by " + inverter.name + " (" + inverter.drive + ")",
         util::joined(profile.characters));
  }
}

void checkUnique(const Section& entry, const InverterConfig& inverter, const std::vector<ConfiguredInverter>& others)
{
  for (const ConfiguredInverter& other : others)
  {
    if (other.config.name == inverter.name)
    {
      fail(entry, "name", "is used twice (node " + std::to_string(other.config.node) + " has it too)", "unique names");
    }
    if (other.config.node == inverter.node)
    {
      fail(entry, "node", "is used twice (" + other.config.name + " has it too)", "unique station numbers");
    }
  }
}

/// To a gateway with several drives 0 means all of them and 255 the gateway itself (Modbus messaging on TCP/IP
/// implementation guide V1.0b, section 4.4.2.3).
void checkAlone(const std::vector<Section>& entries, const std::vector<ConfiguredInverter>& inverters)
{
  for (std::size_t i = 0; i < inverters.size() && inverters.size() > 1; ++i)
  {
    const InverterConfig& inverter = inverters[i].config;
    if (inverter.ownPort() && (inverter.node == 0 || inverter.node == 255))
    {
      fail(entries[i], "node", "is for a drive with an Ethernet port of its own, and there are others on this bus",
           "0 and 255 only as the single entry of scan_list; 1 to 247 behind a gateway");
    }
  }
}

Configuration inNodeOrder(BusConfig bus, std::vector<ConfiguredInverter> inverters)
{
  std::sort(inverters.begin(), inverters.end(),
            [](const ConfiguredInverter& a, const ConfiguredInverter& b) { return a.config.node < b.config.node; });
  Configuration configuration;
  configuration.bus = std::move(bus);
  for (ConfiguredInverter& inverter : inverters)
  {
    configuration.bus.inverters.push_back(std::move(inverter.config));
    configuration.drives.push_back(std::move(inverter.drive));
  }
  return configuration;
}

/// Parameters below the node's name may be meant for other nodes: those of a helper node, or one that a launch file gives
/// to all nodes. Any that resembles one of this node's keys stays, to be refused.
void dropForeignKeys(Value& parameters, std::vector<std::string>& remarks)
{
  const auto foreign = [&parameters, &remarks](const config::Entry& entry) {
    const auto& known = busKeys();
    const bool unknown = std::find(known.begin(), known.end(), entry.key) == known.end();
    const bool drop = unknown && !isLibraryKey(entry.key) && remarkOn(entry.key).empty();
    if (drop)
    {
      remarks.push_back(drive::oneLine(parameters.place + ": parameter '" + util::printable(entry.key) +
                                       "' = " + describe(entry.value) +
                                       " does not belong to this node and is ignored (another node's, or one that a "
                                       "launch file sets for all nodes)"));
    }
    return drop || isLibraryKey(entry.key);
  };
  parameters.map.erase(std::remove_if(parameters.map.begin(), parameters.map.end(), foreign), parameters.map.end());
}
}  // namespace

Configuration readConfiguration(Value parameters, const std::string& place, const std::string& profile_directory)
{
  Refusals refusals;
  parameters.moveTo(place);
  dropForeignKeys(parameters, refusals.remarks);
  const Section section = sectionOf(parameters, refusals);
  section.allowOnly(busKeys());
  BusConfig bus = readBus(section);
  std::vector<ConfiguredInverter> inverters;
  // "~scan_list[0]" is how ROS writes a private parameter; a file name wants a separator.
  const std::vector<Value> scan_list = readScanList(section, place == "~" ? place : place + ": ");
  std::vector<Section> entries;
  std::transform(scan_list.begin(), scan_list.end(), std::back_inserter(entries),
                 [&refusals](const Value& entry) { return sectionOf(entry, refusals); });
  for (const Section& entry : entries)
  {
    ConfiguredInverter inverter = readInverter(entry, bus, profile_directory);
    checkUnique(entry, inverter.config, inverters);
    checkSerial(section, bus.serial, inverter.config, inverter.drive.profile());
    inverters.push_back(std::move(inverter));
  }
  checkAlone(entries, inverters);
  Configuration configuration = inNodeOrder(std::move(bus), std::move(inverters));
  configuration.warnings = refusals.remarks;
  return configuration;
}
}  // namespace bus
}  // namespace inverter_bus

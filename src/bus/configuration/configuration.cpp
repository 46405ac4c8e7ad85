// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/bus/configuration.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "bus/configuration/configuration_inverter.h"
#include "bus/configuration/configuration_keys.h"
#include "bus/configuration/configuration_scan_list.h"
#include "bus/configuration/configuration_section.h"
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
  bus.port = section.text("port", bus.port);
  const std::size_t scheme_end = bus.port.find("://");
  if (bus.port.empty())
  {
    section.fail("port", "is empty", allowed);
  }
  if (scheme_end == std::string::npos)
  {
    return;
  }
  const std::string scheme = bus.port.substr(0, scheme_end);
  if (scheme != "tcp" && scheme != "rtu+tcp")
  {
    section.fail("port", "names an unknown kind of network", allowed);
  }
  bus.modbus_tcp = scheme == "tcp";
  std::string error;
  bus.gateway =
      wire::parseTcpAddress(bus.port.substr(scheme_end + 3), bus.modbus_tcp ? wire::MODBUS_TCP_PORT : 0, error);
  if (!bus.gateway)
  {
    section.fail("port", "is no address: " + error, allowed);
  }
}

std::string readProtocol(const Section& section, const BusConfig& bus)
{
  std::string protocol = section.choice("protocol", "modbus_rtu", { "modbus_rtu", "compoway_f" });
  if (protocol == "compoway_f" && bus.gateway)
  {
    section.fail("protocol", "does not go over " + bus.port, "modbus_rtu, or a serial device as port");
  }
  return protocol;
}

unsigned readBaudRate(const Section& section, unsigned fallback)
{
  return static_cast<unsigned>(
      section.integer("baud_rate", fallback, wire::SLOWEST_BAUD_RATE, wire::FASTEST_BAUD_RATE));
}

wire::Parity readParity(const Section& section, const std::string& fallback)
{
  const std::string parity = section.choice("parity", fallback, { "none", "even", "odd" });
  return parity == "even" ? wire::Parity::Even : parity == "odd" ? wire::Parity::Odd : wire::Parity::None;
}

wire::Rs485 readRs485(const Section& section)
{
  static const std::map<std::string, wire::Rs485> MODES{ { "auto", wire::Rs485::Auto },
                                                         { "kernel", wire::Rs485::Kernel },
                                                         { "rts_high", wire::Rs485::RtsHigh },
                                                         { "rts_low", wire::Rs485::RtsLow } };
  return MODES.at(section.choice("rs485", "auto", { "auto", "kernel", "rts_high", "rts_low" }));
}

wire::SerialSettings readSerial(const Section& section, const BusConfig& bus)
{
  wire::SerialSettings serial;
  serial.device = bus.port;
  serial.baud_rate = readBaudRate(section, serial.baud_rate);
  // The factory settings of OMRON's CompoWay/F devices are 7E2; a Modbus RTU character has 8 data bits.
  const bool compoway = bus.protocol == "compoway_f";
  serial.parity = readParity(section, compoway ? "even" : "none");
  serial.data_bits = static_cast<unsigned>(section.choice("data_bits", compoway ? 7 : 8, { 7, 8 }));
  if (serial.data_bits != 8 && !compoway)
  {
    section.fail("data_bits", "is too few for modbus_rtu, whose characters have 8", "8");
  }
  serial.stop_bits = static_cast<unsigned>(section.choice("stop_bits", compoway ? 2 : 1, { 1, 2 }));
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
  bus.pause_in_reply = section.number("pause_in_reply", Range{ least, most, false, "s (response_timeout)" });
}

BusConfig readBus(const Section& section)
{
  BusConfig bus;
  readPort(section, bus);
  bus.protocol = readProtocol(section, bus);
  bus.interval = section.number("interval", bus.interval, Range{ 0.0, 655.35, false, "s" });
  bus.slow_interval = section.number("slow_interval", bus.slow_interval, Range{ 0.0, 3600.0, false, "s" });
  bus.response_timeout = section.number("response_timeout", bus.response_timeout, Range{ 0.0, 10.0, true, "s" });
  bus.gateway_timeout = section.number("gateway_timeout", bus.gateway_timeout, Range{ 0.0, 60.0, true, "s" });
  bus.limit = readLimit(section, bus.limit);
  bus.retries = static_cast<int>(section.integer("retries", bus.retries, 0, 10));
  bus.offline_after = static_cast<int>(section.integer("offline_after", bus.offline_after, 1, 100));
  bus.exclusive = section.boolean("exclusive", bus.exclusive);
  bus.realtime_priority = static_cast<int>(section.integer("realtime_priority", bus.realtime_priority, 0, 99));
  bus.idle_divisor = static_cast<int>(section.integer("idle_divisor", bus.idle_divisor, 1, 1000));
  bus.parameters_read_only =
      section.choice("parameter_access", "read_write", { "read_write", "read_only" }) == "read_only";
  bus.trace_directory = section.text("trace_directory", bus.trace_directory);
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
  section.fail(key, settingText(setting) + " can't be used by " + inverter.name + " (" + inverter.drive + ")",
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
    section.fail("stop_bits", character + " can't be used by " + inverter.name + " (" + inverter.drive + ")",
                 util::joined(profile.characters));
  }
}

void checkUnique(const Section& entry, const InverterConfig& inverter, const std::vector<ConfiguredInverter>& others)
{
  for (const ConfiguredInverter& other : others)
  {
    if (other.config.name == inverter.name)
    {
      entry.fail("name", "stands twice (node " + std::to_string(other.config.node) + " has it too)", "unique names");
    }
    if (other.config.node == inverter.node)
    {
      entry.fail("node", "stands twice (" + other.config.name + " has it too)", "unique station numbers");
    }
  }
}

/// To a gateway with several drives 0 is everybody and 255 the gateway itself (Modbus messaging on TCP/IP implementation
/// guide V1.0b, section 4.4.2.3).
void checkAlone(const std::vector<Section>& entries, const std::vector<ConfiguredInverter>& inverters)
{
  for (std::size_t i = 0; i < inverters.size() && inverters.size() > 1; ++i)
  {
    const InverterConfig& inverter = inverters[i].config;
    if (inverter.ownPort() && (inverter.node == 0 || inverter.node == 255))
    {
      entries[i].fail("node", "is for a drive with an Ethernet port of its own, and there are others on this bus",
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
/// Below the node's name may lie what was meant for others: a helper node's parameters, a name that a launch file gives to all
/// nodes. What resembles a key of ours stays, to be refused.
Section withoutForeignKeys(const Value& parameters, const std::string& place, const std::shared_ptr<Remarks>& remarks)
{
  Value ours = parameters;
  for (auto entry = ours.map.begin(); entry != ours.map.end();)
  {
    const std::string& key = entry->first;
    const auto& known = busKeys();
    const bool unknown = std::find(known.begin(), known.end(), key) == known.end();
    const bool foreign = unknown && !isLibraryKey(key) && remarkOn(key).empty();
    if (foreign)
    {
      remarks->push_back(drive::oneLine(place + ": parameter '" + util::printable(key) +
                                        "' = " + describe(entry->second) +
                                        " is none of this node's and is ignored (another node's, or one that a launch "
                                        "file sets for all of them)"));
    }
    entry = foreign || isLibraryKey(key) ? ours.map.erase(entry) : std::next(entry);
  }
  return Section(ours, place, remarks);
}
}  // namespace

Configuration readConfiguration(const Value& parameters, const std::string& place, const std::string& profile_directory)
{
  const auto remarks = std::make_shared<Remarks>();
  const Section section = withoutForeignKeys(parameters, place, remarks);
  section.refuseUnknownKeys(busKeys());
  BusConfig bus = readBus(section);
  std::vector<ConfiguredInverter> inverters;
  // "~scan_list[0]" is how ROS writes a private parameter; a file name wants a separator.
  const std::vector<Section> entries = readScanList(section, place == "~" ? place : place + ": ");
  for (const Section& entry : entries)
  {
    ConfiguredInverter inverter = readInverter(entry, bus, profile_directory);
    checkUnique(entry, inverter.config, inverters);
    checkSerial(section, bus.serial, inverter.config, inverter.drive.profile());
    inverters.push_back(std::move(inverter));
  }
  checkAlone(entries, inverters);
  Configuration configuration = inNodeOrder(std::move(bus), std::move(inverters));
  configuration.warnings = *remarks;
  return configuration;
}
}  // namespace bus
}  // namespace inverter_bus

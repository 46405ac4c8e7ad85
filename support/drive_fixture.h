// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_TEST_DRIVE_FIXTURE_H
#define INVERTER_BUS_TEST_DRIVE_FIXTURE_H

#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "config/yaml.h"
#include "drive/profile/problems.h"
#include "inverter_bus/drive/drive.h"

namespace inverter_bus
{
namespace drive
{
/// The profiles as shipped; CMake passes the path.
inline std::string profileDirectory()
{
  return std::string(INVERTER_BUS_ROOT) + "/config/drives";
}

/// A map of profile keys as a scan list entry at \p place would have it.
inline config::Value overridesOf(const std::string& yaml, const std::string& place = "overrides")
{
  Problems problems;
  config::Value overrides = config::readYaml(yaml, place, config::Purpose::Profile, problems).value_or(config::Value());
  if (!problems.empty())
  {
    throw ConfigurationError(problems.lines().front());
  }
  overrides.moveTo(place);
  return overrides;
}

inline Drive shipped(const std::string& name, const ProfileChanges& changes = ProfileChanges())
{
  return Drive(loadProfile(name, profileDirectory(), changes));
}

/// "01 05 00 00" as bytes.
inline wire::Bytes bytes(const std::string& hex)
{
  wire::Bytes result;
  std::istringstream stream(hex);
  std::string byte;
  while (stream >> byte)
  {
    result.push_back(static_cast<std::uint8_t>(std::stoul(byte, nullptr, 16)));
  }
  return result;
}

/// A frame as a manual or a trace prints it, without the CRC: station and PDU.
inline std::string printed(const wire::Request& request)
{
  char buffer[4];
  std::snprintf(buffer, sizeof(buffer), "%02X", request.station);
  std::string result = buffer;
  for (const std::uint8_t byte : request.pdu)
  {
    std::snprintf(buffer, sizeof(buffer), " %02X", byte);
    result += buffer;
  }
  return result;
}

/// A profile file that is gone after the test.
class ProfileFile
{
public:
  explicit ProfileFile(const std::string& text)
  {
    const char* directory = std::getenv("TMPDIR");
    static int count = 0;
    path_ = std::string(directory != nullptr ? directory : "/tmp") + "/drive_test_" + std::to_string(getpid()) + "_" +
            std::to_string(++count) + ".yaml";
    std::ofstream(path_) << text;
  }
  ~ProfileFile()
  {
    std::remove(path_.c_str());
  }
  ProfileFile(const ProfileFile&) = delete;
  ProfileFile& operator=(const ProfileFile&) = delete;

  const std::string& path() const
  {
    return path_;
  }
  Profile load(const ProfileChanges& changes = ProfileChanges()) const
  {
    return loadProfile(path_, "", changes);
  }

private:
  std::string path_;
};

/// A small complete profile; tests change single lines of it.
inline std::string smallProfile()
{
  return R"(drive: small
title: A small drive
protocol: modbus_rtu
numbering: {register_offset: -1, coil_offset: -1}
stations: {first: 1, last: 31}
serial:
  baud_rates: [9600, 19200]
  data_bits: [8]
  parity: [none]
  stop_bits: [1]
limits:
  functions: [1, 3, 5, 6, 16]
  read_registers: 8
  write_registers: 8
  read_coils: 16
spans:
  registers: [[0x0100, 0x0120]]
frequency:
  maximum: 50.0
points:
  frequency: {register: 0x0001, resolution: 0.01, unit: Hz}
  run: {coil: 1}
  direction: {coil: 2}
sequences:
  forward: [{frequency: setpoint}, {direction: 0}, {run: 1}]
  stop: [{run: 0}]
status:
  run_seen: {coil: 1}
  running: {coil: 5}
  output_frequency: {register: 0x0100, resolution: 0.01, unit: Hz}
faults:
  table:
    1: overcurrent
parameters:
  P01: {register: 0x0200, resolution: 0.1, unit: s, range: [0.1, 600.0]}
  P02: {register: 0x0201, words: 2}
)";
}

/// A small complete profile of a CompoWay/F drive. No such drive exists: its operation codes are inventions.
inline std::string smallCompowayProfile()
{
  return R"(drive: small_fan
title: A small fan drive
protocol: compoway_f
stations: {first: 0, last: 99}
serial:
  baud_rates: [9600]
  data_bits: [7, 8]
  parity: [even]
  stop_bits: [2]
limits:
  services: [0x0101, 0x0102, 0x0503, 0x0601, 0x0801, 0x3005]
  read_elements: 2
  write_elements: 2
  frame: 40
frequency:
  maximum: 120.0
operation_codes:
  run_forward: {value: "AB01", unconfirmed: run_forward, where: "page 7"}
  stop: {value: "AB00"}
points:
  frequency: {variable: C1/0000, resolution: 0.1, unit: Hz, wears: true}
  operate: {operation: true}
sequences:
  forward: [{frequency: setpoint}, {operate: run_forward}]
  stop: [{operate: stop}]
status:
  output_frequency: {variable: C0/0001, resolution: 0.1, unit: Hz}
  torque: {variable: C0/0002, signed: true, resolution: 0.1, unit: "%"}
  faulted: {variable: C0/0003, bit: 7}
  raw_status: {controller_status: true}
parameters:
  P01: {variable: C3/0000, resolution: 0.1, unit: A, range: [0, 2.5]}
)";
}

/// \p text with \p from, which must be there once, replaced by \p to.
inline std::string replaced(const std::string& text, const std::string& from, const std::string& to)
{
  const std::size_t at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos)
  {
    return "the test's own mistake: '" + from + "' is not in the text once";
  }
  std::string result = text;
  return result.replace(at, from.size(), to);
}
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_TEST_DRIVE_FIXTURE_H

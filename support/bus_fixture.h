// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_TEST_BUS_FIXTURE_H
#define INVERTER_BUS_TEST_BUS_FIXTURE_H

#include <string>

#include "inverter_bus/bus/configuration.h"
#include "support/drive_fixture.h"

namespace inverter_bus
{
namespace bus
{
using Ms = std::chrono::milliseconds;
using drive::printed;
using drive::shipped;

/// A moment of virtual time.
inline TimePoint at(int milliseconds)
{
  return TimePoint() + std::chrono::hours(1) + Ms(milliseconds);
}

/// An inverter of the scan list: node 1, 1 Hz per unit, up to 50 units.
inline InverterConfig inverterConfig()
{
  InverterConfig config;
  config.name = "belt";
  config.node = 1;
  config.drive = "omron_mx2";
  config.max_velocity = 50.0;
  return config;
}

/// A good reply, written as a trace prints it but without station and CRC: "01 01 00".
inline wire::Reply reply(const std::string& pdu, TimePoint finished_at = at(0), TimePoint sent_at = at(0))
{
  wire::Reply result;
  result.outcome = wire::Outcome::Ok;
  result.pdu = drive::bytes(pdu);
  result.sent_at = sent_at;
  result.finished_at = finished_at;
  return result;
}

/// "83 02" with the contract's id 0x8302.
inline wire::Reply exception(std::uint8_t function, std::uint8_t code, TimePoint finished_at = at(0))
{
  wire::Reply result;
  result.outcome = wire::Outcome::Exception;
  result.pdu = { function, code };
  result.error_id = static_cast<std::uint16_t>(function << 8 | code);
  result.finished_at = finished_at;
  return result;
}

inline wire::Reply lost(TimePoint finished_at = at(0))
{
  wire::Reply result;
  result.outcome = wire::Outcome::Timeout;
  result.error_id = 0x0205;
  result.finished_at = finished_at;
  return result;
}
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_TEST_BUS_FIXTURE_H

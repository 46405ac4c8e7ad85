// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_TEST_VIRTUAL_TELNET_H
#define INVERTER_BUS_TEST_VIRTUAL_TELNET_H

#include <vector>

#include "support/virtual_world.h"

namespace inverter_bus
{
/// A converter in telnet mode before the simulated line (RFC 854): it negotiates as soon as a client connects, and doubles
/// every FFH that it passes on.
class VirtualTelnet : public VirtualPort
{
public:
  VirtualTelnet(simulation::SimulatedBus& bus, AppointedClock& clock) : VirtualPort(bus, clock), clock_(clock)
  {
  }

  /// When each connection was opened.
  const std::vector<TimePoint>& connections() const
  {
    return connections_;
  }
  /// Without it the converter is in raw mode.
  bool negotiates = true;

  wire::OpenResult open(std::string& error) override
  {
    const wire::OpenResult result = VirtualPort::open(error);
    greeting_ = negotiates;
    connections_.push_back(clock_.now());
    return result;
  }

  bool isNetwork() const override
  {
    return true;
  }

  bool send(const wire::Bytes& frame) override
  {
    wire::Bytes plain;
    for (std::size_t i = 0; i < frame.size(); ++i)
    {
      plain.push_back(frame[i]);
      i += negotiates && frame[i] == 0xFF ? 1 : 0;
    }
    return VirtualPort::send(plain);
  }

  wire::ReceiveResult receive(wire::Bytes& buffer, TimePoint deadline) override
  {
    if (greeting_)
    {
      greeting_ = false;
      buffer.insert(buffer.end(), { 0xFF, 0xFB, 0x03, 0xFF, 0xFD, 0x03, 0xFF, 0xFB, 0x01 });
      return wire::ReceiveResult::Data;
    }
    wire::Bytes plain;
    const wire::ReceiveResult result = VirtualPort::receive(plain, deadline);
    for (const std::uint8_t byte : plain)
    {
      buffer.insert(buffer.end(), negotiates && byte == 0xFF ? 2 : 1, byte);
    }
    return result;
  }

private:
  AppointedClock& clock_;
  std::vector<TimePoint> connections_;
  bool greeting_ = false;
};
}  // namespace inverter_bus

#endif  // INVERTER_BUS_TEST_VIRTUAL_TELNET_H

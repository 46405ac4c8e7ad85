// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// From a judged configuration to the parts of src/wire that it asks for.

#include "inverter_bus/bus/configuration.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// A gateway may cut a frame into segments, and the network may hold one back.
constexpr double NETWORK_PAUSE_S = 0.1;
}  // namespace

std::unique_ptr<wire::Protocol> makeProtocol(const BusConfig& config)
{
  if (config.protocol == "compoway_f")
  {
    return wire::makeCompowayF();
  }
  return config.modbus_tcp ? wire::makeModbusTcp() : wire::makeModbusRtu();
}

std::unique_ptr<wire::Port> makePort(const BusConfig& config)
{
  return config.gateway ? wire::makeTcpPort(*config.gateway, config.port) : wire::makeSerialPort(config.serial);
}

wire::LineTiming makeTiming(const BusConfig& config)
{
  const unsigned bits = wire::bitsPerCharacter(config.serial);
  if (!config.gateway && !config.pause_in_reply)
  {
    return wire::LineTiming(config.serial.baud_rate, bits);
  }
  return wire::LineTiming(config.serial.baud_rate, bits, seconds(config.pause_in_reply.value_or(NETWORK_PAUSE_S)));
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_TRANSMITTER_H
#define INVERTER_BUS_WIRE_TRANSMITTER_H

#include <memory>

#include "inverter_bus/wire/serial_port.h"

namespace inverter_bus
{
namespace wire
{
/// Puts frames onto an open tty. Strategy of the serial port, chosen by SerialSettings::transmission.
class Transmitter
{
public:
  virtual ~Transmitter() = default;

  /// Binds to the open, non-blocking descriptor \p tty, which stays the caller's. With \p switch_rts the transmitter of
  /// the line is switched by RTS as SerialSettings::rs485 says. False if that cannot be had.
  virtual bool attach(int tty, bool switch_rts) = 0;
  /// Lets go of the descriptor, which must not be closed before.
  virtual void detach() = 0;
  /// False when the port is gone or takes no more bytes.
  virtual bool send(const Bytes& frame) = 0;
};

/// Modbus RTU frames, through libmodbus.
std::unique_ptr<Transmitter> makeModbusTransmitter(const SerialSettings& settings);

/// Any bytes as they are.
std::unique_ptr<Transmitter> makePlainTransmitter(const SerialSettings& settings);

/// Time that \p count characters take on the line.
Duration timeOnLine(const SerialSettings& settings, std::size_t count);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_TRANSMITTER_H

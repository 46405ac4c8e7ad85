// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_SERIAL_PORT_H
#define INVERTER_BUS_WIRE_SERIAL_PORT_H

#include <memory>
#include <optional>
#include <string>

#include "inverter_bus/wire/port.h"

namespace inverter_bus
{
namespace wire
{
enum class Parity
{
  None,
  Even,
  Odd
};

/// As in "8E1": N, E or O.
char parityLetter(Parity parity);

/// Who switches the RS-485 transmitter on and off.
enum class Rs485
{
  /// The adapter does it by itself (every USB adapter that is sold as RS-485).
  Auto,
  /// The kernel's UART driver (TIOCSRS485).
  Kernel,
  /// RTS, high while sending; libmodbus switches it.
  RtsHigh,
  /// RTS, low while sending.
  RtsLow
};

/// How frames get onto the line.
enum class Transmission
{
  /// Through libmodbus, which puts the CRC on and switches RTS.
  Modbus,
  /// As they are (CompoWay/F).
  Plain
};

struct SerialSettings
{
  std::string device;
  unsigned baud_rate = 19200;
  Parity parity = Parity::None;
  unsigned data_bits = 8;
  unsigned stop_bits = 1;
  Rs485 rs485 = Rs485::Auto;
  /// flock, and TIOCEXCL on real ports (on a pseudo-terminal it would outlive a killed owner). A shared port is never
  /// flushed.
  bool exclusive = true;
  Transmission transmission = Transmission::Modbus;
};

/// Baud rates that can be asked for, the slowest and the fastest of the kernel's own constants; whether a port can run at
/// one shows when it is opened.
constexpr unsigned SLOWEST_BAUD_RATE = 50;
constexpr unsigned FASTEST_BAUD_RATE = 4000000;

/// Start, data, parity and stop bits.
unsigned bitsPerCharacter(const SerialSettings& settings);

/// A tty, opened raw and non-blocking; frames leave through what SerialSettings::transmission says. A pseudo-terminal
/// ignores parity and 7 data bits: that is accepted there and nowhere else. A baud rate that the port does not come
/// within 2 % of is a refused setting: open() returns OpenResult::NotThere with the rates that are next to it.
std::unique_ptr<Port> makeSerialPort(const SerialSettings& settings);

/// FTDI latency timer of the adapter behind \p device: how long its chip collects bytes before it delivers them, 1 to 255
/// ms. Nothing for every other device. Reads \p sysfs; any thread.
std::optional<AdapterLatency> adapterLatency(const std::string& device, const std::string& sysfs = "/sys");
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_SERIAL_PORT_H

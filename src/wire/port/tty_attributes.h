// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_WIRE_TTY_ATTRIBUTES_H
#define INVERTER_BUS_SRC_WIRE_TTY_ATTRIBUTES_H

#include <string>

#include "inverter_bus/wire/serial_port.h"

namespace inverter_bus
{
namespace wire
{
/// The result of a request to the driver of a tty.
struct TtyAttributes
{
  /// Bits per second that it says it runs at; it need not be true (see uart_rate.h).
  unsigned baud_rate = 0;
  /// The setting that it did not accept, in words; empty if none. The baud rate is judged by the caller.
  std::string refused;
};

/// Sets rate, parity, bits and raw mode of \p tty in one request and reads them back. Nothing that another program left
/// stays: no sticky parity, flow control, speed of its own for input, or hang-up at the close. A pseudo-terminal has no
/// bits on a wire: it drops parity and 7 data bits, and that is accepted there.
TtyAttributes setTtyAttributes(int tty, const SerialSettings& settings, bool pseudo_terminal);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_WIRE_TTY_ATTRIBUTES_H

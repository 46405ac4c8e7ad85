// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_WIRE_UART_RATE_H
#define INVERTER_BUS_SRC_WIRE_UART_RATE_H

#include <optional>
#include <string>

#include "wire/port/tty_sysfs.h"

namespace inverter_bus
{
namespace wire
{
/// Clock [Hz] of the UART behind \p device if it divides it by 16 and by a whole number, which makes its rates known:
/// the 8250 family without the members that have a prescaler or a fraction. Nothing for every other port. Reads sysfs.
std::optional<unsigned> uartClock(const std::string& device, const std::string& sysfs = SYSFS);

/// Whether a UART with \p clock [Hz] can run at \p baud_rate. The kernel takes 76800 on a clock of 1.8432 MHz, reads it
/// back, and runs at 57600; above the fastest rate it keeps the old one. Returns why not and the rates that are next to
/// it; empty if it comes within 2 %: a character of 11 bits bears 4.5 % between both ends. \p actual is what the driver
/// says that it runs at. Pure.
std::string judgeUartRate(unsigned clock, unsigned baud_rate, unsigned actual);

/// The same for every other port, by what its driver says alone. Pure.
std::string judgeRate(unsigned baud_rate, unsigned actual);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_WIRE_UART_RATE_H

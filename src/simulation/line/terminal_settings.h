// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_TERMINAL_SETTINGS_H
#define INVERTER_BUS_SIMULATION_TERMINAL_SETTINGS_H

#include <optional>

#include "inverter_bus/simulation/line_settings.h"

namespace inverter_bus
{
namespace simulation
{
/// What a client has set a pseudo-terminal to, as far as its other end can see it. Linux keeps the baud rate, CSTOPB,
/// PARODD and INPCK, and drops PARENB and CSIZE (drivers/tty/pty.c). So odd parity shows as PARODD and even parity as
/// INPCK alone, which this driver and libmodbus set with parity and clear without; pyserial never does, and its even
/// parity looks like none.
/// \p descriptor is either end of the terminal, \p assumed what can't be seen: data bits and protocol. Nothing where the
/// terminal can't be asked.
std::optional<LineSettings> settingsOf(int descriptor, const LineSettings& assumed);

/// Raw, and set as a client with these settings would set it, until a client sets it otherwise.
void setTerminal(int descriptor, const LineSettings& settings);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_TERMINAL_SETTINGS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_TTY_SETUP_H
#define INVERTER_BUS_WIRE_TTY_SETUP_H

#include <boost/asio/serial_port.hpp>
#include <string>

#include "inverter_bus/wire/serial_port.h"

namespace inverter_bus
{
namespace wire
{
/// True for the slave side of a Unix 98 pseudo-terminal, by its device number.
bool isPseudoTerminal(int tty);

/// Takes the port for this process alone: flock, and TIOCEXCL on a real port. False if somebody else holds it.
bool lockTty(int tty, bool pseudo_terminal);
void unlockTty(int tty, bool pseudo_terminal);

/// Sets speed, parity, bits and raw mode and checks that they have been taken over. Returns what was refused, in words;
/// empty if nothing was.
std::string configureTty(boost::asio::serial_port& port, const SerialSettings& settings, bool pseudo_terminal);

/// Hands the switching of the RS-485 transmitter to the kernel's driver. Returns why it refused; empty if it did not.
std::string enableKernelRs485(int tty);

/// True if the port has an RTS line.
bool hasRts(int tty);

/// Asks the driver not to collect bytes before it delivers them. Not every driver can; nothing depends on it.
void requestLowLatency(int tty);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_TTY_SETUP_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_TTY_SETUP_H
#define INVERTER_BUS_WIRE_TTY_SETUP_H

#include <string>

#include "inverter_bus/wire/serial_port.h"
#include "wire/port/tty_sysfs.h"

namespace inverter_bus
{
namespace wire
{
/// True for the slave side of a Unix 98 pseudo-terminal, by its device number.
bool isPseudoTerminal(int tty);

/// Outcome of lockTty().
enum class LockResult
{
  Taken,
  /// Another process holds the lock.
  Locked,
  /// It was made exclusive by a program that does not hold the lock that this process sees: through another device file of
  /// the same port (each container has its own), or by a program without flock.
  Exclusive
};

/// Takes the port for this process alone: flock, and TIOCEXCL on a real port.
LockResult lockTty(int tty, bool pseudo_terminal);
/// Only for the holder of the lock.
void unlockTty(int tty, bool pseudo_terminal);

/// Sets speed, parity, bits and raw mode, ends what another program has left (a speed behind 38400, a line discipline,
/// stopped output, a break) and checks that all has been taken over. Returns what was refused, in words; empty if nothing
/// was. \p sysfs has the clock of a UART.
std::string configureTty(int tty, const SerialSettings& settings, bool pseudo_terminal,
                         const std::string& sysfs = SYSFS);

/// Hands the switching of the RS-485 transmitter to the kernel's driver. Returns why it refused; empty if it did not.
std::string enableKernelRs485(int tty);

/// True if the port has an RTS line.
bool hasRts(int tty);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_TTY_SETUP_H

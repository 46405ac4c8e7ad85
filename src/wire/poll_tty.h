// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_POLL_TTY_H
#define INVERTER_BUS_WIRE_POLL_TTY_H

#include "inverter_bus/wire/clock.h"

namespace inverter_bus
{
namespace wire
{
/// What poll(2) says of a tty.
enum class TtyState
{
  Ready,
  /// Nothing until the deadline.
  Silent,
  /// Hung up or unplugged; what had arrived before can still be read.
  HungUp
};

/// Waits until \p tty is ready for \p events (POLLIN, POLLOUT) or \p deadline has passed. A signal doesn't end it.
TtyState pollTty(int tty, short events, TimePoint deadline);

/// True as soon as \p tty takes bytes; false if it doesn't until \p deadline, or has hung up.
bool waitUntilWritable(int tty, TimePoint deadline);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_POLL_TTY_H

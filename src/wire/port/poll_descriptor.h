// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_POLL_DESCRIPTOR_H
#define INVERTER_BUS_WIRE_POLL_DESCRIPTOR_H

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace wire
{
/// The result of poll(2) for a tty or a socket.
enum class DescriptorState
{
  Ready,
  /// Nothing until the deadline.
  Silent,
  /// Hung up, unplugged or broken; what had arrived before can still be read.
  HungUp
};

/// Waits until \p descriptor is ready for \p events (POLLIN, POLLOUT) or \p deadline has passed. A signal doesn't end it.
DescriptorState pollDescriptor(int descriptor, short events, TimePoint deadline);

/// True as soon as \p descriptor takes bytes; false if it doesn't until \p deadline, or has hung up.
bool waitUntilWritable(int descriptor, TimePoint deadline);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_POLL_DESCRIPTOR_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_WIRE_OPEN_FAILURE_H
#define INVERTER_BUS_SRC_WIRE_OPEN_FAILURE_H

#include <string>

namespace inverter_bus
{
namespace wire
{
/// Why open(2) refused \p device with the error number \p error, and how to correct it: "cannot open DEVICE: reason: ...".
/// Looks at the device file and at the files beside it.
std::string openFailure(const std::string& device, int error);

/// Why the open \p device cannot be used as a serial port.
std::string noSerialPort(const std::string& device, int error);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_WIRE_OPEN_FAILURE_H

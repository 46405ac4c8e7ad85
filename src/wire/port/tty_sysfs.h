// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_WIRE_TTY_SYSFS_H
#define INVERTER_BUS_SRC_WIRE_TTY_SYSFS_H

#include <optional>
#include <string>

namespace inverter_bus
{
namespace wire
{
/// Where the kernel shows its devices.
constexpr const char* SYSFS = "/sys";

/// Folder of \p device (a device file or a link to one) under \p sysfs, or empty: `class/tty/NAME` where that is this
/// device, else by its number, since a container may give its device files any name.
std::string ttyFolder(const std::string& device, const std::string& sysfs = SYSFS);

/// The number in \p file; nothing if there is none.
std::optional<long> readNumber(const std::string& file);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_WIRE_TTY_SYSFS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_CONFIG_TEXT_FILE_H
#define INVERTER_BUS_SRC_CONFIG_TEXT_FILE_H

#include <optional>
#include <string>

namespace inverter_bus
{
namespace config
{
/// The text of a regular file of at most LARGEST_YAML bytes. \return nothing, and \p error says why in a few words
std::optional<std::string> readTextFile(const std::string& path, std::string& error);
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_CONFIG_TEXT_FILE_H

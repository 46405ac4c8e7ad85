// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_CONFIG_SHOWN_H
#define INVERTER_BUS_CONFIG_SHOWN_H

#include <cstddef>
#include <string>

namespace inverter_bus
{
namespace config
{
/// \p text that came from outside (a message, a file, a drive), fit for an answer, a status or a log: one line, valid UTF-8
/// without control characters, and cut after \p longest bytes with a note of its length.
std::string shown(const std::string& text, std::size_t longest = 100);
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_CONFIG_SHOWN_H

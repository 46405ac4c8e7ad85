// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_UTIL_PRINTABLE_H
#define INVERTER_BUS_UTIL_PRINTABLE_H

#include <cstddef>
#include <string>

namespace inverter_bus
{
namespace util
{
/// \p text that came from outside (a message, a file, a drive), fit for an answer, a status or a log: one line, valid UTF-8
/// without control characters, and cut after \p longest bytes with a note of its length.
std::string printable(const std::string& text, std::size_t longest = 100);
}  // namespace util
}  // namespace inverter_bus

#endif  // INVERTER_BUS_UTIL_PRINTABLE_H

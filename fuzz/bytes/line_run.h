// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_LINE_RUN_H
#define INVERTER_BUS_FUZZ_LINE_RUN_H

#include <cstddef>
#include <cstdint>

#include "dialect.h"

namespace inverter_bus
{
namespace fuzz
{
/// Some exchanges on a whole wire::Line, and the bytes of each given to Protocol::parse directly. The input:
///
///   one byte         line speed (bits 0 and 1), local echo (bit 2)
///   each exchange    request (index into Dialect::requests()); what happens before it (bit 0: wait for its bar to fall,
///                    bit 1: the first piece comes before the request, bits 2 and 3 together: the port is unplugged);
///                    how many pieces (three bits)
///   each piece       when it comes [ms after the request]; its kind (three bits); n; n bytes
///   kinds            0 to 2 the bytes as they are, 3 with a checksum, 4 a good reply with these data, 5 the request
///                    again, 6 a refusal with the code in the first byte, 7 a reply damaged at the first byte's place
///
/// Ends the program at the first property that does not hold.
void runLine(const Dialect& dialect, const std::uint8_t* data, std::size_t size);
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_LINE_RUN_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/teco/teco_parameters.h"

namespace inverter_bus
{
namespace simulation
{
std::vector<Parameter> tecoParameters()
{
  constexpr bool RUN = true;    // may be written while the motor runs
  constexpr bool STOP = false;  // only at rest
  const auto at = [](int offset) { return static_cast<std::uint16_t>(TECO_PARAMETERS + offset); };
  return {
    { "Bn-01", at(0x00), 1, 1, 1, 60000, 100, RUN, 0 },    // acceleration [s]
    { "Bn-02", at(0x01), 1, 1, 1, 60000, 100, RUN, 0 },    // deceleration [s]
    { "Bn-04", at(0x03), 1, 1, 1, 60000, 100, RUN, 0 },    // deceleration 2 [s]
    { "Cn-02", at(0x11), 1, 1, 500, 4000, 600, STOP, 0 },  // maximum frequency [Hz]
    { "Cn-27", at(0x2A), 1, 1, 0, 255, 10, STOP, 0 },      // communication time-out [s], 0: off
    { "Sn-04", at(0x43), 1, 0, 0, 2, 0, STOP, 0 },         // run command: 0 panel, 1 terminals, 2 RS-485
    { "Sn-05", at(0x44), 1, 0, 0, 2, 0, STOP, 0 },         // frequency: the same
    { "Sn-36", at(0x63), 1, 0, 1, 31, 1, STOP, 0 },        // station
    { "Sn-37", at(0x64), 1, 0, 0, 3, 1, STOP, 0 },         // 1200, 2400, 4800, 9600 bit/s
    { "Sn-38", at(0x65), 1, 0, 0, 2, 0, STOP, 0 },         // parity: none, even, odd
    { "Sn-39", at(0x66), 1, 0, 0, 3, 0, STOP, 0 },         // time-out: Bn-02, coast, Bn-04, run on
  };
}
}  // namespace simulation
}  // namespace inverter_bus

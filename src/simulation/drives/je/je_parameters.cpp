// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/je/je_parameters.h"

namespace inverter_bus
{
namespace simulation
{
std::vector<Parameter> jeParameters()
{
  constexpr std::uint16_t PANEL = 0x1000;  // from here on no address of C3: the bus doesn't reach it
  const auto panel = [](int place) { return static_cast<std::uint16_t>(PANEL + place); };
  return {
    { "P01", 0x0000, 1, 1, 0, 25, 10, false, 0 },       // rated motor current [A]
    { "P02", 0x0001, 1, 1, 0, 999, 200, false, 0 },     // alarm of the operating time [kh]
    { "P03", 0x0002, 1, 1, 0, 50, 30, false, 0 },       // DC braking frequency [Hz]
    { "P04", 0x0003, 1, 1, 0, 100, 0, false, 0 },       // DC braking at start [s]
    { "P05", 0x0004, 1, 1, 0, 100, 5, false, 0 },       // DC braking to stop [s]
    { "P06", 0x0005, 1, 1, 500, 1200, 600, false, 0 },  // maximum output frequency [Hz]
    { "P07", 0x0006, 1, 1, 1, 1200, 600, false, 0 },    // upper limit of the reference [Hz]
    { "P08", 0x0007, 1, 1, 0, 1200, 0, false, 0 },      // lower limit of the reference [Hz]
    { "P09", 0x0008, 1, 0, 0, 2, 0, false, 0 },         // restart: 0 no, 1 up to 0.5 s, 2 always
    { "P10", 0x0009, 1, 0, 0, 1, 0, false, 0 },         // RUN from 0 keys and communications, 1 terminals
    { "P11", 0x000A, 1, 0, 0, 0, 0, false, 0 },         // frequency from keys and communications
    { "P12", 0x000B, 1, 0, 0, 2, 0, false, 0 },         // multi-function output
    { "P15", panel(15), 1, 0, 0, 99, 1, false, 0 },     // unit number
    { "P16", panel(16), 1, 1, 24, 192, 96, false, 0 },  // 2.4, 4.8, 9.6, 19.2 kbit/s
    { "P17", panel(17), 1, 0, 7, 8, 7, false, 0 },      // data bits
    { "P18", panel(18), 1, 0, 1, 2, 2, false, 0 },      // stop bits
    { "P19", panel(19), 1, 0, 0, 2, 1, false, 0 },      // parity: none, even, odd
    { "reference", panel(30), 1, 1, 0, JE_HIGHEST_REFERENCE, 100, true, 0 },  // [Hz]
    { "acceleration", panel(31), 1, 1, 1, 9999, 50, true, 0 },                // [s]
    { "deceleration", panel(32), 1, 1, 1, 9999, 50, true, 0 },                // [s]
  };
}
}  // namespace simulation
}  // namespace inverter_bus

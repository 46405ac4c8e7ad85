// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_TOSHIBA_NUMBERS_H
#define INVERTER_BUS_SIMULATION_TOSHIBA_NUMBERS_H

#include <cstdint>

#include "simulation/modbus/modbus_slave.h"

namespace inverter_bus
{
namespace simulation
{
/// Communication numbers that the drive itself works with; the frame carries them as they are printed (E6581913).
namespace toshiba
{
using Number = std::uint16_t;

constexpr Number CMOD = 0x0003;
constexpr Number FMOD = 0x0004;
constexpr Number FMSL = 0x0005;
constexpr Number FM = 0x0006;
constexpr Number TYP = 0x0007;
constexpr Number ACC = 0x0009;
constexpr Number DEC = 0x0010;
constexpr Number FH = 0x0011;
constexpr Number UL = 0x0012;
constexpr Number LL = 0x0013;
constexpr Number VL = 0x0014;
constexpr Number SR1 = 0x0018;
constexpr Number SR7 = 0x0024;
constexpr Number F100 = 0x0100;
constexpr Number F101 = 0x0101;
constexpr Number F102 = 0x0102;
constexpr Number F109 = 0x0109;
constexpr Number F130 = 0x0130;
constexpr Number F131 = 0x0131;
constexpr Number F132 = 0x0132;
constexpr Number F240 = 0x0240;
constexpr Number F241 = 0x0241;
constexpr Number F242 = 0x0242;
constexpr Number F250 = 0x0250;
constexpr Number F251 = 0x0251;
constexpr Number F260 = 0x0260;
constexpr Number F268 = 0x0268;
constexpr Number F287 = 0x0287;
constexpr Number F294 = 0x0294;
constexpr Number F311 = 0x0311;
constexpr Number F500 = 0x0500;
constexpr Number F501 = 0x0501;
constexpr Number F505 = 0x0505;
constexpr Number F510 = 0x0510;
constexpr Number F511 = 0x0511;
constexpr Number F519 = 0x0519;
constexpr Number THR = 0x0600;
constexpr Number F602 = 0x0602;
constexpr Number F603 = 0x0603;
constexpr Number F700 = 0x0700;
constexpr Number F719 = 0x0719;
constexpr Number F736 = 0x0736;
constexpr Number F749 = 0x0749;
constexpr Number F800 = 0x0800;
constexpr Number F801 = 0x0801;
constexpr Number F802 = 0x0802;
constexpr Number F803 = 0x0803;
constexpr Number F804 = 0x0804;
constexpr Number F805 = 0x0805;
constexpr Number F806 = 0x0806;
constexpr Number F808 = 0x0808;
constexpr Number F829 = 0x0829;
constexpr Number F856 = 0x0856;
constexpr Number F870 = 0x0870;
constexpr Number F871 = 0x0871;
constexpr Number F875 = 0x0875;
constexpr Number F879 = 0x0879;
constexpr Number F880 = 0x0880;
constexpr Number F899 = 0x0899;
constexpr Number TIME_UNIT = 0x0999;

constexpr Number BLOCK_WRITE = 0x1870;
constexpr Number BLOCK_READ = 0x1875;
constexpr Number BLOCK_LAST = 0x1879;

constexpr Number FA00 = 0xFA00;  // command 1
constexpr Number FA01 = 0xFA01;  // frequency command
constexpr Number FA03 = 0xFA03;  // panel frequency
constexpr Number FA08 = 0xFA08;  // local
constexpr Number FA10 = 0xFA10;
constexpr Number FA11 = 0xFA11;
constexpr Number FA13 = 0xFA13;  // motor speed command
constexpr Number FA20 = 0xFA20;  // command 2
constexpr Number FA26 = 0xFA26;  // command 3
constexpr Number FA50 = 0xFA50;  // terminal output data
constexpr Number FA51 = 0xFA51;  // analog output
constexpr Number FA87 = 0xFA87;  // "was reset" marker

constexpr Number FC91 = 0xFC91;
constexpr Number FC92 = 0xFC92;
constexpr Number FE70 = 0xFE70;  // rated current
constexpr Number FE71 = 0xFE71;  // rated voltage

constexpr int TRIP_EMERGENCY = 17;      // E
constexpr int TRIP_COMMUNICATION = 24;  // Err5

/// The number that follows: 0099h -> 0100h; above FFFFh: none. Numbers whose last or last but one digit is A-F don't exist
/// (E6581913 p. 68).
constexpr std::uint32_t next(std::uint32_t number)
{
  do
  {
    ++number;
  } while ((number & 0x0FU) > 0x09U || (number & 0xF0U) > 0x90U);
  return number;
}

/// Exception 04: "cannot be executed" (E6581913 p. 40).
constexpr ModbusException NOT_EXECUTABLE = static_cast<ModbusException>(0x04);
}  // namespace toshiba
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_TOSHIBA_NUMBERS_H

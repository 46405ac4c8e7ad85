// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_LINE_SETTINGS_H
#define INVERTER_BUS_SIMULATION_LINE_SETTINGS_H

#include "inverter_bus/simulation/time.h"

namespace inverter_bus
{
namespace simulation
{
enum class Parity
{
  NONE,
  EVEN,
  ODD
};

/// How bytes travel on the line.
struct LineSettings
{
  int baud_rate = 19200;  ///< [bit/s], > 0
  Parity parity = Parity::NONE;
  int data_bits = 8;  ///< 7 or 8
  int stop_bits = 1;  ///< 1 or 2

  /// Time of one byte on the wire: start bit, data, parity, stop.
  Duration characterTime() const
  {
    const int bits = 1 + data_bits + (parity == Parity::NONE ? 0 : 1) + stop_bits;
    return seconds(static_cast<double>(bits) / baud_rate);
  }

  /// The silence that ends a frame and has to come before the next one: 3.5 characters, 1.75 ms above 19200 baud
  /// (MODBUS over Serial Line V1.02, 2.5.1.1).
  Duration frameGap() const
  {
    return baud_rate > 19200 ? seconds(0.00175) : characterTime() * 7 / 2;
  }
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_LINE_SETTINGS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_LINE_SETTINGS_H
#define INVERTER_BUS_SIMULATION_LINE_SETTINGS_H

#include <string>

#include "inverter_bus/simulation/time.h"

namespace inverter_bus
{
namespace simulation
{
enum class Parity
{
  None,
  Even,
  Odd
};

enum class Protocol
{
  ModbusRtu,
  CompowayF
};

/// As the scan list names it: "modbus_rtu".
inline const char* nameOf(Protocol protocol)
{
  return protocol == Protocol::ModbusRtu ? "modbus_rtu" : "compoway_f";
}

/// 'N', 'E' or 'O', as in 8N1.
inline char letterOf(Parity parity)
{
  return parity == Parity::None ? 'N' : (parity == Parity::Even ? 'E' : 'O');
}

/// How bytes and frames travel on the line.
struct LineSettings
{
  int baud_rate = 19200;  ///< [bit/s], > 0
  Parity parity = Parity::None;
  int data_bits = 8;  ///< 7 or 8
  int stop_bits = 1;  ///< 1 or 2
  Protocol protocol = Protocol::ModbusRtu;

  /// "19200 baud 8N1"
  std::string text() const
  {
    return std::to_string(baud_rate) + " baud " + std::to_string(data_bits) + letterOf(parity) +
           std::to_string(stop_bits);
  }

  /// Time of one byte on the wire: start bit, data, parity, stop.
  Duration characterTime() const
  {
    const int bits = 1 + data_bits + (parity == Parity::None ? 0 : 1) + stop_bits;
    return seconds(static_cast<double>(bits) / baud_rate);
  }

  /// The silence that has to come before a request. Modbus RTU: 3.5 characters, 1.75 ms above 19200 baud (MODBUS over
  /// Serial Line V1.02, 2.5.1.1). CompoWay/F: 2 ms (OMRON E5CN; the 3G3JE's pages don't say).
  Duration frameGap() const
  {
    if (protocol == Protocol::CompowayF)
    {
      return std::chrono::milliseconds(2);
    }
    return baud_rate > 19200 ? seconds(0.00175) : characterTime() * 7 / 2;
  }

  /// A receiver with these settings makes the same bytes of what is sent with those of \p sender; else what it hears is
  /// garbage with framing and parity errors, and no frame comes out of them. Stop bits are only silence to a receiver.
  bool understands(const LineSettings& sender) const
  {
    return baud_rate == sender.baud_rate && parity == sender.parity && data_bits == sender.data_bits &&
           protocol == sender.protocol;
  }

  /// The silence by which a drive knows that a request is over; CompoWay/F knows it by its last byte.
  Duration frameEnd() const
  {
    return protocol == Protocol::CompowayF ? Duration::zero() : frameGap();
  }
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_LINE_SETTINGS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <termios.h>
#include <algorithm>
#include <boost/asio/serial_port_base.hpp>
#include <boost/system/error_code.hpp>

#include "inverter_bus/wire/serial_port.h"
#include "transmitter.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
constexpr unsigned COMMON_BAUD_RATES[] = { 300,     600,     1200,    1800,    2400,    4800,    9600,    19200,
                                           38400,   57600,   115200,  230400,  460800,  500000,  576000,  921600,
                                           1000000, 1152000, 1500000, 2000000, 2500000, 3000000, 3500000, 4000000 };

bool isSupported(unsigned baud_rate)
{
  termios attributes{};
  boost::system::error_code error;
  boost::asio::serial_port_base::baud_rate(baud_rate).store(attributes, error);
  return !error;
}
}  // namespace

std::vector<unsigned> supportedBaudRates()
{
  std::vector<unsigned> supported;
  std::copy_if(std::begin(COMMON_BAUD_RATES), std::end(COMMON_BAUD_RATES), std::back_inserter(supported), isSupported);
  return supported;
}

unsigned bitsPerCharacter(const SerialSettings& settings)
{
  return 1 + settings.data_bits + (settings.parity == Parity::None ? 0 : 1) + settings.stop_bits;
}

Duration timeOnLine(const SerialSettings& settings, std::size_t count)
{
  return seconds(static_cast<double>(count * bitsPerCharacter(settings)) / settings.baud_rate);
}
}  // namespace wire
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/wire/serial_port.h"
#include "wire/port/transmitter.h"

namespace inverter_bus
{
namespace wire
{
unsigned bitsPerCharacter(const SerialSettings& settings)
{
  return 1 + settings.data_bits + (settings.parity == Parity::None ? 0 : 1) + settings.stop_bits;
}

char parityLetter(Parity parity)
{
  switch (parity)
  {
    case Parity::Even:
      return 'E';
    case Parity::Odd:
      return 'O';
    case Parity::None:
      break;
  }
  return 'N';
}

Duration timeOnLine(const SerialSettings& settings, std::size_t count)
{
  return seconds(static_cast<double>(count * bitsPerCharacter(settings)) / settings.baud_rate);
}
}  // namespace wire
}  // namespace inverter_bus

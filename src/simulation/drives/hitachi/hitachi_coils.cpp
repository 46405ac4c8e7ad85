// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Coils of the MX2 and RX. Numbers as printed (MX2-SYS p. 302 and 320, JX>MX2, I578 p. 498); the frame carries
// number - 1.

#include <cmath>

#include "simulation/drives/hitachi/hitachi_drive.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr int FIRST_INPUT = 0x0007;
constexpr int FIRST_STATUS = 0x000F;
constexpr int LAST = 0x0058;
}  // namespace

bool HitachiDrive::writableCoil(int number) const
{
  return (number >= 0x0001 && number <= 0x0004) || (number >= FIRST_INPUT && number < FIRST_INPUT + model_.inputs);
}

bool HitachiDrive::coil(int number) const
{
  if (writableCoil(number))
  {
    return coils_[static_cast<std::size_t>(number)];
  }
  return number >= FIRST_STATUS && number <= LAST && statusCoil(number);
}

bool HitachiDrive::atSetFrequency() const
{
  // FA1 compares magnitudes: it is also on in the wrong direction and at a set frequency of 0 (LinuxCNC c6616a4160).
  if (!runCommanded() || tripped_)
  {
    return false;
  }
  const double wanted = std::abs(wantedFrequency());
  const double output = std::abs(motor_.frequency());
  return std::abs(output - (wanted < panelValue(code_.b082) ? 0.0 : wanted)) < 0.005;
}

bool HitachiDrive::atArrivalFrequency() const
{
  // FA2: C042 while accelerating, C043 while decelerating; 0.00: off.
  const double level = panelValue(motor_.decelerating() ? code_.c043 : code_.c042);
  return level > 0.0 && std::abs(motor_.frequency()) >= level;
}

bool HitachiDrive::statusCoil(int number) const
{
  const bool on = motor_.turning();
  const double frequency = std::abs(motor_.frequency());
  switch (number)
  {
    case 0x000F:  // operation status, follows d003
    case 0x0013:  // RUN
      return on;
    case 0x0010:  // rotation, 1 = reverse
      return motor_.frequency() < 0.0;
    case 0x0011:  // ready
    case 0x0045:  // IRDY
      return powered() && !tripped_ && !safe_stop_;
    case 0x0014:  // FA1
      return atSetFrequency();
    case 0x0015:  // FA2
      return on && atArrivalFrequency();
    case 0x0016:  // OL
      return motor_.current() >= options_.rated_current * memory_.ram(code_.c041) / 1000.0;
    case 0x0018:  // AL
      return tripped_;
    case 0x0019:  // FA3
      return on && atArrivalFrequency() && std::abs(frequency - panelValue(code_.c042)) < 0.1;
    case 0x0020:  // THM
      return usage_.heat() > 0.9;
    case 0x0028:  // ZS
      return frequency <= panelValue(code_.c063);
    case 0x0033:  // NDc: network lost
      return watchdog_.expired();
    case 0x003E:  // LOC: low current, below 20 % of rated while running
      return on && motor_.current() < 0.2 * options_.rated_current;
    case 0x0046:  // FWR
      return runCommanded() && wantedFrequency() > 0.0;
    case 0x0047:  // RVR
      return runCommanded() && wantedFrequency() < 0.0;
    case 0x0049:  // data write in progress
      return busy();
    case 0x004A:  // CRC error, latched
      return counters().damaged > 0;
    case 0x0054:  // frequency source is the operator
      return memory_.ram(code_.a001) == 2;
    case 0x0055:  // run source is the operator
      return memory_.ram(code_.a002) == 2;
    case 0x0058:  // STO monitor
      return safe_stop_;
    default:
      return false;
  }
}

std::uint16_t HitachiDrive::coilWord(int first) const
{
  std::uint16_t word = 0;
  for (int bit = 0; bit < 16; ++bit)
  {
    word = static_cast<std::uint16_t>(word | (coil(first + bit) ? 1U << static_cast<unsigned int>(bit) : 0U));
  }
  return word;
}

ModbusException HitachiDrive::readCoils(std::uint16_t wire, std::uint16_t count, std::vector<bool>& values)
{
  if (wire + 1 > LAST)
  {
    return ModbusException::AddressNotFound;
  }
  for (int number = wire + 1; number <= wire + count; ++number)
  {
    values.push_back(coil(number));  // 0 past the last one
  }
  return ModbusException::None;
}

ModbusException HitachiDrive::writeCoils(std::uint16_t wire, const std::vector<bool>& values)
{
  const int first = wire + 1;
  for (int number = first; number < first + static_cast<int>(values.size()); ++number)
  {
    if (!writableCoil(number))
    {
      return number >= FIRST_STATUS && number <= LAST ? ModbusException::ReadOnly : ModbusException::AddressNotFound;
    }
  }
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    setCoil(first + static_cast<int>(i), values[i]);
  }
  control();
  return ModbusException::None;
}
}  // namespace simulation
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Registers of the 7200MA. 0000H and 0001H: MODBUS manual p. 5; everything else is invented, see TecoDrive. The number
// in the frame is the printed one (p. 8, the example reads 0000H).

#include <cmath>

#include "simulation/drives/teco/teco_drive.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr std::uint32_t COMMAND = 0x0000;
constexpr std::uint32_t FREQUENCY = 0x0001;
constexpr std::uint32_t MONITORS = 8;

std::uint16_t rounded(double value)
{
  return static_cast<std::uint16_t>(std::lround(value));
}
}  // namespace

bool TecoDrive::isMonitor(std::uint32_t wire) const
{
  const std::uint32_t base = static_cast<std::uint32_t>(options_.monitor_base);
  return wire >= base && wire < base + MONITORS;
}

std::uint16_t TecoDrive::status() const
{
  const bool running = motor_.turning() || (busRuns() && !tripped_);
  const bool reverse = motor_.turning() ? motor_.frequency() < 0.0 : wantedFrequency() < 0.0;
  unsigned int bits = running ? 0x01U : 0U;
  bits |= reverse ? 0x02U : 0U;
  bits |= !tripped_ ? 0x04U : 0U;
  bits |= tripped_ ? 0x08U : 0U;
  bits |= setting_error_ ? 0x10U : 0U;
  return static_cast<std::uint16_t>(bits);
}

std::uint16_t TecoDrive::monitor(std::uint32_t offset) const
{
  switch (offset)
  {
    case 0:
      return status();
    case 1:
      return static_cast<std::uint16_t>(tripped_ ? last_trip_ : 0);
    case 3:
      return reference_;
    case 4:
      return rounded(std::abs(motor_.frequency()) * 100.0);
    case 5:
      return rounded(motor_.voltage() * 10.0);
    case 6:
      return rounded(motor_.dcVoltage());
    case 7:
      return rounded(motor_.current() * 10.0);
    default:  // inputs: none is on
      return 0;
  }
}

std::optional<std::uint16_t> TecoDrive::readRegister(std::uint32_t wire) const
{
  if (wire == COMMAND)
  {
    return command_;
  }
  if (wire == FREQUENCY)
  {
    return reference_;
  }
  if (isMonitor(wire))
  {
    return monitor(wire - static_cast<std::uint32_t>(options_.monitor_base));
  }
  const Index index = wire <= 0xFFFFU ? memory_.at(static_cast<std::uint16_t>(wire)) : ParameterMemory::NONE;
  return index == ParameterMemory::NONE ? std::nullopt
                                        : std::optional<std::uint16_t>(static_cast<std::uint16_t>(memory_.ram(index)));
}

ModbusException TecoDrive::readRegisters(std::uint16_t wire, std::uint16_t count, std::vector<std::uint16_t>& values)
{
  for (std::uint32_t i = 0; i < count; ++i)
  {
    const std::optional<std::uint16_t> value = readRegister(wire + i);
    if (!value)
    {
      return ModbusException::AddressNotFound;
    }
    values.push_back(*value);
  }
  return ModbusException::None;
}

ModbusException TecoDrive::checkWrite(std::uint32_t wire, std::uint16_t value) const
{
  if (!readRegister(wire))
  {
    return ModbusException::AddressNotFound;
  }
  if (wire == COMMAND)
  {
    return ModbusException::None;
  }
  if (wire == FREQUENCY)
  {
    const bool fits = value <= panelValue(code_.cn02) * 100.0 + 0.5;
    return fits ? ModbusException::None : ModbusException::ValueOutOfRange;
  }
  if (isMonitor(wire))
  {
    return ModbusException::NotAllowedNow;  // 22H: can't be written
  }
  const Index index = memory_.at(static_cast<std::uint16_t>(wire));
  if (!memory_.accepts(index, value))
  {
    return ModbusException::ValueOutOfRange;
  }
  const bool locked = motor_.turning() && !memory_.info(index).while_running;
  return locked || busy() ? ModbusException::NotAllowedNow : ModbusException::None;
}

ModbusException TecoDrive::writeRegisters(std::uint16_t wire, const std::vector<std::uint16_t>& values,
                                          std::uint8_t /*function*/)
{
  setting_error_ = false;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const ModbusException exception = checkWrite(static_cast<std::uint32_t>(wire + i), values[i]);
    if (exception != ModbusException::None)
    {
      setting_error_ = exception == ModbusException::ValueOutOfRange;
      return exception;
    }
  }
  std::optional<std::uint16_t> command;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const std::size_t number = wire + i;
    if (number == COMMAND)
    {
      command = values[i];
    }
    else if (number == FREQUENCY)
    {
      reference_ = values[i];
    }
    else
    {
      memory_.writeBoth(memory_.at(static_cast<std::uint16_t>(number)), values[i]);
    }
  }
  setCommand(command.value_or(command_));  // last: a RUN starts with the frequency of the same frame
  return ModbusException::None;
}
}  // namespace simulation
}  // namespace inverter_bus

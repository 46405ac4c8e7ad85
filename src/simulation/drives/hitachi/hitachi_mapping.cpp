// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Which register of an MX2 a number means while the Modbus mapping is on (I585 p. 440, I570 p. 379, Hitachi WJ200 p. 540 to
// 569, WJ-C1 p. 354-357). The manuals show reads of one register (03h) and writes of one (06h); that several at once, 10h
// and 17h go the same way is inferred.

#include "simulation/drives/hitachi/hitachi_drive.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr std::uint16_t REFERENCE_HIGH = 0x0001;  // F001
constexpr std::uint16_t REFERENCE_LOW = 0x0002;
}  // namespace

/// Words of what the drive has at \p number without a mapping; 0: nothing.
int HitachiDrive::wordsAt(std::uint16_t number) const
{
  if (number == REFERENCE_HIGH || number == REFERENCE_LOW)
  {
    return 2;
  }
  const auto monitor = monitors_.find(number);
  if (monitor != monitors_.end())
  {
    return monitor->second.second.words;
  }
  const Index index = memory_.at(number);
  return index != ParameterMemory::NONE ? memory_.info(index).words : (readRegister(number) ? 1 : 0);
}

/// The other register of what takes two at \p number; \p number itself where it takes one.
std::uint16_t HitachiDrive::otherHalf(std::uint16_t number) const
{
  if (wordsAt(number) != 2)
  {
    return number;
  }
  const auto monitor = monitors_.find(number);
  const Index index = memory_.at(number);
  std::uint16_t first = REFERENCE_HIGH;
  if (monitor != monitors_.end())
  {
    first = monitor->second.first;
  }
  else if (index != ParameterMemory::NONE)
  {
    first = memory_.info(index).number;
  }
  return static_cast<std::uint16_t>(number == first ? first + 1 : first);
}

bool HitachiDrive::mapsAny(std::uint32_t first, std::uint32_t count) const
{
  for (std::uint32_t number = first; number < first + count && number <= 0xFFFFU; ++number)
  {
    if (map_.covers(static_cast<std::uint16_t>(number)))
    {
      return true;
    }
  }
  return false;
}

/// \p internal becomes the register that \p number means, and \p slot how its value is seen; null: as it is.
ModbusException HitachiDrive::resolve(std::uint16_t number, std::uint16_t& internal,
                                      const RegisterMap::Slot*& slot) const
{
  internal = number;
  slot = nullptr;
  if (!map_.on())
  {
    return ModbusException::None;
  }
  if (!map_.covers(number))
  {
    // Half of two registers was hidden: the other half alone is worth nothing.
    return map_.covers(otherHalf(number)) ? ModbusException::MappedHalf : ModbusException::None;
  }
  slot = map_.slot(number);
  if (slot == nullptr || wordsAt(slot->internal) != 1)
  {
    return ModbusException::MappingFault;
  }
  internal = slot->internal;
  return ModbusException::None;
}

ModbusException HitachiDrive::readMapped(std::uint16_t number, std::uint16_t& value) const
{
  std::uint16_t internal = number;
  const RegisterMap::Slot* slot = nullptr;
  const ModbusException exception = resolve(number, internal, slot);
  if (exception != ModbusException::None)
  {
    return exception;
  }
  const std::optional<std::uint16_t> word = readRegister(internal);
  if (!word)
  {
    return ModbusException::AddressNotFound;
  }
  value = slot == nullptr ? *word : slot->shown(*word);
  return ModbusException::None;
}

ModbusException HitachiDrive::stageMapped(std::uint16_t number, std::uint16_t value, Change& change) const
{
  std::uint16_t internal = number;
  const RegisterMap::Slot* slot = nullptr;
  const ModbusException exception = resolve(number, internal, slot);
  if (exception != ModbusException::None)
  {
    return exception;
  }
  const std::optional<std::uint16_t> word = slot == nullptr ? std::optional<std::uint16_t>(value) : slot->taken(value);
  return word ? stage(internal, *word, change) : ModbusException::ValueOutOfRange;
}
}  // namespace simulation
}  // namespace inverter_bus

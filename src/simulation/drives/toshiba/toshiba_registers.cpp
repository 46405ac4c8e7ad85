// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Reading and writing the VF-S15's registers, singly and in blocks (E6581913 p. 26-36, 40, 68).

#include <algorithm>
#include <cmath>

#include "simulation/drives/toshiba/toshiba_numbers.h"
#include "simulation/drives/toshiba/toshiba_vfs15.h"

namespace inverter_bus
{
namespace simulation
{
using namespace toshiba;  // NOLINT: the numbers of this drive

namespace
{
constexpr std::uint16_t NO_SUCH_NUMBER = 0x8000;
constexpr Number WRITE_SLOT_CODES[] = { 0, FA00, FA20, FA01, FA50, FA51, FA13 };  // F870, F871
constexpr Number READ_SLOT_CODES[] = { 0,      0xFD01, 0xFD00, 0xFD03, 0xFD05, 0xFC91, 0xFD22, 0xFD06,
                                       0xFD07, 0xFE35, 0xFE36, 0xFE37, 0xFD04, 0xFD90, 0xFD18 };  // F875-F879
constexpr std::uint16_t COMMAND_RUN = 0x0400;
constexpr std::uint16_t COMMAND_JOG = 0x0100;
constexpr std::uint16_t COMMAND_EMERGENCY = 0x1000;
constexpr std::uint16_t COMMAND_RESET = 0x2000;
constexpr double FACTORY_TIME = 3.0;  // [s] that tYP = 3 takes

bool readOnly(Number number)
{
  return number == TIME_UNIT || number == FE70 || number == FE71;
}

bool rampTime(Number number)
{
  return number == ACC || number == DEC || number == F500 || number == F501 || number == F510 || number == F511;
}
}  // namespace

bool ToshibaVfs15::isSlot(Number number) const
{
  return model_.blocks && number >= BLOCK_WRITE && number <= BLOCK_LAST;
}

bool ToshibaVfs15::refusesAccess(Number number, bool write) const
{
  // F700: 2 = no writes, 4 = neither; its own is the way out.
  const std::uint32_t protection = raw(F700);
  return number != F700 && memory_.at(number) != ParameterMemory::NONE &&
         (protection == 4 || (protection == 2 && write));
}

std::optional<std::uint16_t> ToshibaVfs15::readRegister(Number number)
{
  const auto pinned = pinned_.find(number);
  if (pinned != pinned_.end())
  {
    return pinned->second;
  }
  const auto held = held_.find(number);
  if (tripped_ && held != held_.end())
  {
    return held->second;
  }
  const auto monitor = monitors_.find(number);
  if (monitor != monitors_.end())
  {
    return static_cast<std::uint16_t>(std::llround(monitor->second()));
  }
  const auto command = ram_.find(number);
  if (command != ram_.end())
  {
    return command->second;
  }
  const Index index = memory_.at(number);
  return index != ParameterMemory::NONE ? std::optional<std::uint16_t>(static_cast<std::uint16_t>(memory_.ram(index)))
                                        : std::nullopt;
}

ModbusException ToshibaVfs15::readSlots(Number number, std::uint16_t count, std::vector<std::uint16_t>& values)
{
  if (number != BLOCK_READ || count < 2 || count > in_effect_.read_slots.size())
  {
    return ModbusException::FormatNotAcceptable;
  }
  for (std::size_t slot = 0; slot < count; ++slot)
  {
    const std::uint32_t code = in_effect_.read_slots[slot];
    values.push_back(code == 0 ? static_cast<std::uint16_t>(0) : *readRegister(READ_SLOT_CODES[code]));
  }
  return ModbusException::None;
}

ModbusException ToshibaVfs15::readRegisters(std::uint16_t wire, std::uint16_t count, std::vector<std::uint16_t>& values)
{
  if (isSlot(wire))
  {
    return readSlots(wire, count, values);
  }
  std::uint32_t number = wire;
  for (std::uint16_t i = 0; i < count; ++i, number = next(number))
  {
    const std::optional<std::uint16_t> value =
        number <= 0xFFFFU ? readRegister(static_cast<Number>(number)) : std::nullopt;
    if (!value && i == 0)
    {
      return ModbusException::AddressNotFound;
    }
    if (value && refusesAccess(static_cast<Number>(number), false))
    {
      return NOT_EXECUTABLE;
    }
    values.push_back(value.value_or(NO_SUCH_NUMBER));
  }
  return ModbusException::None;
}

ModbusException ToshibaVfs15::target(Number number, const std::vector<std::uint16_t>& values,
                                     std::vector<Write>& writes) const
{
  if (values.size() == 1)
  {
    writes.push_back({ number, values[0] });
    return ModbusException::None;
  }
  if (number != BLOCK_WRITE)
  {
    return ModbusException::FormatNotAcceptable;
  }
  for (std::size_t slot = 0; slot < values.size(); ++slot)
  {
    const std::uint32_t code = in_effect_.write_slots[slot];
    if (code != 0)
    {
      writes.push_back({ WRITE_SLOT_CODES[code], values[slot] });
    }
  }
  // The text of p. 33 lets the drive ignore what no slot takes, the example of p. 34 refuses it.
  return writes.empty() ? NOT_EXECUTABLE : ModbusException::None;
}

ModbusException ToshibaVfs15::writeRegisters(std::uint16_t wire, const std::vector<std::uint16_t>& values,
                                             std::uint8_t /*function*/)
{
  std::vector<Write> writes;
  ModbusException exception = target(wire, values, writes);
  for (const Write& write : writes)
  {
    exception = exception == ModbusException::None ? check(write) : exception;
  }
  if (exception != ModbusException::None)
  {
    return exception;
  }
  if (busy())
  {
    return NOT_EXECUTABLE;
  }
  const auto resets = [](const Write& write) { return write.number == FA00 && (write.value & COMMAND_RESET) != 0; };
  if (std::any_of(writes.begin(), writes.end(), resets))
  {
    silent_ = true;
    resetFault();
    control();
    return ModbusException::None;
  }
  for (const Write& write : writes)
  {
    apply(write);
  }
  control();
  return ModbusException::None;
}

ModbusException ToshibaVfs15::check(const Write& write) const
{
  if (ram_.count(write.number) != 0)
  {
    return checkCommand(write);
  }
  const Index index = memory_.at(write.number);
  if (index == ParameterMemory::NONE || readOnly(write.number))
  {
    return ModbusException::AddressNotFound;
  }
  if (refusesAccess(write.number, true))
  {
    return NOT_EXECUTABLE;
  }
  return checkParameter(index, write.value);
}

ModbusException ToshibaVfs15::checkCommand(const Write& write) const
{
  const double pole_pairs = raw(F856);
  const bool bad = (write.number == FA01 && write.value > raw(FH)) ||
                   (write.number == FA13 && (write.value > 24000 || write.value * pole_pairs / 60.0 > hertz(FH))) ||
                   (write.number == FA10 && write.value > 1) || (write.number == FA51 && write.value > 1000) ||
                   (write.number == FA20 && (write.value & 0x0300U) == 0x0300U);
  return bad ? ModbusException::FormatNotAcceptable : ModbusException::None;
}

ModbusException ToshibaVfs15::checkParameter(Index index, std::uint32_t raw) const
{
  const auto range = rangeOf(index);
  if (!memory_.accepts(index, raw) || raw < range.first || raw > range.second)
  {
    return ModbusException::FormatNotAcceptable;
  }
  const bool reset_in_a_trip = memory_.info(index).number == F899 && raw == 1 && tripped_;
  return locked(index) || reset_in_a_trip ? NOT_EXECUTABLE : ModbusException::None;
}

std::pair<std::uint32_t, std::uint32_t> ToshibaVfs15::rangeOf(Index index) const
{
  const Parameter& info = memory_.info(index);
  const Number number = info.number;
  if ((number >= SR1 && number <= SR7) || (number >= F287 && number <= F294) || number == F268 || number == FA03)
  {
    return { raw(LL), raw(UL) };
  }
  switch (number)
  {
    case UL:
    case F100:
    case F101:
    case F102:
    case F241:
    case F242:
    case F250:
      return { info.minimum, raw(FH) };
    case LL:
    case F505:
      return { info.minimum, raw(UL) };
    case F260:
      return { raw(F240), info.maximum };
    default:
      return { info.minimum, info.maximum };
  }
}

bool ToshibaVfs15::locked(Index index) const
{
  const Parameter& info = memory_.info(index);
  const bool source = info.number == CMOD || info.number == FMOD;
  return running() && (!info.while_running || (source && raw(F736) != 0));
}

void ToshibaVfs15::apply(const Write& write)
{
  const Index index = memory_.at(write.number);
  if (index != ParameterMemory::NONE)
  {
    stored_ = true;
    takeFromPanel(index, write.value);
    return;
  }
  ram_[write.number] = write.value;
  switch (write.number)
  {
    case FA00:
      applyCommand(write.value);
      break;
    case FA01:
      speed_by_rpm_ = false;
      break;
    case FA13:
      speed_by_rpm_ = true;
      break;
    case FA20:
      if ((write.value & 0x0002U) != 0)
      {
        usage_.clearEnergy();
      }
      break;
    default:
      break;
  }
}

void ToshibaVfs15::applyCommand(std::uint16_t word)
{
  if ((word & (COMMAND_RUN | COMMAND_JOG)) == 0)
  {
    held_by_key_ = false;
  }
  clearRunWhenCoasting();
  if ((word & COMMAND_EMERGENCY) != 0 && !tripped_)
  {
    // F603: 0 = coast, else by a ramp (its own ramps and DC braking are not simulated).
    if (raw(F603) == 0)
    {
      doTrip(TRIP_EMERGENCY);
    }
    else
    {
      tripAfterStop(TRIP_EMERGENCY);
    }
  }
}

void ToshibaVfs15::clearRunWhenCoasting()
{
  // F719 = 1, as from the factory, keeps the run command (p. 47).
  if (coasting() && raw(F719) != 1)
  {
    ram_[FA00] = static_cast<std::uint16_t>(ram_[FA00] & ~(COMMAND_RUN | COMMAND_JOG));
  }
}

void ToshibaVfs15::takeFromPanel(Index index, std::uint32_t raw)
{
  memory_.writeBoth(index, raw);
  afterStore(memory_.info(index).number, raw);
}

void ToshibaVfs15::afterStore(Number number, std::uint32_t raw)
{
  switch (number)
  {
    case TYP:
      restoreFactorySettings(raw);
      break;
    case F519:
      setTimeUnit(raw);
      memory_.commission(memory_.at(F519), 0);  // reads 0 when done
      break;
    case F802:
      setStation(static_cast<int>(raw));
      break;
    case F803:
      watchdog_.reset();  // starts with the first exchange after this one (p. 50)
      timer_renewed_ = true;
      break;
    case F899:
      memory_.commission(memory_.at(F899), 0);
      if (raw == 1)
      {
        takeEffect();
        watchdog_.reset();
        timer_renewed_ = true;
      }
      break;
    default:
      break;
  }
}

void ToshibaVfs15::setTimeUnit(std::uint32_t unit)
{
  const std::uint32_t old = raw(TIME_UNIT);
  if (unit == 0 || unit == old)
  {
    return;
  }
  for (const Number number : { ACC, DEC, F500, F501, F510, F511 })
  {
    const Index index = memory_.at(number);
    const std::uint32_t time = unit == 1 ? memory_.ram(index) * 10 : memory_.ram(index) / 10;
    memory_.commission(index, std::min(time, memory_.info(index).maximum));
  }
  memory_.commission(memory_.at(TIME_UNIT), unit);
}

void ToshibaVfs15::restoreFactorySettings(std::uint32_t kind)
{
  // 1 = 50 Hz, 2 = 60 Hz, 3 = everything but the adjustment of the meter and the note (M).
  memory_.commission(memory_.at(TYP), 0);
  if (kind == 1 || kind == 2)
  {
    const std::uint32_t base = kind == 1 ? 5000 : 6000;
    memory_.commission(memory_.at(VL), base);
    memory_.commission(memory_.at(UL), std::min(base, raw(FH)));
  }
  if (kind != 3)
  {
    return;
  }
  for (const Parameter& parameter : model_.parameters)
  {
    const Number number = parameter.number;
    if (number != FMSL && number != FM && number != F109 && number != F880 && !readOnly(number))
    {
      memory_.commission(memory_.at(number), parameter.initial);
    }
  }
  memory_.commission(memory_.at(TIME_UNIT), 2);
  clearRam();
  setStation(static_cast<int>(raw(F802)));
  busy_until_ = clock() + seconds(FACTORY_TIME);
}

Parameter ToshibaVfs15::asShown(Index index) const
{
  Parameter info = memory_.info(index);
  info.decimals = rampTime(info.number) && raw(TIME_UNIT) == 1 ? 2 : info.decimals;
  return info;
}
}  // namespace simulation
}  // namespace inverter_bus

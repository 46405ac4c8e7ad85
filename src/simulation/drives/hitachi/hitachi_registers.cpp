// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Holding registers of the MX2 and RX. Numbers as printed (MX2-SYS chapter 6 and I570 appendix B; SJ700a for the RX);
// the frame carries number - 1. 32-bit values: high word first.

#include <cmath>
#include <utility>

#include "simulation/drives/hitachi/hitachi_drive.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr std::uint16_t REFERENCE_HIGH = 0x0001;  // F001
constexpr std::uint16_t REFERENCE_LOW = 0x0002;
constexpr std::uint16_t PID_FEEDBACK = 0x0006;
/// I570 p. 306, 309: "reserved", where others are "not used, inaccessible". 1029h: a real MX2 answered a write with 23h.
constexpr std::uint16_t RESERVED[] = { 0x0007, 0x0008, 0x0009, 0x000A, 0x000B, 0x000C, 0x000D,
                                       0x000E, 0x000F, 0x0010, 0x100F, 0x101A, 0x101B, 0x101C,
                                       0x1020, 0x1021, 0x1022, 0x1023, 0x1024, 0x1025, 0x1029 };
constexpr std::uint16_t FIRST_TRIP_BLOCK = 0x0012;  // d081
constexpr std::uint16_t TRIP_BLOCK_SIZE = 10;
constexpr std::uint16_t ENTER = 0x0900;
constexpr std::uint16_t WRITE_MODE = 0x0902;
constexpr std::uint16_t MIRROR_FIRST = 0x1E01;  // coils 0010h-001Fh, then 0020h ...
constexpr std::uint16_t MIRROR_LAST = 0x1E05;
constexpr std::uint16_t COMMAND_MIRROR = 0x1F01;  // bit n = coil n
constexpr std::uint16_t WRITABLE_MIRROR_BITS = 0x3F9E;
constexpr double HOUR = 3600.0;

std::uint32_t withWord(std::uint32_t old, bool high, std::uint16_t word)
{
  return high ? (old & 0x0000FFFFU) | (static_cast<std::uint32_t>(word) << 16U) : (old & 0xFFFF0000U) | word;
}

std::uint16_t wordOf(std::uint32_t raw, bool high)
{
  return static_cast<std::uint16_t>(high ? raw >> 16U : raw & 0xFFFFU);
}
}  // namespace

void HitachiDrive::addMonitor(std::uint16_t number, int words, const std::function<double()>& raw)
{
  for (int word = 0; word < words; ++word)
  {
    monitors_[static_cast<std::uint16_t>(number + word)] = { number, Monitor{ words, raw } };
  }
}

// NOLINTNEXTLINE(readability-function-cognitive-complexity): a table, one line per register
void HitachiDrive::buildMonitors()
{
  const auto zero = [] { return 0.0; };
  addMonitor(0x0003, 1, [this] { return tripped_ ? 8.0 : (motor_.turning() || runCommanded() ? 3.0 : 2.0); });
  addMonitor(0x0004, 1, [this] {
    return tripped_ ? static_cast<double>(trip_state_) : (motor_.turning() || runCommanded() ? 1.0 : 0.0);
  });
  addMonitor(0x0005, 1, [this] {  // status C
    const bool reversing = motor_.decelerating() && motor_.target() * motor_.frequency() < 0.0;
    const double ramp = motor_.accelerating() ? 4.0 : (motor_.decelerating() ? 2.0 : 3.0);
    return !motor_.turning() ? 1.0 : (reversing ? (motor_.frequency() > 0.0 ? 7.0 : 8.0) : ramp);
  });
  addMonitor(0x0011, 1, [this] { return static_cast<double>(trip_count_); });        // d080
  addMonitor(0x1001, 2, [this] { return std::abs(motor_.frequency()) * 100.0; });    // d001
  addMonitor(0x1003, 1, [this] { return motor_.current() / model_.current_step; });  // d002
  addMonitor(0x1004, 1, [this] { return motor_.frequency() == 0.0 ? 0.0 : (motor_.frequency() > 0.0 ? 1.0 : 2.0); });
  addMonitor(0x1005, 2, [this] { return pid_feedback_ / 10.0; });  // d004
  addMonitor(0x1007, 1, [this] { return static_cast<double>(coilWord(0x0007) & ((1U << model_.inputs) - 1U)); });
  addMonitor(0x1008, 1, [this] { return (motor_.turning() ? 1.0 : 0.0) + (tripped_ ? 4.0 : 0.0); });  // d006
  addMonitor(0x1009, 2, [this] { return std::abs(motor_.frequency()) * memory_.ram(code_.b086); });   // d007
  addMonitor(0x100B, 2, zero);                                                      // d008, no encoder
  addMonitor(0x100D, 1, zero);                                                      // d009
  addMonitor(0x100E, 1, zero);                                                      // d010
  addMonitor(0x1010, 1, [this] { return motor_.torque(); });                        // d012
  addMonitor(0x1011, 1, [this] { return motor_.voltage() * 10.0; });                // d013
  addMonitor(0x1012, 1, [this] { return motor_.power() * 10.0; });                  // d014
  addMonitor(0x1013, 2, [this] { return usage_.energy() * 10.0; });                 // d015
  addMonitor(0x1015, 2, [this] { return std::floor(usage_.runTime() / HOUR); });    // d016
  addMonitor(0x1017, 2, [this] { return std::floor(usage_.powerTime() / HOUR); });  // d017
  addMonitor(0x1019, 1, [this] { return motor_.temperature() * 10.0; });            // d018
  addMonitor(0x101D, 1, zero);                                                      // d022
  addMonitor(0x101E, 1, zero);                                                      // d023
  addMonitor(0x101F, 1, zero);                                                      // d024
  addMonitor(0x1026, 1, [this] { return motor_.dcVoltage() * 10.0; });              // d102
  addMonitor(0x1027, 1, zero);                                                      // d103
  addMonitor(0x1028, 1, [this] { return usage_.heat() * 1000.0; });                 // d104
  addMonitor(0x102E, 2, zero);                                                      // d025
  addMonitor(0x1030, 2, zero);                                                      // d026
  addMonitor(0x1032, 2, zero);                                                      // d027
  buildModelMonitors();
  buildTripMonitors();
}

void HitachiDrive::buildModelMonitors()
{
  const auto zero = [] { return 0.0; };
  if (model_.name == "omron_rx")
  {
    addMonitor(0x101A, 1, [this] { return motor_.temperature() * 10.0; });  // d019 (MEM)
    addMonitor(0x1034, 2, zero);                                            // d028 (MEM)
    return;
  }
  addMonitor(0x1036, 2, zero);                                                             // d029
  addMonitor(0x1038, 2, zero);                                                             // d030
  addMonitor(0x1057, 1, zero);                                                             // d060
  addMonitor(0x1059, 1, [this] { return static_cast<double>(memory_.ram(code_.a001)); });  // d062 (content MEM)
  addMonitor(0x105A, 1, [this] { return static_cast<double>(memory_.ram(code_.a002)); });  // d063 (content MEM)
  for (const int number : { 0x10A1, 0x10A2, 0x10A4, 0x10A6, 0x10A8 })
  {
    addMonitor(static_cast<std::uint16_t>(number), 1, zero);  // d130, d131, d133, d153, d155
  }
  for (const std::uint16_t number : RESERVED)
  {
    if (options_.reserved_readable)
    {
      addMonitor(number, 1, zero);
    }
  }
}

void HitachiDrive::buildTripMonitors()
{
  for (std::size_t block = 0; block < trips_.size(); ++block)
  {
    const std::uint16_t number = static_cast<std::uint16_t>(FIRST_TRIP_BLOCK + block * TRIP_BLOCK_SIZE);
    const auto at = [number](int offset) { return static_cast<std::uint16_t>(number + offset); };
    addMonitor(at(0), 1, [this, block] { return static_cast<double>(trips_[block].code); });
    addMonitor(at(1), 1, [this, block] { return static_cast<double>(trips_[block].state); });
    addMonitor(at(2), 2, [this, block] { return trips_[block].frequency * 100.0; });
    addMonitor(at(4), 1, [this, block] { return trips_[block].current / model_.current_step; });
    addMonitor(at(5), 1, [this, block] { return trips_[block].dc_voltage / model_.trip_voltage_step; });
    addMonitor(at(6), 2, [this, block] { return std::floor(trips_[block].run_time / HOUR); });
    addMonitor(at(8), 2, [this, block] { return std::floor(trips_[block].power_time / HOUR); });
  }
  addMonitor(0x004E, 1, [] { return 0.0; });  // d090 warning code
}

std::optional<std::uint16_t> HitachiDrive::readRegister(std::uint16_t number) const
{
  if (number == REFERENCE_HIGH || number == REFERENCE_LOW)
  {
    return wordOf(reference_, number == REFERENCE_HIGH);
  }
  const auto monitor = monitors_.find(number);
  if (monitor != monitors_.end())
  {
    const std::uint32_t raw = static_cast<std::uint32_t>(std::llround(monitor->second.second.raw()));
    return wordOf(raw, monitor->second.second.words == 2 && number == monitor->second.first);
  }
  const Index index = memory_.at(number);
  if (index != ParameterMemory::NONE)
  {
    const Parameter& info = memory_.info(index);
    return wordOf(memory_.ram(index), info.words == 2 && number == info.number);
  }
  if (number == PID_FEEDBACK)
  {
    return pid_feedback_;
  }
  if (number == ENTER || number == WRITE_MODE)
  {
    return static_cast<std::uint16_t>(0);
  }
  if (model_.coil_mirror && number >= MIRROR_FIRST && number <= MIRROR_LAST)
  {
    return coilWord(0x0010 * (number - MIRROR_FIRST + 1));
  }
  if (model_.coil_mirror && number == COMMAND_MIRROR)
  {
    return coilWord(0x0000);
  }
  return std::nullopt;
}

ModbusException HitachiDrive::readRegisters(std::uint16_t wire, std::uint16_t count, std::vector<std::uint16_t>& values)
{
  if (count > 1 && !options_.mapped_reads_in_blocks && mapsAny(wire + 1U, count))
  {
    return ModbusException::AddressNotFound;
  }
  for (std::uint32_t number = wire + 1U; number <= static_cast<std::uint32_t>(wire) + count; ++number)
  {
    std::uint16_t value = 0;
    const ModbusException exception =
        number <= 0xFFFFU ? readMapped(static_cast<std::uint16_t>(number), value) : ModbusException::AddressNotFound;
    if (exception != ModbusException::None)
    {
      return exception;
    }
    values.push_back(value);
  }
  return ModbusException::None;
}

ModbusException HitachiDrive::stage(std::uint16_t number, std::uint16_t value, Change& change) const
{
  const Index index = memory_.at(number);
  if (index != ParameterMemory::NONE)
  {
    const Parameter& info = memory_.info(index);
    const auto staged = change.parameters.emplace(index, memory_.ram(index)).first;
    staged->second = withWord(info.words == 2 ? staged->second : 0U, info.words == 2 && number == info.number, value);
    return ModbusException::None;
  }
  switch (number)
  {
    case REFERENCE_HIGH:
    case REFERENCE_LOW:
      change.reference = withWord(change.reference.value_or(reference_), number == REFERENCE_HIGH, value);
      return ModbusException::None;
    case PID_FEEDBACK:
      change.pid_feedback = value;
      return ModbusException::None;
    case ENTER:
      change.enter = value;
      return ModbusException::None;
    case WRITE_MODE:
      change.write_mode = value;
      return ModbusException::None;
    default:
      break;
  }
  if (number == COMMAND_MIRROR && model_.coil_mirror)
  {
    change.coils = value;
    return ModbusException::None;
  }
  return readRegister(number) ? ModbusException::ReadOnly : ModbusException::AddressNotFound;
}

ModbusException HitachiDrive::checkParameter(Index index, std::uint32_t raw) const
{
  const Parameter& info = memory_.info(index);
  const std::uint32_t lock = memory_.ram(code_.b031);  // 2, 3: everything but b031 is locked (MEM)
  const bool locked = (lock == 2 || lock == 3) && index != code_.b031;
  const bool undervoltage = tripped_ && trips_.front().code == 9;
  if (!memory_.accepts(index, raw))
  {
    return ModbusException::ValueOutOfRange;
  }
  const bool base_above_maximum =
      (index == code_.a003 && raw > memory_.ram(code_.a004)) || (index == code_.a004 && raw < memory_.ram(code_.a003));
  const double hertz = raw / std::pow(10.0, info.decimals);
  const bool speed_above_maximum = info.code >= "A020" && info.code <= "A035" && hertz > maximumFrequency();
  if (base_above_maximum || speed_above_maximum)
  {
    return ModbusException::ValueOutOfRange;
  }
  if (locked || undervoltage || (motor_.turning() && !info.while_running))
  {
    return ModbusException::NotAllowedNow;
  }
  return ModbusException::None;
}

ModbusException HitachiDrive::check(const Change& change) const
{
  if (busy() && (!change.parameters.empty() || change.enter || change.write_mode))
  {
    return model_.busy_exception ? ModbusException::EepromBusy : ModbusException::NotAllowedNow;
  }
  for (const auto& parameter : change.parameters)
  {
    const ModbusException exception = checkParameter(parameter.first, parameter.second);
    if (exception != ModbusException::None)
    {
      return exception;
    }
  }
  const bool reference_too_high = change.reference && *change.reference > maximumFrequency() * 100.0 + 0.5;
  const bool feedback_too_high = change.pid_feedback && *change.pid_feedback > 10000;  // 0.01 %
  if (reference_too_high || feedback_too_high)
  {
    return ModbusException::ValueOutOfRange;
  }
  const bool undervoltage = tripped_ && trips_.front().code == 9;
  if (change.enter && (motor_.turning() || undervoltage))
  {
    return ModbusException::NotAllowedNow;
  }
  return ModbusException::None;
}

void HitachiDrive::apply(const Change& change, bool to_eeprom)
{
  for (const auto& parameter : change.parameters)
  {
    if (to_eeprom)
    {
      memory_.writeBoth(parameter.first, parameter.second);
      busy_until_ = clock() + seconds(options_.eeprom_time);
    }
    else
    {
      memory_.writeRam(parameter.first, parameter.second);
    }
  }
  reference_ = change.reference.value_or(reference_);
  pid_feedback_ = change.pid_feedback.value_or(pid_feedback_);
  if (change.enter && *change.enter != 0)  // 0: recalculate the motor constants only
  {
    memory_.store();
    busy_until_ = clock() + seconds(options_.eeprom_time);
  }
  if (change.write_mode)
  {
    store_next_write_ = *change.write_mode == 1;
  }
  for (int number = 1; change.coils && number < 16; ++number)
  {
    if (((WRITABLE_MIRROR_BITS >> number) & 1) != 0)
    {
      setCoil(number, ((*change.coils >> number) & 1) != 0);
    }
  }
}

ModbusException HitachiDrive::writeRegisters(std::uint16_t wire, const std::vector<std::uint16_t>& values,
                                             std::uint8_t /*function*/)
{
  Change change;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const std::size_t number = wire + 1U + i;
    const ModbusException exception = number <= 0xFFFFU
                                          ? stageMapped(static_cast<std::uint16_t>(number), values[i], change)
                                          : ModbusException::AddressNotFound;
    if (exception != ModbusException::None)
    {
      return exception;
    }
  }
  const ModbusException exception = check(change);
  if (exception == ModbusException::None)
  {
    apply(change, store_this_write_);
    control();
  }
  return exception;
}
}  // namespace simulation
}  // namespace inverter_bus

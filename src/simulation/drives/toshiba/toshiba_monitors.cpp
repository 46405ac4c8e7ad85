// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Read-only registers of the VF-S15 (E6581913 p. 56-63, 70-75).

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
constexpr double HOUR = 3600.0;           // [s]
constexpr double AC_PER_DC = 0.70710678;  // the drive shows its DC bus as mains voltage
constexpr double OUTPUT_SHARE = 0.95;     // of the input power
constexpr double EARLY_WARNING = 0.5;     // of the overload integrator
constexpr double HIGH_CURRENT = 1.5;      // x rated
constexpr int CPU1_VERSION = 0x0100;
constexpr int CPU2_VERSION = 0x0101;
constexpr int EEPROM_VERSION = 0x0100;

constexpr std::uint32_t OUTPUT_LOW_SPEED = 4;  // functions of the output terminals; data 92-95: p. 55, the rest M
constexpr std::uint32_t OUTPUT_REACHED = 6;
constexpr std::uint32_t OUTPUT_FAULT = 10;
constexpr std::uint32_t OUTPUT_DATA_1 = 92;
constexpr std::uint32_t OUTPUT_DATA_1_INVERSE = 93;
constexpr std::uint32_t OUTPUT_DATA_2 = 94;
constexpr std::uint32_t OUTPUT_DATA_2_INVERSE = 95;

std::uint16_t bit(unsigned int number, bool value)
{
  return static_cast<std::uint16_t>(value ? 1U << number : 0U);
}
}  // namespace

void ToshibaVfs15::addMonitor(Number number, std::function<double()> raw)
{
  monitors_[number] = std::move(raw);
}

void ToshibaVfs15::addHeld(Number number, const std::function<double()>& raw)
{
  addMonitor(number, raw);
  addMonitor(static_cast<Number>(number + 0x0100), raw);
  held_[static_cast<Number>(number + 0x0100)] = 0;
}

void ToshibaVfs15::buildMonitors()
{
  addHeld(0xFD01, [this] { return static_cast<double>(status1()); });
  addHeld(0xFD06, [this] { return static_cast<double>(unstable(0xFF00)); });  // no input is on
  addHeld(0xFD07, [this] { return static_cast<double>(outputTerminals()); });
  addHeld(0xFD42, [this] { return static_cast<double>(status2()); });
  addHeld(0xFD49, [this] { return static_cast<double>(status3()); });
  addMonitor(0xFD45, [this] { return static_cast<double>(commandSource()); });
  addMonitor(0xFD46, [this] { return static_cast<double>(frequencySource()); });
  addMonitor(0xFC90, [this] { return tripped_ ? static_cast<double>(trips_.front()) : 0.0; });
  addMonitor(FC91, [this] { return static_cast<double>(alarms()); });
  addMonitor(FC92, [] { return 0.0; });
  if (model_.older_monitors)
  {
    addMonitor(0xFE45, [this] { return static_cast<double>(commandSource()); });
    addMonitor(0xFE46, [this] { return static_cast<double>(frequencySource()); });
    addMonitor(0xFE09, [] { return EEPROM_VERSION; });
  }
  buildMeasurements();
  buildRecords();
}

void ToshibaVfs15::buildMeasurements()
{
  const auto frequency = [this] { return std::abs(motor_.frequency()) * 100.0; };
  const auto rated_current = [this] { return raw(FE70) / 10.0; };
  const auto rated_voltage = [this] { return raw(FE71) / 10.0; };
  const auto load = [this, rated_current] { return outputCurrent() / rated_current() * 100.0; };
  const auto zero = [] { return 0.0; };
  addHeld(0xFD00, frequency);
  addHeld(0xFD02, [this] { return wantedFrequency() * 100.0; });
  addHeld(0xFD03, [load] { return load() * 100.0; });
  addHeld(0xFD04, [this, rated_voltage] { return motor_.dcVoltage() * AC_PER_DC / rated_voltage() * 10000.0; });
  addHeld(0xFD05, [this, rated_voltage] { return motor_.voltage() / rated_voltage() * 10000.0; });
  addHeld(0xFD15, frequency);
  addHeld(0xFD16, frequency);
  addHeld(0xFD18, [this] { return motor_.torque() * 100.0; });
  addHeld(0xFD20, [this] { return motor_.torque() * 100.0; });
  addHeld(0xFD22, zero);  // PID feedback
  addHeld(0xFD23, [this] { return usage_.heat() * 10000.0; });
  addHeld(0xFD24, [this] { return usage_.heat() * 10000.0; });
  addHeld(0xFD25, zero);  // braking resistor
  addHeld(0xFD26, load);
  addHeld(0xFD27, load);
  addHeld(0xFD28, zero);
  addHeld(0xFD29, [this] { return motor_.power() * 100.0; });
  addHeld(0xFD30, [this] { return motor_.power() * OUTPUT_SHARE * 100.0; });
  addHeld(0xFD90, [this] { return std::abs(motor_.frequency()) * 60.0 / raw(F856); });
  addMonitor(0xFD40, zero);  // pulse train
  addMonitor(0xFE35, zero);  // VIA, VIB, VIC: not connected
  addMonitor(0xFE36, zero);
  addMonitor(0xFE37, zero);
  addMonitor(0xFE40, [this] { return raw(FMSL) == 18 ? ram_.at(FA51) * 10.0 : 0.0; });
  addMonitor(0xFE56, zero);
}

void ToshibaVfs15::buildRecords()
{
  const auto tens_of_hours = [](double seconds) { return std::floor(seconds / (10.0 * HOUR)); };
  // Energy units: F749.
  const auto energy = [this](double share) {
    return std::floor(usage_.energy() * share / std::pow(10.0, raw(F749) - 1.0));
  };
  const Number trips[] = { 0xFE10, 0xFE11, 0xFE12, 0xFE13, 0xFD10, 0xFD11, 0xFD12, 0xFD13 };
  for (std::size_t age = 0; age < trips_.size(); ++age)
  {
    addMonitor(trips[age], [this, age] { return static_cast<double>(trips_[age]); });
  }
  addMonitor(0xFD32, [this] { return std::floor((starts_[0] + starts_[1]) / 1000.0); });
  addMonitor(0xFD33, [this] { return std::floor(starts_[0] / 1000.0); });
  addMonitor(0xFD34, [this] { return std::floor(starts_[1] / 1000.0); });
  addMonitor(0xFD41, [this, tens_of_hours] { return tens_of_hours(usage_.runTime()); });
  addMonitor(0xFE08, [] { return CPU1_VERSION; });
  addMonitor(0xFE73, [] { return CPU2_VERSION; });
  addMonitor(0xFE14, [this] { return std::floor(usage_.runTime() / HOUR); });
  addMonitor(0xFE76, [energy] { return energy(1.0); });
  addMonitor(0xFE77, [energy] { return energy(OUTPUT_SHARE); });
  addMonitor(0xFE79, [] { return 0.0; });
  addMonitor(0xFE80, [this, tens_of_hours] { return tens_of_hours(usage_.powerTime()); });
  addMonitor(0xFB05, [this] { return capacityCode(); });
  addMonitor(0xFB07, [this] { return model_.series_code; });
  addMonitor(0xFC00, [] { return 0.0; });
  addMonitor(0xFC01, [] { return 0.0; });
}

std::uint16_t ToshibaVfs15::unstable(std::uint16_t mask)
{
  return static_cast<std::uint16_t>(random().next() & mask);
}

std::uint16_t ToshibaVfs15::status1()
{
  const std::uint16_t command = ram_.at(FA00);
  const int emergency = tripped_ ? trips_.front() : trip_after_stop_;
  const bool backwards = motor_.turning() ? motor_.frequency() < 0.0 : runs() && reverse();
  const bool ready = powered() && !tripped_;
  unsigned int word = unstable(0x8000);
  word |= bit(0, output(raw(F132))) | bit(1, tripped_) | bit(2, readRegister(FC91) != 0 || readRegister(FC92) != 0);
  word |= bit(4, busCommands() && (command & 0x0010U) != 0) | bit(5, (command & 0x0020U) != 0);
  word |= bit(6, accelerationPattern() == 2) | bit(7, dcBraking()) | bit(8, jogging()) | bit(9, backwards);
  word |= bit(10, running()) | bit(11, coasting()) | bit(12, emergency == TRIP_EMERGENCY);
  word |= bit(13, ready && running()) | bit(14, ready);
  return static_cast<std::uint16_t>(word);
}

std::uint16_t ToshibaVfs15::status2()
{
  const unsigned int pattern = static_cast<unsigned int>(accelerationPattern() - 1);
  const unsigned int stall = ram_.at(FA20) & 0x1000U;
  return static_cast<std::uint16_t>(unstable(0xEC7F) | bit(7, forcedStop()) | (pattern << 8U) | stall);
}

std::uint16_t ToshibaVfs15::status3()
{
  const bool constant = motor_.turning() && !motor_.accelerating() && !motor_.decelerating();
  const bool odd_second = static_cast<long>(toSeconds(clock() - powered_since_)) % 2 == 1;
  unsigned int word = unstable(0x03FC) | (ram_.at(FA26) & 3U) | bit(10, constant) | bit(11, odd_second);
  word |= bit(12, runs() && reached(wantedFrequency())) | bit(13, reached(hertz(F101)));
  word |= bit(14, motor_.accelerating()) | bit(15, motor_.decelerating());
  return static_cast<std::uint16_t>(word);
}

bool ToshibaVfs15::reached(double target) const
{
  return std::abs(std::abs(motor_.frequency()) - target) <= hertz(F102);
}

bool ToshibaVfs15::output(std::uint32_t function) const
{
  switch (function)
  {
    case OUTPUT_LOW_SPEED:
      return motor_.turning() && std::abs(motor_.frequency()) >= hertz(F100);
    case OUTPUT_REACHED:
      return runs() && reached(wantedFrequency());
    case OUTPUT_FAULT:
      return tripped_;
    case OUTPUT_DATA_1:
    case OUTPUT_DATA_1_INVERSE:
      return ((ram_.at(FA50) & 1U) != 0) == (function == OUTPUT_DATA_1);
    case OUTPUT_DATA_2:
    case OUTPUT_DATA_2_INVERSE:
      return ((ram_.at(FA50) & 2U) != 0) == (function == OUTPUT_DATA_2);
    default:
      return false;
  }
}

std::uint16_t ToshibaVfs15::outputTerminals()
{
  const std::uint16_t hold = ram_.at(FA26);
  const bool relay = output(raw(F130)) || (hold & 1U) != 0;
  const bool transistor = output(raw(F131)) || (hold & 2U) != 0;
  return static_cast<std::uint16_t>(unstable(0xFFF8) | bit(0, relay) | bit(1, transistor) | bit(2, output(raw(F132))));
}

std::uint16_t ToshibaVfs15::alarms() const
{
  const bool timeout = watchdog_.expired() && raw(F804) == 0;
  const unsigned int word = bit(0, outputCurrent() > HIGH_CURRENT * raw(FE70) / 10.0) |
                            bit(2, usage_.heat() > EARLY_WARNING) | bit(12, timeout);
  return static_cast<std::uint16_t>(word & model_.alarm_bits);
}
}  // namespace simulation
}  // namespace inverter_bus

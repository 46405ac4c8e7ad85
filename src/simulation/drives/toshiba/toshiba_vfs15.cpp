// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/toshiba/toshiba_vfs15.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulation/drives/toshiba/toshiba_numbers.h"

namespace inverter_bus
{
namespace simulation
{
using namespace toshiba;  // NOLINT: the numbers of this drive

namespace
{
constexpr std::size_t KEPT_TRIPS = 8;
constexpr std::uint32_t PROTOCOL_MODBUS = 1;
constexpr std::uint32_t FIRST_MASTER = 3;  // F806: from here on the drive talks to others by itself
constexpr int LAST_STATION = 247;
constexpr double STEP = 0.1;            // [s] between two looks at the current while the motor turns
constexpr double OVERCURRENT = 2.2;     // x rated current: trips at once
constexpr double OVERLOAD_TIME = 60.0;  // [s] at 150 % of the thermal level until OL2
constexpr double COOLING_TIME = 120.0;  // [s]
constexpr double STILL_HOT = 0.9;       // of the overload integrator: OL2 can't be reset above
constexpr int TRIP_OVERLOAD = 14;       // OL2
constexpr auto EEPROM_DELAY = std::chrono::milliseconds(45);  // p. 73: at most 50 ms with processing
const std::map<int, std::uint32_t> BAUDS = { { 9600, 3 }, { 19200, 4 }, { 38400, 5 } };  // F800
}  // namespace

ToshibaVfs15::ToshibaVfs15(const ToshibaModel& model, const DriveOptions& options)
  : ModbusSlave(options.name, options.station, options.seed, options.start, model.limits)
  , model_(model)
  , options_(options)
  , memory_(model.parameters)
  , motor_(MotorRating())
  , trips_(KEPT_TRIPS, 0)
  , powered_since_(options.start)
  , busy_until_(options.start)
  , run_time_(3600.0 * (300 + options.station))
  , power_time_(3600.0 * (1200 + options.station))
{
  commission();
  setStation(static_cast<int>(raw(F802)));
  motor_.setLoad(options.load);
  buildMonitors();
  clearRam();
  takeEffect();
  control();
}

void ToshibaVfs15::commission()
{
  const auto baud = BAUDS.find(options_.line.baud_rate);
  if (baud == BAUDS.end())
  {
    throw std::invalid_argument(model_.name + " has no baud rate " + std::to_string(options_.line.baud_rate));
  }
  if (options_.station < 0 || options_.station > LAST_STATION)
  {
    throw std::invalid_argument(model_.name + " has no station " + std::to_string(options_.station) + " (0-" +
                                std::to_string(LAST_STATION) + ")");
  }
  commission("F829", PROTOCOL_MODBUS);
  commission("F800", baud->second);
  commission("F801", static_cast<int>(options_.line.parity));
  commission("F802", options_.station);
  for (const auto& parameter : options_.parameters)
  {
    commission(parameter.first, parameter.second);
  }
}

void ToshibaVfs15::commission(const std::string& code, double value)
{
  const Index index = memory_.find(code);
  if (index == ParameterMemory::NONE)
  {
    throw std::invalid_argument(model_.name + " has no parameter " + code);
  }
  const Parameter info = asShown(index);
  const double raw = std::round(value * std::pow(10.0, info.decimals));
  if (!(raw >= 0.0 && raw <= 65535.0) || !memory_.accepts(index, static_cast<std::uint32_t>(raw)))
  {
    throw std::invalid_argument("value out of range for " + code + " (" + panelText(info, info.minimum) + "-" +
                                panelText(info, info.maximum) + ")");
  }
  if (info.number == F519)
  {
    setTimeUnit(static_cast<std::uint32_t>(raw));
    return;
  }
  memory_.commission(index, static_cast<std::uint32_t>(raw));
}

void ToshibaVfs15::takeEffect()
{
  const auto baud =
      std::find_if(BAUDS.begin(), BAUDS.end(), [this](const auto& one) { return raw(F800) == one.second; });
  std::optional<LineSettings> serial;
  if (raw(F829) == PROTOCOL_MODBUS && raw(F806) < FIRST_MASTER && baud != BAUDS.end())
  {
    serial = LineSettings();
    serial->baud_rate = baud->first;
    serial->parity = static_cast<Parity>(raw(F801));
    // Stop bits: the drive takes 1 (p. 4); a second one is silence to it.
  }
  setSerial(serial);
  if (model_.blocks)
  {
    in_effect_.write_slots = { raw(F870), raw(F871) };
    for (std::size_t slot = 0; slot < in_effect_.read_slots.size(); ++slot)
    {
      in_effect_.read_slots[slot] = raw(static_cast<Number>(F875 + slot));
    }
  }
}

void ToshibaVfs15::clearRam()
{
  for (const Number number : { FA00, FA01, FA10, FA11, FA13, FA20, FA26, FA50, FA51, FA87 })
  {
    ram_[number] = 0;
  }
  speed_by_rpm_ = false;
  held_by_key_ = false;
}

std::uint32_t ToshibaVfs15::raw(Number number) const
{
  return memory_.ram(memory_.at(number));
}

double ToshibaVfs15::hertz(Number number) const
{
  return raw(number) / 100.0;
}

const Motor& ToshibaVfs15::motor() const
{
  return motor_;
}

bool ToshibaVfs15::tripped() const
{
  return tripped_;
}

double ToshibaVfs15::startUpTime() const
{
  return options_.start_up_time;
}

bool ToshibaVfs15::isBroadcast(const Bytes& frame) const
{
  return frame[0] == 0;  // also for a drive with F802 = 0
}

Duration ToshibaVfs15::replyDelay() const
{
  return seconds(options_.turnaround) + std::chrono::milliseconds(10) * raw(F805) +
         (stored_ ? EEPROM_DELAY : std::chrono::milliseconds(0));
}

void ToshibaVfs15::heard(std::uint8_t /*function*/)
{
  // Only what was accepted feeds the timer: answer().
}

bool ToshibaVfs15::busy() const
{
  return clock() < busy_until_;
}

bool ToshibaVfs15::communicationMode() const
{
  return raw(FMOD) == 4 || raw(CMOD) == 2 || (ram_.at(FA00) & 0xC000U) != 0;
}

Duration ToshibaVfs15::watchdogTimeout() const
{
  const std::uint32_t when = raw(F808);
  const bool armed = when == 0 || (communicationMode() && (when == 1 || running()));
  return armed && powered() ? std::chrono::milliseconds(100) * raw(F803) : Duration::zero();
}

TimePoint ToshibaVfs15::nextChange(TimePoint limit) const
{
  TimePoint next = limit;
  const std::optional<TimePoint> deadline = watchdog_.deadline(watchdogTimeout());
  if (deadline)
  {
    next = std::min(next, *deadline);
  }
  if (motor_.turning())
  {
    const double corner = motor_.timeToNextCorner();
    // One tick more: the corner must not be missed by rounding down.
    next = std::min(next, clock() + (corner > 0.0 && corner < STEP ? seconds(corner) + Duration(1) : seconds(STEP)));
  }
  return next;
}

void ToshibaVfs15::move(double seconds)
{
  watchMotor(seconds);
  motor_.advance(seconds);
}

void ToshibaVfs15::watchMotor(double seconds)
{
  power_time_ += powered() ? seconds : 0.0;
  run_time_ += motor_.turning() ? seconds : 0.0;
  energy_ += motor_.power() * seconds / 3600.0;
  const double share = current() / overloadLevel();
  const double excess = share * share - 1.0;
  thermal_ += excess > 0.0 ? seconds * excess / (1.25 * OVERLOAD_TIME) : seconds * excess / COOLING_TIME;
  thermal_ = std::max(0.0, thermal_);
}

void ToshibaVfs15::change()
{
  const std::optional<TimePoint> deadline = watchdog_.deadline(watchdogTimeout());
  if (deadline && *deadline <= clock())
  {
    watchdog_.expire();
    onTimeout();
  }
  if (trip_after_stop_ != 0 && !motor_.turning())
  {
    doTrip(trip_after_stop_);
  }
  if (thermal_ >= 1.0 && !tripped_)
  {
    doTrip(TRIP_OVERLOAD);
  }
  if (motor_.current() > OVERCURRENT * raw(FE70) / 10.0)
  {
    doTrip(motor_.accelerating() ? 1 : (motor_.decelerating() ? 2 : 3));  // OC1, OC2, OC3
  }
}

void ToshibaVfs15::onTimeout()
{
  switch (raw(F804))
  {
    case 1:
      if (!tripped_)
      {
        doTrip(TRIP_COMMUNICATION);
      }
      break;
    case 2:
      tripAfterStop(TRIP_COMMUNICATION);
      break;
    default:  // alarm only, see alarms()
      break;
  }
}

void ToshibaVfs15::tripAfterStop(int code)
{
  if (tripped_)
  {
    return;
  }
  trip_after_stop_ = code;
  control();
  if (!motor_.turning())
  {
    doTrip(code);
  }
}

void ToshibaVfs15::doTrip(int code)
{
  for (auto& held : held_)
  {
    const Number present = static_cast<Number>(held.first - 0x0100);
    held.second = static_cast<std::uint16_t>(std::llround(monitors_.at(present)()));
  }
  trips_.push_front(code);
  trips_.pop_back();
  ++trip_count_;
  tripped_ = true;
  trip_after_stop_ = 0;
  control();
}

void ToshibaVfs15::resetFault()
{
  if (!tripped_)
  {
    return;
  }
  // The cause of an overload is gone when the motor has cooled down a little.
  tripped_ = trips_.front() == TRIP_OVERLOAD && thermal_ > STILL_HOT;
  clearRam();
  panel_run_ = 0;
  takeEffect();
  watchdog_.reset();
  timer_renewed_ = true;
  goDeaf(clock() + seconds(options_.reset_silence));
}

void ToshibaVfs15::losePower()
{
  clearRam();
  pinned_.clear();
  tripped_ = tripped_ && raw(F602) == 1;
  trip_after_stop_ = 0;
  panel_run_ = 0;
  busy_until_ = clock();
  watchdog_.reset();
  motor_.cut();
}

void ToshibaVfs15::gainPower()
{
  powered_since_ = clock();
  takeEffect();
  control();
}
}  // namespace simulation
}  // namespace inverter_bus

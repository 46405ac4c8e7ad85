// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/toshiba/toshiba_vfs15.h"

#include <cmath>

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
constexpr double COOLING_TIME = 120.0;                        // [s]
constexpr double STILL_HOT = 0.9;                             // of the overload integrator: OL2 can't be reset above
constexpr int TRIP_OVERLOAD = 14;                             // OL2
constexpr auto EEPROM_DELAY = std::chrono::milliseconds(45);  // p. 73: at most 50 ms with processing
const std::map<int, std::uint32_t> BAUDS = { { 9600, 3 }, { 19200, 4 }, { 38400, 5 } };  // F800
}  // namespace

ToshibaVfs15::ToshibaVfs15(const ToshibaModel& model, const DriveOptions& options)
  : BrandDrive(options, model.name, model.limits, model.parameters)
  , model_(model)
  , trips_(KEPT_TRIPS, 0)
  , powered_since_(options.start)
  , usage_(options.station, COOLING_TIME)
{
  commissionLine();
  setStation(static_cast<int>(raw(F802)));
  buildMonitors();
  clearRam();
  takeEffect();
  control();
}

void ToshibaVfs15::commissionLine()
{
  const std::uint32_t baud = baudCode(BAUDS);
  requireStation(0, LAST_STATION);
  commission("F829", PROTOCOL_MODBUS);
  commission("F800", baud);
  commission("F801", static_cast<int>(options_.line.parity));
  commission("F802", options_.station);
  commissionOptions();
}

void ToshibaVfs15::takeCommissioned(Index index, std::uint32_t raw)
{
  if (memory_.info(index).number == F519)
  {
    setTimeUnit(raw);
    return;
  }
  memory_.commission(index, raw);
}

void ToshibaVfs15::takeEffect()
{
  const std::optional<int> baud = baudOf(BAUDS, raw(F800));
  std::optional<LineSettings> serial;
  if (raw(F829) == PROTOCOL_MODBUS && raw(F806) < FIRST_MASTER && baud)
  {
    serial = LineSettings();
    serial->baud_rate = *baud;
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

void ToshibaVfs15::move(double seconds)
{
  usage_.count(motor_, powered(), outputCurrent() / overloadLevel(), seconds);
  BrandDrive::move(seconds);
}

void ToshibaVfs15::changeMore()
{
  if (trip_after_stop_ != 0 && !motor_.turning())
  {
    doTrip(trip_after_stop_);
  }
  if (usage_.heat() >= 1.0 && !tripped_)
  {
    doTrip(TRIP_OVERLOAD);
  }
}

int ToshibaVfs15::overcurrentTrip() const
{
  return motor_.accelerating() ? 1 : (motor_.decelerating() ? 2 : 3);  // OC1, OC2, OC3
}

double ToshibaVfs15::ratedCurrent() const
{
  return raw(FE70) / 10.0;
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
  recordTrip(code);
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
  tripped_ = trips_.front() == TRIP_OVERLOAD && usage_.heat() > STILL_HOT;
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
  trip_after_stop_ = 0;
  panel_run_ = 0;
  const bool kept = tripped_ && raw(F602) == 1;
  BrandDrive::losePower();
  tripped_ = kept;
}

void ToshibaVfs15::gainPower()
{
  powered_since_ = clock();
  takeEffect();
  control();
}
}  // namespace simulation
}  // namespace inverter_bus

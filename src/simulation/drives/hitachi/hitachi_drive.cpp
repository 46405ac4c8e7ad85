// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/hitachi/hitachi_drive.h"

#include <algorithm>
#include <cmath>

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr int E_OVERLOAD = 5;
constexpr int E_EXTERNAL = 12;
constexpr int E_COMMUNICATION = 41;
constexpr int COIL_RUN = 0x0001;
constexpr int COIL_REVERSE = 0x0002;
constexpr std::size_t FIRST_INPUT = 0x0007;
constexpr std::uint32_t SOURCE_PANEL = 2;
constexpr std::uint32_t SOURCE_MODBUS = 3;
constexpr std::uint32_t INPUT_FREE_RUN = 11;  // C001-C008 = 11: FRS (MEM)
constexpr std::uint32_t ACTION_IGNORE = 2;    // C076
constexpr std::size_t TRIP_BLOCKS = 6;
constexpr double COOLING_TIME = 300.0;  // [s]
}  // namespace

HitachiDrive::HitachiDrive(const HitachiModel& model, const DriveOptions& options)
  : BrandDrive(options, model.name, model.limits, model.parameters)
  , model_(model)
  , usage_(options.station, COOLING_TIME)
{
  code_ = { known("F002"), known("F003"), known("A001"), known("A002"), known("A003"), known("A004"), known("A020"),
            known("A061"), known("A062"), known("b012"), known("b031"), known("b035"), known("b082"), known("b086"),
            known("b087"), known("b091"), known("C041"), known("C042"), known("C043"), known("C063"), known("C071"),
            known("C072"), known("C074"), known("C075"), known("C076"), known("C077"), known("C078") };
  for (int input = 1; input <= model.inputs; ++input)
  {
    input_functions_.push_back(memory_.find("C00" + std::to_string(input)));
  }
  panel_.setSources({ { code_.a001, code_.a002 }, SOURCE_PANEL, code_.a004 });
  commissionLine();
  motor_.setRating({ options.rated_current, options.rated_voltage, panelValue(code_.a003) });
  trips_.resize(TRIP_BLOCKS);
  buildMonitors();
  setSerial(serialInEffect());
  map_.latch(memory_);
  control();
}

HitachiDrive::Index HitachiDrive::known(const char* code) const
{
  return memory_.find(code);
}

void HitachiDrive::commissionLine()
{
  const std::uint32_t baud = baudCode(model_.bauds);
  requireStation(1, model_.last_station);
  commission("A001", 3);
  commission("A002", 3);
  commission("C071", baud);
  commission("C072", options_.station);
  commission("C074", static_cast<int>(options_.line.parity));
  commission("C075", options_.line.stop_bits);
  if (memory_.find("C073") != ParameterMemory::NONE)
  {
    commission("C073", 8);  // I578: Modbus is always 8 bits, the factory setting is 7
    commission("C079", 1);  // Modbus RTU
  }
  commissionOptions();
}

std::optional<LineSettings> HitachiDrive::serialInEffect() const
{
  const std::optional<int> baud = baudOf(model_.bauds, memory_.ram(code_.c071));
  const Index data_bits = memory_.find("C073");
  const bool modbus =
      data_bits == ParameterMemory::NONE || (memory_.ram(data_bits) == 8 && memory_.ram(memory_.find("C079")) == 1);
  if (!baud || !modbus)
  {
    return std::nullopt;
  }
  LineSettings serial;
  serial.baud_rate = *baud;
  serial.parity = static_cast<Parity>(memory_.ram(code_.c074));
  serial.stop_bits = static_cast<int>(memory_.ram(code_.c075));
  return serial;
}

Duration HitachiDrive::replyDelay() const
{
  // MX2-SYS and SJ700a: 3.5 characters + C078 + a few milliseconds of processing; the line adds the 3.5 characters.
  return seconds(options_.turnaround) + std::chrono::milliseconds(memory_.ram(code_.c078));
}

bool HitachiDrive::isGroup(std::uint8_t station) const
{
  const int own = this->station();
  switch (model_.groups ? station : std::min<int>(station, 1))
  {
    case 0:
      return true;
    case 250:  // group addresses: MX2-EV2
      return own <= 9;
    case 251:
      return own >= 10 && own <= 19;
    case 252:
      return own >= 20 && own <= 29;
    case 253:
      return own >= 30 && own <= 39;
    case 254:
      return own >= 40;
    default:
      return false;
  }
}

void HitachiDrive::heard(std::uint8_t function)
{
  watchdog_.feed(clock());
  // Register 0902h: the next 06h goes to the EEPROM too; any other request ends that (MX2-SYS p. 313).
  store_this_write_ = store_next_write_ && function == 0x06;
  store_next_write_ = false;
  const bool by_timeout = hold_ == Hold::TimeoutRamp || hold_ == Hold::TimeoutFreeRun;
  if (by_timeout && options_.restart_after_timeout)
  {
    setHold(Hold::None);
  }
}

Duration HitachiDrive::watchdogTimeout() const
{
  const bool off = memory_.ram(code_.c076) == ACTION_IGNORE || !powered();
  return off ? Duration::zero() : seconds(memory_.ram(code_.c077) / 100.0);
}

void HitachiDrive::move(double seconds)
{
  const double level = options_.rated_current * memory_.ram(code_.b012) / 1000.0;
  usage_.count(motor_, powered(), motor_.current() / level, seconds);
  BrandDrive::move(seconds);
}

void HitachiDrive::changeMore()
{
  if (trip_after_stop_ && !motor_.turning())
  {
    doTrip(E_COMMUNICATION);
  }
  if (usage_.heat() >= 1.0 && !tripped_)
  {
    doTrip(E_OVERLOAD);
  }
}

int HitachiDrive::overcurrentTrip() const
{
  return motor_.accelerating() ? 3 : (motor_.decelerating() ? 2 : 1);  // E03, E02, E01
}

void HitachiDrive::onTimeout()
{
  switch (memory_.ram(code_.c076))
  {
    case 0:  // trip at once
      doTrip(E_COMMUNICATION);
      break;
    case 1:  // decelerate, stop, then trip
      trip_after_stop_ = !tripped_;
      control();
      break;
    case 3:  // free run, no trip
      setHold(Hold::TimeoutFreeRun);
      break;
    case 4:  // decelerate, no trip
      setHold(Hold::TimeoutRamp);
      break;
    default:
      break;
  }
}

void HitachiDrive::setHold(Hold hold)
{
  // Without a RUN there is nothing to hold back: the next one starts the motor.
  hold_ = coils_[COIL_RUN] ? hold : Hold::None;
  control();
}

bool HitachiDrive::runCommanded() const
{
  if (panel_.inCommand())
  {
    return panel_.hertz() != 0.0;
  }
  const std::uint32_t limit = memory_.ram(code_.b035);  // 0 both directions, 1 forward only, 2 reverse only
  const bool direction_allowed = limit == 0 || (limit == 2) == coils_[COIL_REVERSE];
  return coils_[COIL_RUN] && memory_.ram(code_.a002) == SOURCE_MODBUS && hold_ == Hold::None && !trip_after_stop_ &&
         direction_allowed;
}

double HitachiDrive::maximumFrequency() const
{
  return panelValue(code_.a004);
}

double HitachiDrive::limited(double hertz) const
{
  const double upper = panelValue(code_.a061);
  const double lower = panelValue(code_.a062);
  hertz = std::min(hertz, upper > 0.0 ? std::min(upper, maximumFrequency()) : maximumFrequency());
  return hertz > 0.0 ? std::max(hertz, lower) : 0.0;
}

double HitachiDrive::wantedFrequency() const
{
  if (panel_.inCommand())
  {
    return panel_.hertz() < 0.0 ? -limited(-panel_.hertz()) : limited(panel_.hertz());
  }
  double hertz = 0.0;
  if (memory_.ram(code_.a001) == SOURCE_MODBUS)
  {
    hertz = reference_ / 100.0;
  }
  else if (memory_.ram(code_.a001) == SOURCE_PANEL)
  {
    hertz = panelValue(code_.a020);
  }
  return coils_[COIL_REVERSE] ? -limited(hertz) : limited(hertz);
}

bool HitachiDrive::freeRunInput() const
{
  for (std::size_t input = 0; input < input_functions_.size(); ++input)
  {
    if (coils_[FIRST_INPUT + input] && memory_.ram(input_functions_[input]) == INPUT_FREE_RUN)
    {
      return true;
    }
  }
  return false;
}

void HitachiDrive::control()
{
  motor_.setRamps({ maximumFrequency(), panelValue(code_.f002), panelValue(code_.f003), panelValue(code_.b082) });
  if (!powered() || tripped_ || safe_stop_ || hold_ == Hold::TimeoutFreeRun || freeRunInput())
  {
    motor_.cut();
    return;
  }
  const bool run = runCommanded();
  const bool stop_by_free_run = memory_.ram(code_.b091) == 1 && hold_ != Hold::TimeoutRamp && !trip_after_stop_;
  if (!run && stop_by_free_run)
  {
    motor_.cut();
    return;
  }
  motor_.rampTo(run ? wantedFrequency() : 0.0);
}

int HitachiDrive::runState() const
{
  // The state codes of the trip blocks (PYMX2, from I570).
  if (motor_.accelerating())
  {
    return 4;
  }
  if (motor_.decelerating())
  {
    return 2;
  }
  if (motor_.turning())
  {
    return 3;
  }
  return runCommanded() ? 5 : 1;
}

void HitachiDrive::doTrip(int code)
{
  TripRecord record;
  record.code = code;
  record.state = runState();
  record.frequency = std::abs(motor_.frequency());
  record.current = motor_.current();
  record.dc_voltage = motor_.dcVoltage();
  record.run_time = usage_.runTime();
  record.power_time = usage_.powerTime();
  trips_.push_front(record);
  trips_.pop_back();
  recordTrip(code);
  trip_state_ = TRIP_STATE;
  trip_after_stop_ = false;
  control();
}

void HitachiDrive::resetTrip()
{
  if (!tripped_ || safe_stop_)
  {
    return;
  }
  tripped_ = false;
  usage_.coolDown();
  watchdog_.reset();
  goDeaf(clock() + seconds(options_.reset_silence));
  control();  // a RUN that is still on restarts the motor here
}

void HitachiDrive::losePower()
{
  coils_.fill(false);
  reference_ = 0;
  pid_feedback_ = 0;
  trip_after_stop_ = false;
  hold_ = Hold::None;
  store_next_write_ = false;
  BrandDrive::losePower();
}

void HitachiDrive::gainPower()
{
  setStation(static_cast<int>(memory_.ram(code_.c072)));
  setSerial(serialInEffect());
  map_.latch(memory_);
  if (safe_stop_)
  {
    doTrip(37);
  }
  control();
}

Refusal HitachiDrive::noSuchTrip(int code) const
{
  return code < 1 || code > 99 ? Refusal("trip code out of range (1-99)") : std::nullopt;
}

Refusal HitachiDrive::showTripAs(unsigned state)
{
  trip_state_ = state;
  return std::nullopt;
}

void HitachiDrive::setCoil(int number, bool value)
{
  const std::size_t index = static_cast<std::size_t>(number);
  const bool rising = value && !coils_[index];
  coils_[index] = value;
  if (number == COIL_RUN && !value)
  {
    hold_ = Hold::None;
  }
  const bool external_trip = number == 0x0003;
  const bool reset = number == 0x0004;
  if (rising && external_trip && !tripped_)
  {
    doTrip(E_EXTERNAL);
  }
  if (rising && reset)
  {
    resetTrip();
  }
  if (options_.self_clearing_coils && (external_trip || reset))
  {
    coils_[index] = false;
  }
}
}  // namespace simulation
}  // namespace inverter_bus

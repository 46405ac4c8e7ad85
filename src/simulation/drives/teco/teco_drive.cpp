// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/teco/teco_drive.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulation/drives/motor_watch.h"
#include "simulation/drives/panel_parameters.h"
#include "simulation/drives/teco/teco_parameters.h"
#include "simulation/modbus/modbus_frame.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
const char* const MODEL = "teco_7200ma";
constexpr std::uint16_t RUN_BIT = 0x0001;
constexpr std::uint16_t REVERSE_BIT = 0x0002;
constexpr std::uint16_t EXTERNAL_FAULT_BIT = 0x0004;
constexpr std::uint16_t RESET_BIT = 0x0008;
constexpr int DIRECTION_FORM = 3;     // DriveOptions::reverse_word
constexpr int TRIP_OVERCURRENT = 20;  // numbers of the 7300CV
constexpr int TRIP_EXTERNAL = 37;     // the same
constexpr std::uint32_t FROM_PANEL = 0;
constexpr std::uint32_t FROM_BUS = 2;  // Sn-04, Sn-05
constexpr double REPLY_DELAY = 0.005;  // [s] MODBUS manual p. 7
constexpr double POWER_ON_TIME = 5.0;  // [s] without a message until the alarm shows, p. 4
constexpr int LAST_STATION = 31;

const std::map<int, std::uint32_t>& bauds()
{
  static const std::map<int, std::uint32_t> BAUDS = { { 1200, 0 }, { 2400, 1 }, { 4800, 2 }, { 9600, 3 } };  // Sn-37
  return BAUDS;
}

ModbusLimits limits()
{
  ModbusLimits limits;  // MODBUS manual p. 6, 8
  limits.functions = { 0x03, 0x08, 0x10 };
  limits.broadcast_functions = { 0x10 };
  limits.read_registers = 16;
  limits.write_registers = 16;
  // The manual prints the answer 88 01 to a loop test, and not what causes it.
  limits.loop_back_refusal = ModbusException::FunctionNotSupported;
  return limits;
}
}  // namespace

TecoDrive::TecoDrive(const DriveOptions& options)
  : ModbusSlave(options.name, options.station, options.seed, options.start, limits())
  , options_(options)
  , memory_(tecoParameters())
  , motor_(MotorRating())
  , powered_since_(options.start)
  , busy_until_(options.start)
{
  code_ = { memory_.find("Bn-01"), memory_.find("Bn-02"), memory_.find("Bn-04"), memory_.find("Cn-02"),
            memory_.find("Cn-27"), memory_.find("Sn-04"), memory_.find("Sn-05"), memory_.find("Sn-36"),
            memory_.find("Sn-37"), memory_.find("Sn-38"), memory_.find("Sn-39") };
  commission();
  motor_.setRating({ options.rated_current, options.rated_voltage, panelValue(memory_, code_.cn02) });
  motor_.setLoad(options.load);
  setSerial(serialInEffect(), true);
  control();
}

void TecoDrive::commission()
{
  const auto baud = bauds().find(options_.line.baud_rate);
  if (baud == bauds().end())
  {
    throw std::invalid_argument(std::string(MODEL) + " has no baud rate " + std::to_string(options_.line.baud_rate) +
                                " (1200-9600)");
  }
  if (options_.station < 1 || options_.station > LAST_STATION)
  {
    throw std::invalid_argument(std::string(MODEL) + " has no station " + std::to_string(options_.station) + " (1-31)");
  }
  // The block must leave 0000H, 0001H and the parameters alone.
  if (options_.monitor_base < 0x0002 || options_.monitor_base + 0x10 > TECO_PARAMETERS)
  {
    throw std::invalid_argument(std::string(MODEL) + ": monitor_base " + std::to_string(options_.monitor_base) +
                                " (allowed: 2 to 752)");
  }
  commissionAtPanel(memory_, MODEL, "Sn-04", FROM_BUS);
  commissionAtPanel(memory_, MODEL, "Sn-05", FROM_BUS);
  commissionAtPanel(memory_, MODEL, "Sn-36", options_.station);
  commissionAtPanel(memory_, MODEL, "Sn-37", baud->second);
  commissionAtPanel(memory_, MODEL, "Sn-38", static_cast<int>(options_.line.parity));
  for (const auto& parameter : options_.parameters)
  {
    commissionAtPanel(memory_, MODEL, parameter.first, parameter.second);
  }
}

std::optional<LineSettings> TecoDrive::serialInEffect() const
{
  const auto baud = std::find_if(bauds().begin(), bauds().end(),
                                 [this](const auto& one) { return memory_.ram(code_.sn37) == one.second; });
  if (baud == bauds().end())
  {
    return std::nullopt;
  }
  LineSettings serial;
  serial.baud_rate = baud->first;
  serial.parity = static_cast<Parity>(memory_.ram(code_.sn38));
  // A character always has 11 bits: 8N2, 8E1 or 8O1 (p. 5).
  serial.stop_bits = serial.parity == Parity::None ? 2 : 1;
  return serial;
}

double TecoDrive::startUpTime() const
{
  return options_.start_up_time;
}

Duration TecoDrive::replyDelay() const
{
  return seconds(std::max(REPLY_DELAY, options_.turnaround));
}

bool TecoDrive::takesBroadcast(const Bytes& frame) const
{
  // Only 0000H and 0001H (p. 5, 6).
  return modbusWord(frame, 2) + modbusWord(frame, 4) <= 2;
}

void TecoDrive::heard(std::uint8_t /*function*/)
{
  watchdog_.feed(clock());
  alarm_ = Alarm::Off;
  if (hold_ != Hold::StopKey && options_.restart_after_timeout)
  {
    setHold(Hold::None);
  }
}

Duration TecoDrive::timeout() const
{
  return powered() ? seconds(panelValue(memory_, code_.cn27)) : Duration::zero();
}

std::optional<TimePoint> TecoDrive::powerOnDeadline() const
{
  const bool by_bus = memory_.ram(code_.sn04) == FROM_BUS || memory_.ram(code_.sn05) == FROM_BUS;
  const bool waiting = powered() && by_bus && !watchdog_.started() && alarm_ == Alarm::Off;
  return waiting ? std::optional<TimePoint>(powered_since_ + seconds(POWER_ON_TIME)) : std::nullopt;
}

void TecoDrive::raiseAlarm()
{
  constexpr std::uint32_t RUN_ON = 3;  // Sn-39
  alarm_ = memory_.ram(code_.sn39) == RUN_ON ? Alarm::Flashing : Alarm::Lit;
  ++alarms_;
}

void TecoDrive::onTimeout()
{
  raiseAlarm();
  switch (memory_.ram(code_.sn39))
  {
    case 0:
      setHold(Hold::TimeoutRamp);
      break;
    case 1:
      setHold(Hold::TimeoutCoast);
      break;
    case 2:
      setHold(Hold::TimeoutFastRamp);
      break;
    default:  // runs on
      break;
  }
}

TimePoint TecoDrive::nextChange(TimePoint limit) const
{
  TimePoint next = limit;
  for (const std::optional<TimePoint>& due : { watchdog_.deadline(timeout()), powerOnDeadline() })
  {
    next = due ? std::min(next, *due) : next;
  }
  return nextLook(motor_, clock(), next);
}

void TecoDrive::move(double seconds)
{
  motor_.advance(seconds);
}

void TecoDrive::change()
{
  const std::optional<TimePoint> lost = watchdog_.deadline(timeout());
  if (lost && *lost <= clock())
  {
    watchdog_.expire();
    onTimeout();
  }
  const std::optional<TimePoint> never_heard = powerOnDeadline();
  if (never_heard && *never_heard <= clock())
  {
    raiseAlarm();
  }
  if (motor_.current() > OVERCURRENT * options_.rated_current)
  {
    doTrip(TRIP_OVERCURRENT);
  }
}

bool TecoDrive::runBit(std::uint16_t command) const
{
  const bool first = (command & RUN_BIT) != 0;
  const bool second = (command & REVERSE_BIT) != 0;
  // With a run bit for each direction, both at once cancel each other.
  return options_.reverse_word == DIRECTION_FORM ? first : first != second;
}

bool TecoDrive::busRuns() const
{
  return runBit(command_) && memory_.ram(code_.sn04) == FROM_BUS && hold_ == Hold::None;
}

bool TecoDrive::busSetsFrequency() const
{
  return memory_.ram(code_.sn05) == FROM_BUS;
}

double TecoDrive::wantedFrequency() const
{
  if (panel_)
  {
    return *panel_;
  }
  const double hertz = busRuns() && busSetsFrequency() ? reference_ / 100.0 : 0.0;
  return (command_ & REVERSE_BIT) != 0 ? -hertz : hertz;
}

void TecoDrive::control()
{
  const double stop_time = panelValue(memory_, hold_ == Hold::TimeoutFastRamp ? code_.bn04 : code_.bn02);
  motor_.setRamps({ panelValue(memory_, code_.cn02), panelValue(memory_, code_.bn01), stop_time, 0.5 });
  if (!powered() || tripped_ || hold_ == Hold::TimeoutCoast)
  {
    motor_.cut();
    return;
  }
  motor_.rampTo(wantedFrequency());
}

void TecoDrive::setCommand(std::uint16_t command)
{
  const std::uint16_t rising = static_cast<std::uint16_t>(command & ~command_);
  command_ = command;
  if (!runBit(command))
  {
    hold_ = Hold::None;
  }
  if ((rising & EXTERNAL_FAULT_BIT) != 0 && !tripped_)
  {
    doTrip(TRIP_EXTERNAL);
  }
  if ((rising & RESET_BIT) != 0)
  {
    resetTrip();
  }
  control();
}

void TecoDrive::setHold(Hold hold)
{
  // Without a RUN there is nothing to hold back: the next one starts the motor.
  hold_ = runBit(command_) ? hold : Hold::None;
  control();
}

void TecoDrive::doTrip(int code)
{
  tripped_ = true;
  trip_ = code;
  ++trips_;
  control();
}

void TecoDrive::resetTrip()
{
  tripped_ = false;
  control();  // a RUN that is still on restarts the motor here
}

void TecoDrive::losePower()
{
  command_ = 0;
  reference_ = 0;
  setting_error_ = false;
  tripped_ = false;
  hold_ = Hold::None;
  alarm_ = Alarm::Off;
  busy_until_ = clock();
  watchdog_.reset();
  memory_.reload();
  if (panel_)
  {
    panel_ = 0.0;
  }
  motor_.cut();
}

void TecoDrive::gainPower()
{
  powered_since_ = clock();
  setStation(static_cast<int>(memory_.ram(code_.sn36)));
  setSerial(serialInEffect(), true);
  control();
}

Refusal TecoDrive::trip(int code, TimePoint now)
{
  advance(now);
  if (!powered())
  {
    return "the drive has no power";
  }
  doTrip(code);
  return std::nullopt;
}

Refusal TecoDrive::takeOverAtPanel(double hertz, TimePoint now)
{
  advance(now);
  if (std::abs(hertz) > panelValue(memory_, code_.cn02))
  {
    return "above the maximum frequency Cn-02 = " + twoDecimals(panelValue(memory_, code_.cn02)) + " Hz";
  }
  if (!panel_)
  {
    sources_before_panel_ = { memory_.ram(code_.sn04), memory_.ram(code_.sn05) };
  }
  memory_.commission(code_.sn04, FROM_PANEL);
  memory_.commission(code_.sn05, FROM_PANEL);
  panel_ = hertz;
  control();
  return std::nullopt;
}

Refusal TecoDrive::releasePanel(TimePoint now)
{
  advance(now);
  if (!panel_)
  {
    return "the panel has not taken over";
  }
  memory_.commission(code_.sn04, sources_before_panel_.first);
  memory_.commission(code_.sn05, sources_before_panel_.second);
  panel_.reset();
  control();
  return std::nullopt;
}

Refusal TecoDrive::pressStopKey(TimePoint now)
{
  advance(now);
  if (panel_)
  {
    panel_ = 0.0;
    control();
    return std::nullopt;
  }
  setHold(Hold::StopKey);
  return std::nullopt;
}

Refusal TecoDrive::setSafeStop(bool /*active*/, TimePoint /*now*/)
{
  return std::string(MODEL) + " has no safe torque off";
}

void TecoDrive::takeLoad(double load)
{
  motor_.setLoad(load);
  change();
}

void TecoDrive::takeBusy(TimePoint until)
{
  busy_until_ = until;
}

Refusal TecoDrive::setParameter(const std::string& code, double value, TimePoint now)
{
  advance(now);
  Refusal refusal = setAtPanel(memory_, MODEL, code, value);
  control();
  return refusal;
}

Refusal TecoDrive::parameter(const std::string& code, KeyValues& values) const
{
  return showAtPanel(memory_, MODEL, code, values);
}

const Motor& TecoDrive::motor() const
{
  return motor_;
}

bool TecoDrive::runCommand() const
{
  return runBit(command_);
}

void TecoDrive::describeMotor(KeyValues& values) const
{
  const auto add = [&values](const char* key, const std::string& value) { values.emplace_back(key, value); };
  const auto flag = [&add](const char* key, bool value) { add(key, value ? "1" : "0"); };
  add("model", MODEL);
  appendMotor(motor_, values);
  add("command", std::to_string(command_));
  flag("run_command", runCommand());
  flag("run_effective", busRuns() && !tripped_);
  add("reference", twoDecimals(reference_ / 100.0));
  flag("tripped", tripped_);
  add("trip", std::to_string(tripped_ ? trip_ : 0));
  add("last_trip", std::to_string(trip_));
  add("trips", std::to_string(trips_));
  add("alarm", alarm_ == Alarm::Off ? "off" : (alarm_ == Alarm::Lit ? "lit" : "flashing"));
  add("alarms", std::to_string(alarms_));
  add("command_source", std::to_string(memory_.ram(code_.sn04)));
  flag("panel", panel_.has_value());
  flag("held", hold_ != Hold::None);
  flag("busy", clock() < busy_until_);
  const bool off = timeout() == Duration::zero();
  add("watchdog", off ? "off" : (watchdog_.expired() ? "expired" : (watchdog_.started() ? "running" : "waiting")));
  add("eeprom_writes", std::to_string(memory_.eepromWrites()));
}
}  // namespace simulation
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/teco/teco_drive.h"

#include <algorithm>
#include <stdexcept>

#include "simulation/drives/motor_watch.h"
#include "simulation/drives/teco/teco_parameters.h"
#include "simulation/modbus/modbus_frame.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
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
  : BrandDrive(options, "teco_7200ma", limits(), tecoParameters()), powered_since_(options.start)
{
  code_ = { memory_.find("Bn-01"), memory_.find("Bn-02"), memory_.find("Bn-04"), memory_.find("Cn-02"),
            memory_.find("Cn-27"), memory_.find("Sn-04"), memory_.find("Sn-05"), memory_.find("Sn-36"),
            memory_.find("Sn-37"), memory_.find("Sn-38"), memory_.find("Sn-39") };
  panel_.setSources({ { code_.sn04, code_.sn05 }, FROM_PANEL, code_.cn02 });
  commissionLine();
  motor_.setRating({ options.rated_current, options.rated_voltage, panelValue(code_.cn02) });
  setSerial(serialInEffect(), true);
  control();
}

void TecoDrive::commissionLine()
{
  const std::uint32_t baud = baudCode(bauds());
  requireStation(1, LAST_STATION);
  // The block must leave 0000H, 0001H and the parameters alone.
  if (options_.monitor_base < 0x0002 || options_.monitor_base + 0x10 > TECO_PARAMETERS)
  {
    throw std::invalid_argument(model_name_ + ": monitor_base " + std::to_string(options_.monitor_base) +
                                " (allowed: 2 to 752)");
  }
  commission("Sn-04", FROM_BUS);
  commission("Sn-05", FROM_BUS);
  commission("Sn-36", options_.station);
  commission("Sn-37", baud);
  commission("Sn-38", static_cast<int>(options_.line.parity));
  commissionOptions();
}

std::optional<LineSettings> TecoDrive::serialInEffect() const
{
  const std::optional<int> baud = baudOf(bauds(), memory_.ram(code_.sn37));
  if (!baud)
  {
    return std::nullopt;
  }
  LineSettings serial;
  serial.baud_rate = *baud;
  serial.parity = static_cast<Parity>(memory_.ram(code_.sn38));
  // A character always has 11 bits: 8N2, 8E1 or 8O1 (p. 5).
  serial.stop_bits = serial.parity == Parity::None ? 2 : 1;
  return serial;
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

Duration TecoDrive::watchdogTimeout() const
{
  return powered() ? seconds(panelValue(code_.cn27)) : Duration::zero();
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
  const std::optional<TimePoint> due = powerOnDeadline();
  return BrandDrive::nextChange(due ? std::min(limit, *due) : limit);
}

void TecoDrive::changeMore()
{
  const std::optional<TimePoint> never_heard = powerOnDeadline();
  if (never_heard && *never_heard <= clock())
  {
    raiseAlarm();
  }
}

int TecoDrive::overcurrentTrip() const
{
  return TRIP_OVERCURRENT;
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
  if (panel_.inCommand())
  {
    return panel_.hertz();
  }
  const double hertz = busRuns() && busSetsFrequency() ? reference_ / 100.0 : 0.0;
  return (command_ & REVERSE_BIT) != 0 ? -hertz : hertz;
}

void TecoDrive::control()
{
  const double stop_time = panelValue(hold_ == Hold::TimeoutFastRamp ? code_.bn04 : code_.bn02);
  motor_.setRamps({ panelValue(code_.cn02), panelValue(code_.bn01), stop_time, 0.5 });
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
  recordTrip(code);
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
  hold_ = Hold::None;
  alarm_ = Alarm::Off;
  BrandDrive::losePower();
}

void TecoDrive::gainPower()
{
  powered_since_ = clock();
  setStation(static_cast<int>(memory_.ram(code_.sn36)));
  setSerial(serialInEffect(), true);
  control();
}

Refusal TecoDrive::stopByKey()
{
  setHold(Hold::StopKey);
  return std::nullopt;
}

bool TecoDrive::runCommand() const
{
  return runBit(command_);
}

void TecoDrive::describeBrand(ShowList& list) const
{
  list.number("command", command_);
  list.flag("run_command", runCommand());
  list.flag("run_effective", busRuns() && !tripped_);
  list.text("reference", twoDecimals(reference_ / 100.0));
  list.text("alarm", alarm_ == Alarm::Off ? "off" : (alarm_ == Alarm::Lit ? "lit" : "flashing"));
  list.number("alarms", alarms_);
  list.number("command_source", memory_.ram(code_.sn04));
  list.flag("panel", panel_.inCommand());
  list.flag("held", hold_ != Hold::None);
}
}  // namespace simulation
}  // namespace inverter_bus

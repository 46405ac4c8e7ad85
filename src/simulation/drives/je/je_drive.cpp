// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/je/je_drive.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "simulation/drives/je/je_parameters.h"
#include "simulation/drives/motor_watch.h"
#include "simulation/drives/panel_parameters.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
const char* const MODEL = "omron_3g3je";
constexpr int TRIP_OVERCURRENT = 1;
constexpr int LAST_STATION = 99;
constexpr std::uint32_t RESTART_SHORT = 1;   // P09
constexpr std::uint32_t RESTART_ALWAYS = 2;  // P09
constexpr double SHORT_POWER_CUT = 0.5;      // [s] P09 = 1

CompowayLimits limits(const LineSettings& line)
{
  CompowayLimits limits;
  limits.eight_bits = line.data_bits == 8;
  limits.model = "3G3JE202BF";  // manual I548 section 3, attributes
  return limits;
}
}  // namespace

JeDrive::JeDrive(const DriveOptions& options)
  : CompowaySlave(options.name, options.station, options.seed, options.start, limits(options.line))
  , options_(options)
  , memory_(jeParameters())
  , motor_(MotorRating())
  , power_cut_(options.start)
  , busy_until_(options.start)
{
  const auto known = [this](const char* code) { return memory_.find(code); };
  code_ = { known("P01"), known("P06"),       known("P07"),          known("P08"),         known("P09"),
            known("P10"), known("P15"),       known("P16"),          known("P17"),         known("P18"),
            known("P19"), known("reference"), known("acceleration"), known("deceleration") };
  commission();
  buildOperations();
  // The motor's name plate is what was set as P01.
  motor_.setRating(
      { std::max(0.1, panelValue(memory_, code_.p01)), options.rated_voltage, panelValue(memory_, code_.p06) });
  motor_.setLoad(options.load);
  setSerial(serialInEffect(), true);
  control();
}

void JeDrive::commission()
{
  const int baud = options_.line.baud_rate;
  if (std::set<int>{ 2400, 4800, 9600, 19200 }.count(baud) == 0)
  {
    throw std::invalid_argument(std::string(MODEL) + " has no baud rate " + std::to_string(baud) + " (2400-19200)");
  }
  if (options_.station < 0 || options_.station > LAST_STATION)
  {
    throw std::invalid_argument(std::string(MODEL) + " has no station " + std::to_string(options_.station) + " (0-99)");
  }
  commissionAtPanel(memory_, MODEL, "P15", options_.station);
  commissionAtPanel(memory_, MODEL, "P16", baud / 1000.0);
  commissionAtPanel(memory_, MODEL, "P17", options_.line.data_bits);
  commissionAtPanel(memory_, MODEL, "P18", options_.line.stop_bits);
  commissionAtPanel(memory_, MODEL, "P19", static_cast<int>(options_.line.parity));
  for (const auto& parameter : options_.parameters)
  {
    commissionAtPanel(memory_, MODEL, parameter.first, parameter.second);
  }
}

LineSettings JeDrive::serialInEffect() const
{
  LineSettings serial;
  serial.protocol = Protocol::CompowayF;
  serial.baud_rate = static_cast<int>(memory_.ram(code_.p16) * 100);
  serial.data_bits = static_cast<int>(memory_.ram(code_.p17));
  serial.stop_bits = static_cast<int>(memory_.ram(code_.p18));
  serial.parity = static_cast<Parity>(memory_.ram(code_.p19));
  return serial;
}

double JeDrive::startUpTime() const
{
  return options_.start_up_time;
}

Duration JeDrive::replyDelay() const
{
  return seconds(options_.turnaround);
}

TimePoint JeDrive::nextChange(TimePoint limit) const
{
  return nextLook(motor_, clock(), limit);
}

void JeDrive::move(double seconds)
{
  motor_.advance(seconds);
}

void JeDrive::change()
{
  if (motor_.current() > OVERCURRENT * panelValue(memory_, code_.p01))
  {
    tripped_ = true;
    trip_ = TRIP_OVERCURRENT;
    ++trips_;
    control();
  }
}

bool JeDrive::busCommands() const
{
  return memory_.ram(code_.p10) == 0;
}

bool JeDrive::busRuns() const
{
  return run_ != Run::Off && busCommands() && !stop_key_;
}

double JeDrive::wantedFrequency() const
{
  if (panel_)
  {
    return *panel_;
  }
  const double upper = std::min(panelValue(memory_, code_.p06), panelValue(memory_, code_.p07));
  const double reference = std::max(panelValue(memory_, code_.reference), panelValue(memory_, code_.p08));
  const double hertz = busRuns() ? std::min(upper, reference) : 0.0;
  return run_ == Run::Reverse ? -hertz : hertz;
}

void JeDrive::control()
{
  motor_.setRamps({ panelValue(memory_, code_.p06), panelValue(memory_, code_.acceleration),
                    panelValue(memory_, code_.deceleration), 0.5 });
  if (!powered() || tripped_)
  {
    motor_.cut();
    return;
  }
  motor_.rampTo(wantedFrequency());
}

void JeDrive::setRun(Run run)
{
  run_ = run;
  stop_key_ = stop_key_ && run != Run::Off;
  control();
}

void JeDrive::losePower()
{
  run_before_power_cut_ = run_;
  power_cut_ = clock();
  run_ = Run::Off;
  stop_key_ = false;
  tripped_ = false;
  ram_mode_ = false;
  area_ = 0;
  busy_until_ = clock();
  memory_.reload();
  if (panel_)
  {
    panel_ = 0.0;
  }
  motor_.cut();
}

void JeDrive::gainPower()
{
  const bool short_cut = toSeconds(clock() - power_cut_) <= SHORT_POWER_CUT;
  const std::uint32_t restart = memory_.ram(code_.p09);
  if (restart == RESTART_ALWAYS || (restart == RESTART_SHORT && short_cut))
  {
    run_ = run_before_power_cut_;
  }
  setStation(static_cast<int>(memory_.ram(code_.p15)));
  setSerial(serialInEffect(), true);
  control();
}

Refusal JeDrive::trip(int code, TimePoint now)
{
  advance(now);
  if (!powered())
  {
    return "the drive has no power";
  }
  tripped_ = true;
  trip_ = code;
  ++trips_;
  control();
  return std::nullopt;
}

Refusal JeDrive::takeOverAtPanel(double hertz, TimePoint now)
{
  advance(now);
  if (std::abs(hertz) > panelValue(memory_, code_.p06))
  {
    return "above the maximum frequency P06 = " + twoDecimals(panelValue(memory_, code_.p06)) + " Hz";
  }
  if (!panel_)
  {
    source_before_panel_ = memory_.ram(code_.p10);
  }
  memory_.commission(code_.p10, 1);
  panel_ = hertz;
  control();
  return std::nullopt;
}

Refusal JeDrive::releasePanel(TimePoint now)
{
  advance(now);
  if (!panel_)
  {
    return "the panel has not taken over";
  }
  memory_.commission(code_.p10, source_before_panel_);
  panel_.reset();
  control();
  return std::nullopt;
}

Refusal JeDrive::pressStopKey(TimePoint now)
{
  advance(now);
  if (panel_)
  {
    panel_ = 0.0;
  }
  else
  {
    // Without a RUN there is nothing to hold back: the next one starts the motor.
    stop_key_ = run_ != Run::Off;
  }
  control();
  return std::nullopt;
}

Refusal JeDrive::setSafeStop(bool /*active*/, TimePoint /*now*/)
{
  return std::string(MODEL) + " has no safe torque off";
}

void JeDrive::takeLoad(double load)
{
  motor_.setLoad(load);
  change();
}

void JeDrive::takeBusy(TimePoint until)
{
  busy_until_ = until;
}

Refusal JeDrive::setParameter(const std::string& code, double value, TimePoint now)
{
  advance(now);
  Refusal refusal = setAtPanel(memory_, MODEL, code, value);
  control();
  return refusal;
}

Refusal JeDrive::parameter(const std::string& code, KeyValues& values) const
{
  return showAtPanel(memory_, MODEL, code, values);
}

const Motor& JeDrive::motor() const
{
  return motor_;
}

bool JeDrive::runCommand() const
{
  return run_ != Run::Off;
}

void JeDrive::describeMotor(KeyValues& values) const
{
  const auto add = [&values](const char* key, const std::string& value) { values.emplace_back(key, value); };
  const auto flag = [&add](const char* key, bool value) { add(key, value ? "1" : "0"); };
  add("model", MODEL);
  appendMotor(motor_, values);
  flag("run_command", runCommand());
  flag("run_effective", busRuns() && !tripped_);
  add("reference", twoDecimals(panelValue(memory_, code_.reference)));
  flag("tripped", tripped_);
  add("trip", std::to_string(tripped_ ? trip_ : 0));
  add("last_trip", std::to_string(trip_));
  add("trips", std::to_string(trips_));
  add("write_mode", ram_mode_ ? "ram" : "backup");
  add("setup_area", std::to_string(area_));
  add("command_source", std::to_string(memory_.ram(code_.p10)));
  flag("panel", panel_.has_value());
  flag("held", stop_key_);
  flag("busy", clock() < busy_until_);
  add("watchdog", "off");
  add("eeprom_writes", std::to_string(memory_.eepromWrites()));
  add("ram_changes", std::to_string(memory_.ramChanges()));
}
}  // namespace simulation
}  // namespace inverter_bus

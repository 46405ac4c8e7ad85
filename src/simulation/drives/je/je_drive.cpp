// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/je/je_drive.h"

#include <algorithm>

#include "simulation/drives/je/je_parameters.h"
#include "simulation/drives/motor_watch.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr int TRIP_OVERCURRENT = 1;
constexpr int LAST_STATION = 99;
constexpr std::uint32_t RUN_BY_TERMINALS = 1;  // P10
constexpr std::uint32_t RESTART_SHORT = 1;     // P09
constexpr std::uint32_t RESTART_ALWAYS = 2;    // P09
constexpr double SHORT_POWER_CUT = 0.5;        // [s] P09 = 1

CompowayLimits limits(const LineSettings& line)
{
  CompowayLimits limits;
  limits.eight_bits = line.data_bits == 8;
  limits.model = "3G3JE202BF";  // manual I548 section 3, attributes
  return limits;
}
}  // namespace

JeDrive::JeDrive(const DriveOptions& options)
  : BrandDrive(options, "omron_3g3je", limits(options.line), jeParameters()), power_cut_(options.start)
{
  const auto known = [this](const char* code) { return memory_.find(code); };
  code_ = { known("P01"), known("P06"),       known("P07"),          known("P08"),         known("P09"),
            known("P10"), known("P15"),       known("P16"),          known("P17"),         known("P18"),
            known("P19"), known("reference"), known("acceleration"), known("deceleration") };
  panel_.setSources({ { code_.p10 }, RUN_BY_TERMINALS, code_.p06 });
  commissionLine();
  buildOperations();
  // The motor's name plate is what was set as P01.
  motor_.setRating({ std::max(0.1, panelValue(code_.p01)), options.rated_voltage, panelValue(code_.p06) });
  setSerial(serialInEffect(), true);
  control();
}

void JeDrive::commissionLine()
{
  const std::uint32_t baud = baudCode({ { 2400, 24 }, { 4800, 48 }, { 9600, 96 }, { 19200, 192 } });
  requireStation(0, LAST_STATION);
  commission("P15", options_.station);
  commission("P16", baud / 10.0);
  commission("P17", options_.line.data_bits);
  commission("P18", options_.line.stop_bits);
  commission("P19", static_cast<int>(options_.line.parity));
  commissionOptions();
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

Duration JeDrive::replyDelay() const
{
  return seconds(options_.turnaround);
}

int JeDrive::overcurrentTrip() const
{
  return TRIP_OVERCURRENT;
}

double JeDrive::ratedCurrent() const
{
  return panelValue(code_.p01);
}

void JeDrive::doTrip(int code)
{
  recordTrip(code);
  control();
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
  if (panel_.inCommand())
  {
    return panel_.hertz();
  }
  const double upper = std::min(panelValue(code_.p06), panelValue(code_.p07));
  const double reference = std::max(panelValue(code_.reference), panelValue(code_.p08));
  const double hertz = busRuns() ? std::min(upper, reference) : 0.0;
  return run_ == Run::Reverse ? -hertz : hertz;
}

void JeDrive::control()
{
  motor_.setRamps({ panelValue(code_.p06), panelValue(code_.acceleration), panelValue(code_.deceleration), 0.5 });
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
  ram_mode_ = false;
  area_ = 0;
  BrandDrive::losePower();
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

Refusal JeDrive::stopByKey()
{
  // Without a RUN there is nothing to hold back: the next one starts the motor.
  stop_key_ = run_ != Run::Off;
  control();
  return std::nullopt;
}

bool JeDrive::runCommand() const
{
  return run_ != Run::Off;
}

void JeDrive::describeBrand(ShowList& list) const
{
  list.flag("run_command", runCommand());
  list.flag("run_effective", busRuns() && !tripped_);
  list.text("reference", twoDecimals(panelValue(code_.reference)));
  list.text("write_mode", ram_mode_ ? "ram" : "backup");
  list.number("setup_area", area_);
  list.number("command_source", memory_.ram(code_.p10));
  list.flag("panel", panel_.inCommand());
  list.flag("held", stop_key_);
  list.number("ram_changes", memory_.ramChanges());
}
}  // namespace simulation
}  // namespace inverter_bus

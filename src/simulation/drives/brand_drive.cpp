// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/drives/brand_drive.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "simulation/drives/motor_watch.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
double stepsPerUnit(const Parameter& parameter)
{
  return std::pow(10.0, parameter.decimals);
}

/// What the register holds when the panel shows \p value; nothing where the parameter doesn't take it.
std::optional<std::uint32_t> rawOf(const ParameterMemory& memory, ParameterMemory::Index index, const Parameter& shown,
                                   double value)
{
  const double raw = std::round(value * stepsPerUnit(shown));
  const bool fits = raw >= 0.0 && raw <= 4294967295.0 && memory.accepts(index, static_cast<std::uint32_t>(raw));
  return fits ? std::optional<std::uint32_t>(static_cast<std::uint32_t>(raw)) : std::nullopt;
}

std::string rangeText(const Parameter& shown)
{
  return "(" + panelText(shown, shown.minimum) + "-" + panelText(shown, shown.maximum) + ")";
}
}  // namespace

template <class Slave>
BrandDrive<Slave>::BrandDrive(const DriveOptions& options, std::string model, const typename Slave::Limits& limits,
                              std::vector<Parameter> table)
  : Slave(options.name, options.station, options.seed, options.start, limits)
  , model_name_(std::move(model))
  , options_(options)
  , memory_(std::move(table))
  , motor_(MotorRating())
  , busy_until_(options.start)
{
  motor_.setLoad(options.load);
}

template <class Slave>
void BrandDrive<Slave>::commission(const std::string& code, double value)
{
  const Index index = memory_.find(code);
  if (index == ParameterMemory::NONE)
  {
    throw std::invalid_argument(model_name_ + " has no parameter " + code);
  }
  const Parameter shown = asShown(index);
  const std::optional<std::uint32_t> raw = rawOf(memory_, index, shown, value);
  if (!raw)
  {
    throw std::invalid_argument("value out of range for " + code + " " + rangeText(shown));
  }
  takeCommissioned(index, *raw);
}

template <class Slave>
void BrandDrive<Slave>::commissionOptions()
{
  for (const auto& parameter : options_.parameters)
  {
    commission(parameter.first, parameter.second);
  }
}

template <class Slave>
void BrandDrive<Slave>::requireStation(int first, int last) const
{
  if (options_.station < first || options_.station > last)
  {
    throw std::invalid_argument(model_name_ + " has no station " + std::to_string(options_.station) + " (" +
                                std::to_string(first) + "-" + std::to_string(last) + ")");
  }
}

template <class Slave>
std::uint32_t BrandDrive<Slave>::baudCode(const std::map<int, std::uint32_t>& bauds) const
{
  const auto found = bauds.find(options_.line.baud_rate);
  if (found == bauds.end())
  {
    throw std::invalid_argument(model_name_ + " has no baud rate " + std::to_string(options_.line.baud_rate) + " (" +
                                std::to_string(bauds.begin()->first) + "-" + std::to_string(bauds.rbegin()->first) +
                                ")");
  }
  return found->second;
}

template <class Slave>
std::optional<int> BrandDrive<Slave>::baudOf(const std::map<int, std::uint32_t>& bauds, std::uint32_t code)
{
  const auto found = std::find_if(bauds.begin(), bauds.end(), [code](const auto& one) { return one.second == code; });
  return found == bauds.end() ? std::nullopt : std::optional<int>(found->first);
}

template <class Slave>
double BrandDrive<Slave>::panelValue(Index index) const
{
  return memory_.ram(index) / stepsPerUnit(memory_.info(index));
}

template <class Slave>
Parameter BrandDrive<Slave>::asShown(Index index) const
{
  return memory_.info(index);
}

template <class Slave>
void BrandDrive<Slave>::takeCommissioned(Index index, std::uint32_t raw)
{
  memory_.commission(index, raw);
}

template <class Slave>
void BrandDrive<Slave>::takeFromPanel(Index index, std::uint32_t raw)
{
  memory_.writeBoth(index, raw);
}

template <class Slave>
Refusal BrandDrive<Slave>::setParameter(const std::string& code, double value, TimePoint now)
{
  this->advance(now);
  const Index index = memory_.find(code);
  if (index == ParameterMemory::NONE)
  {
    return model_name_ + " has no parameter " + code;
  }
  const Parameter shown = asShown(index);
  const std::optional<std::uint32_t> raw = rawOf(memory_, index, shown, value);
  if (!raw)
  {
    return "value out of range " + rangeText(shown);
  }
  takeFromPanel(index, *raw);
  control();
  return std::nullopt;
}

template <class Slave>
Refusal BrandDrive<Slave>::parameter(const std::string& code, KeyValues& values) const
{
  const Index index = memory_.find(code);
  if (index == ParameterMemory::NONE)
  {
    return model_name_ + " has no parameter " + code;
  }
  const Parameter shown = asShown(index);
  values.emplace_back("ram", panelText(shown, memory_.ram(index)));
  values.emplace_back("eeprom", panelText(shown, memory_.eeprom(index)));
  return std::nullopt;
}

template <class Slave>
const Motor& BrandDrive<Slave>::motor() const
{
  return motor_;
}

template <class Slave>
double BrandDrive<Slave>::ratedCurrent() const
{
  return options_.rated_current;
}

template <class Slave>
double BrandDrive<Slave>::outputCurrent() const
{
  return motor_.current();
}

template <class Slave>
double BrandDrive<Slave>::startUpTime() const
{
  return options_.start_up_time;
}

template <class Slave>
bool BrandDrive<Slave>::busy() const
{
  return this->clock() < busy_until_;
}

template <class Slave>
void BrandDrive<Slave>::takeLoad(double load)
{
  motor_.setLoad(load);
  change();
}

template <class Slave>
void BrandDrive<Slave>::takeBusy(TimePoint until)
{
  busy_until_ = until;
}

template <class Slave>
Duration BrandDrive<Slave>::watchdogTimeout() const
{
  return Duration::zero();
}

template <class Slave>
void BrandDrive<Slave>::onTimeout()
{
}

template <class Slave>
void BrandDrive<Slave>::changeMore()
{
}

template <class Slave>
TimePoint BrandDrive<Slave>::nextChange(TimePoint limit) const
{
  const std::optional<TimePoint> deadline = watchdog_.deadline(watchdogTimeout());
  return nextLook(motor_, this->clock(), deadline ? std::min(limit, *deadline) : limit);
}

template <class Slave>
void BrandDrive<Slave>::move(double seconds)
{
  motor_.advance(seconds);
}

template <class Slave>
void BrandDrive<Slave>::change()
{
  if (watchdog_.expireAt(this->clock(), watchdogTimeout()))
  {
    onTimeout();
  }
  changeMore();
  if (motor_.current() > OVERCURRENT * ratedCurrent())
  {
    doTrip(overcurrentTrip());
  }
}

template <class Slave>
void BrandDrive<Slave>::losePower()
{
  tripped_ = false;
  busy_until_ = this->clock();
  watchdog_.reset();
  memory_.reload();
  panel_.stop();
  motor_.cut();
}

template <class Slave>
void BrandDrive<Slave>::recordTrip(int code)
{
  tripped_ = true;
  last_trip_ = code;
  ++trip_count_;
}

template <class Slave>
Refusal BrandDrive<Slave>::noSuchTrip(int /*code*/) const
{
  return std::nullopt;
}

template <class Slave>
Refusal BrandDrive<Slave>::trip(int code, TimePoint now)
{
  this->advance(now);
  if (!this->powered())
  {
    return "the drive has no power";
  }
  Refusal refusal = noSuchTrip(code);
  if (!refusal)
  {
    doTrip(code);
  }
  return refusal;
}

template <class Slave>
Refusal BrandDrive<Slave>::takeOverAtPanel(double hertz, TimePoint now)
{
  this->advance(now);
  const Index highest = panel_.sources().highest;
  if (std::abs(hertz) > panelValue(highest))
  {
    return "above the maximum frequency " + memory_.info(highest).code + " = " + twoDecimals(panelValue(highest)) +
           " Hz";
  }
  panel_.takeOver(memory_, hertz);
  control();
  return std::nullopt;
}

template <class Slave>
Refusal BrandDrive<Slave>::releasePanel(TimePoint now)
{
  this->advance(now);
  if (!panel_.release(memory_))
  {
    return "the panel has not taken over";
  }
  control();
  return std::nullopt;
}

template <class Slave>
Refusal BrandDrive<Slave>::pressStopKey(TimePoint now)
{
  this->advance(now);
  if (!panel_.inCommand())
  {
    return stopByKey();
  }
  panel_.stop();
  control();
  return std::nullopt;
}

template <class Slave>
Refusal BrandDrive<Slave>::stopByKey()
{
  return model_name_ + " has no STOP key";
}

template <class Slave>
Refusal BrandDrive<Slave>::setSafeStop(bool /*active*/, TimePoint /*now*/)
{
  return model_name_ + " has no safe torque off";
}

template <class Slave>
void BrandDrive<Slave>::describeMotor(KeyValues& values) const
{
  ShowList list(values);
  list.text("model", model_name_);
  appendMotor(motor_, outputCurrent(), values);
  list.flag("tripped", tripped_);
  list.number("trip", tripped_ ? last_trip_ : 0);
  list.number("last_trip", last_trip_);
  list.number("trips", trip_count_);
  list.flag("busy", busy());
  list.text("watchdog", watchdog_.text(watchdogTimeout()));
  list.number("eeprom_writes", memory_.eepromWrites());
  describeBrand(list);
}

template class BrandDrive<ModbusSlave>;
template class BrandDrive<CompowaySlave>;
}  // namespace simulation
}  // namespace inverter_bus

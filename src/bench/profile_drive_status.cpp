// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What a drive that is played by its profile shows, and what can be done to it by hand.

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/profile_drive.h"
#include "bench/profile_memory.h"
#include "simulation/drives/motor_watch.h"

namespace inverter_bus
{
namespace bench
{
using drive::Item;
using simulation::Refusal;
using simulation::TimePoint;

namespace
{
std::uint32_t countsOf(double value, const Item& item)
{
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround(value / item.resolution)));
}

/// The raw value that means \p wanted; where several do, the smallest.
std::optional<std::uint32_t> rawOf(int wanted, const Item& item)
{
  if (item.values.empty())
  {
    return static_cast<std::uint32_t>(wanted);
  }
  const auto found = std::find_if(item.values.begin(), item.values.end(),
                                  [wanted](const auto& value) { return value.second == wanted; });
  return found == item.values.end() ? std::nullopt : std::optional<std::uint32_t>(found->first);
}
}  // namespace

void ProfileDrive::showStatus()
{
  // Flags in single bits last: a word of several bits may hold them too.
  for (const bool bits : { false, true })
  {
    for (const auto& field : profile_->status)
    {
      if (field.second.bit.has_value() == bits)
      {
        showField(field.first, field.second);
      }
    }
  }
}

void ProfileDrive::showField(const std::string& field, const Item& item)
{
  const auto& points = profile_->points;
  const bool commanded = std::any_of(points.begin(), points.end(), [&item](const auto& point) {
    return ProfileMemory::covers(point.second.item, item.space, item.address);
  });
  if (commanded)
  {
    return;  // it reports what was written
  }
  if (const auto value = quantity(field, item))
  {
    memory_->put(item, countsOf(*value, item));
  }
  else if (const auto known = state(field))
  {
    if (const auto raw = rawOf(*known, item))
    {
      memory_->put(item, *raw);
    }
  }
}

std::optional<double> ProfileDrive::quantity(const std::string& field, const Item& item) const
{
  const std::map<std::string, double> values = { { "output_frequency", std::abs(motor_.frequency()) },
                                                 { "output_current", motor_.current() },
                                                 { "output_voltage", motor_.voltage() },
                                                 { "dc_voltage", motor_.dcVoltage() },
                                                 { "torque", motor_.torque() },
                                                 { "temperature", motor_.temperature() } };
  const auto found = values.find(field);
  if (found == values.end())
  {
    return std::nullopt;
  }
  switch (item.base)
  {
    case drive::Base::RatedCurrent:
      return found->second / options_.rated_current * 100.0;
    case drive::Base::RatedVoltage:
      return found->second / options_.rated_voltage * 100.0;
    default:
      return found->second;
  }
}

std::optional<int> ProfileDrive::state(const std::string& field) const
{
  const double frequency = motor_.frequency();
  const bool there = runCommand() && motor_.turning() && !motor_.accelerating() && !motor_.decelerating();
  const std::map<std::string, int> states = {
    { "run_seen", runCommand() ? 1 : 0 },    { "operation", runCommand() ? 1 : 0 },
    { "running", motor_.turning() ? 1 : 0 }, { "direction", frequency > 0.0 ? 1 : (frequency < 0.0 ? -1 : 0) },
    { "ready", tripped_ ? 0 : 1 },           { "at_speed", there ? 1 : 0 },
    { "at_set_frequency", there ? 1 : 0 },   { "faulted", tripped_ ? 1 : 0 },
    { "fault_code", tripped_ ? trip_ : 0 }
  };
  const auto found = states.find(field);
  return found == states.end() ? std::nullopt : std::optional<int>(found->second);
}

const simulation::Motor& ProfileDrive::motor() const
{
  return motor_;
}

void ProfileDrive::doTrip(int code)
{
  tripped_ = true;
  trip_ = code;
  trips_.insert(trips_.begin(), code);
  const auto& entries = profile_->history.entries;
  for (std::size_t i = 0; i < entries.size() && i < trips_.size(); ++i)
  {
    const auto item = entries[i].find("code");
    if (item != entries[i].end())
    {
      memory_->setWhole(item->second, static_cast<std::uint32_t>(trips_[i]));
    }
  }
  control();
}

Refusal ProfileDrive::trip(int code, TimePoint now)
{
  advance(now);
  if (!powered())
  {
    return "the drive has no power";
  }
  doTrip(code);
  return std::nullopt;
}

Refusal ProfileDrive::takeOverAtPanel(double hertz, TimePoint now)
{
  advance(now);
  if (std::abs(hertz) > profile_->maximum_frequency)
  {
    return "above the maximum frequency " + simulation::twoDecimals(profile_->maximum_frequency) + " Hz";
  }
  panel_ = hertz;
  control();
  return std::nullopt;
}

Refusal ProfileDrive::releasePanel(TimePoint now)
{
  advance(now);
  panel_.reset();
  control();
  return std::nullopt;
}

Refusal ProfileDrive::pressStopKey(TimePoint now)
{
  advance(now);
  held_ = runCommand();
  control();
  return std::nullopt;
}

Refusal ProfileDrive::setSafeStop(bool /*active*/, TimePoint /*now*/)
{
  return "a profile says nothing about safe torque off";
}

void ProfileDrive::takeLoad(double load)
{
  motor_.setLoad(load);
}

void ProfileDrive::takeBusy(TimePoint until)
{
  goDeaf(until);
}

Refusal ProfileDrive::setParameter(const std::string& code, double value, TimePoint now)
{
  advance(now);
  const drive::Parameter* parameter = find(code);
  if (parameter == nullptr)
  {
    return profile_->name + " has no parameter " + code;
  }
  if (parameter->range && (value < parameter->range->first || value > parameter->range->second))
  {
    return "value out of range for " + code + " (" + simulation::twoDecimals(parameter->range->first) + "-" +
           simulation::twoDecimals(parameter->range->second) + ")";
  }
  memory_->setWhole(parameter->item, countsOf(value, parameter->item));
  return std::nullopt;
}

Refusal ProfileDrive::parameter(const std::string& code, simulation::KeyValues& values) const
{
  const drive::Parameter* parameter = find(code);
  if (parameter == nullptr)
  {
    return profile_->name + " has no parameter " + code;
  }
  values.emplace_back("ram", simulation::twoDecimals(memory_->whole(parameter->item) * parameter->item.resolution));
  return std::nullopt;
}

void ProfileDrive::describeMotor(simulation::KeyValues& values) const
{
  values.emplace_back("model", "profile");
  values.emplace_back("profile", profile_->name);
  appendMotor(motor_, motor_.current(), values);
  values.emplace_back("run_command", runCommand() ? "1" : "0");
  values.emplace_back("tripped", tripped_ ? "1" : "0");
  values.emplace_back("trip", std::to_string(tripped_ ? trip_ : 0));
  values.emplace_back("trips", std::to_string(trips_.size()));
  values.emplace_back("held", held_ ? "1" : "0");
}
}  // namespace bench
}  // namespace inverter_bus

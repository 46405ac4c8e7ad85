// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bench/profile_drive.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "bench/profile_memory.h"
#include "simulation/drives/motor_watch.h"

namespace inverter_bus
{
namespace bench
{
using drive::Item;
using drive::Space;
using simulation::ModbusException;
using simulation::Refusal;
using simulation::TimePoint;

namespace
{
constexpr double RAMP_TIME = 5.0;  // [s] for the whole range; invented
constexpr std::uint8_t WRITE_FUNCTIONS[] = { 0x05, 0x06, 0x0F, 0x10 };

simulation::ModbusLimits limitsOf(const drive::Profile& profile)
{
  simulation::ModbusLimits limits;
  for (const unsigned function : profile.functions)
  {
    limits.functions.insert(static_cast<std::uint8_t>(function));
  }
  for (const std::uint8_t function : WRITE_FUNCTIONS)
  {
    if (limits.functions.count(function) != 0)
    {
      limits.broadcast_functions.insert(function);
    }
  }
  limits.coils = static_cast<std::uint16_t>(std::max(profile.read_coils, 1U));
  limits.read_registers = static_cast<std::uint16_t>(profile.read_registers);
  limits.write_registers = static_cast<std::uint16_t>(profile.write_registers);
  return limits;
}

/// What a sequence leaves in its points.
std::map<std::string, std::uint32_t> endOf(const drive::Sequence& sequence)
{
  std::map<std::string, std::uint32_t> values;
  for (const drive::Step& step : sequence.steps)
  {
    if (step.value)
    {
      values[step.point] = *step.value;
    }
  }
  return values;
}

}  // namespace

ProfileDrive::ProfileDrive(std::shared_ptr<const drive::Profile> profile, const simulation::DriveOptions& options)
  : ModbusSlave(options.name, options.station, options.seed, options.start, limitsOf(*profile))
  , profile_(std::move(profile))
  , options_(options)
  , memory_(std::make_unique<ProfileMemory>(*profile_))
  , motor_({ options.rated_current, options.rated_voltage, profile_->maximum_frequency })
{
  motor_.setLoad(options.load);
  motor_.setRamps({ profile_->maximum_frequency, RAMP_TIME, RAMP_TIME, 0.0 });
  setSerial(options.line);
  commission();
}

ProfileDrive::~ProfileDrive() = default;

void ProfileDrive::commission()
{
  const int first = static_cast<int>(profile_->first_station);
  const int last = static_cast<int>(profile_->last_station);
  if (options_.station < first || options_.station > last)
  {
    throw std::invalid_argument(profile_->name + " has no station " + std::to_string(options_.station) + " (" +
                                std::to_string(first) + "-" + std::to_string(last) + ")");
  }
  for (const auto* wanted : { &profile_->identity, &profile_->command_source, &profile_->self_restart })
  {
    setAsWanted(*wanted);
  }
  for (const auto& parameter : options_.parameters)
  {
    if (const Refusal refusal = setParameter(parameter.first, parameter.second, options_.start))
    {
      throw std::invalid_argument(*refusal);
    }
  }
}

void ProfileDrive::setAsWanted(const std::vector<drive::Expectation>& expectations)
{
  for (const drive::Expectation& expectation : expectations)
  {
    const drive::Parameter* parameter = find(expectation.parameter);
    if (parameter != nullptr && !expectation.accept.empty())
    {
      memory_->setWhole(parameter->item, *expectation.accept.begin());
    }
  }
}

const drive::Parameter* ProfileDrive::find(const std::string& code) const
{
  const auto found = profile_->parameters.find(code);
  return found == profile_->parameters.end() ? nullptr : &found->second;
}

simulation::Duration ProfileDrive::replyDelay() const
{
  return simulation::seconds(std::max(options_.turnaround, profile_->reply_delay));
}

double ProfileDrive::startUpTime() const
{
  return options_.start_up_time;
}

void ProfileDrive::heard(std::uint8_t /*function*/)
{
  watchdog_.feed(clock());
}

ModbusException ProfileDrive::readCoils(std::uint16_t wire, std::uint16_t count, std::vector<bool>& values)
{
  showStatus();
  for (unsigned i = 0; i < count; ++i)
  {
    const auto address = static_cast<std::uint16_t>(wire + i);
    if (!memory_->has(Space::Coil, address))
    {
      return ModbusException::AddressNotFound;
    }
    values.push_back(memory_->word(Space::Coil, address) != 0);
  }
  return ModbusException::None;
}

ModbusException ProfileDrive::readRegisters(std::uint16_t wire, std::uint16_t count, std::vector<std::uint16_t>& values)
{
  showStatus();
  for (unsigned i = 0; i < count; ++i)
  {
    const auto address = static_cast<std::uint16_t>(wire + i);
    const bool hole = !memory_->has(Space::Register, address);
    if (hole && (count == 1 || !profile_->hole))
    {
      return ModbusException::AddressNotFound;
    }
    values.push_back(hole ? *profile_->hole : memory_->word(Space::Register, address));
  }
  return ModbusException::None;
}

ModbusException ProfileDrive::writeCoils(std::uint16_t wire, const std::vector<bool>& values)
{
  return write(Space::Coil, wire, { values.begin(), values.end() });
}

ModbusException ProfileDrive::writeRegisters(std::uint16_t wire, const std::vector<std::uint16_t>& values,
                                             std::uint8_t /*function*/)
{
  return write(Space::Register, wire, values);
}

ModbusException ProfileDrive::refusalOf(Space space, std::uint16_t address, std::uint16_t value) const
{
  if (!memory_->has(space, address))
  {
    return ModbusException::AddressNotFound;
  }
  for (const auto& entry : profile_->parameters)
  {
    const drive::Parameter& parameter = entry.second;
    if (!ProfileMemory::covers(parameter.item, space, address) || parameter.item.size != 1)
    {
      continue;
    }
    const double shown = (parameter.item.is_signed ? static_cast<double>(static_cast<std::int16_t>(value)) : value) *
                         parameter.item.resolution;
    const double slack = parameter.item.resolution / 2.0;
    const bool outside =
        parameter.range && (shown < parameter.range->first - slack || shown > parameter.range->second + slack);
    if (outside || (motor_.turning() && !parameter.while_running.value_or(true)))
    {
      return ModbusException::FormatNotAcceptable;
    }
  }
  return ModbusException::None;
}

ModbusException ProfileDrive::write(Space space, std::uint16_t wire, const std::vector<std::uint16_t>& values)
{
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const ModbusException refusal = refusalOf(space, static_cast<std::uint16_t>(wire + i), values[i]);
    if (refusal != ModbusException::None)
    {
      return refusal;
    }
  }
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    memory_->setWord(space, static_cast<std::uint16_t>(wire + i), values[i]);
  }
  obey(space, wire, values.size());
  return ModbusException::None;
}

/// A reset is seen by the first word that it writes: what it leaves behind looks like a stop on many drives.
bool ProfileDrive::startsReset(Space space, std::uint16_t first, std::size_t count) const
{
  const auto reset = profile_->sequences.find("reset");
  if (reset == profile_->sequences.end())
  {
    return false;
  }
  for (const drive::Step& step : reset->second.steps)
  {
    const auto point = profile_->points.find(step.point);
    if (!step.value || point == profile_->points.end())
    {
      continue;
    }
    const Item& item = point->second.item;
    const bool written = item.space == space && item.address >= first && item.address < first + count;
    return written && memory_->whole(item) == *step.value;
  }
  return false;
}

void ProfileDrive::obey(Space space, std::uint16_t first, std::size_t count)
{
  if (startsReset(space, first, count))
  {
    held_ = tripped_ && runCommand();
    tripped_ = false;
  }
  motion_ = motionOfPoints().value_or(motion_);
  held_ = held_ && runCommand();
  control();
}

/// The sequence whose words are in the points; of several, the most specific. Nothing: they are in between.
std::optional<ProfileDrive::Motion> ProfileDrive::motionOfPoints() const
{
  static const std::pair<const char*, Motion> COMMANDS[] = { { "stop", Motion::Rest },
                                                             { "quick", Motion::Rest },
                                                             { "coast", Motion::Coast },
                                                             { "forward", Motion::Forward },
                                                             { "reverse", Motion::Reverse } };
  std::optional<Motion> motion;
  std::size_t most = 0;
  for (const auto& command : COMMANDS)
  {
    const auto sequence = profile_->sequences.find(command.first);
    if (sequence == profile_->sequences.end())
    {
      continue;
    }
    const auto wanted = endOf(sequence->second);
    const bool stands = std::all_of(wanted.begin(), wanted.end(), [this](const auto& value) {
      const auto point = profile_->points.find(value.first);
      return point != profile_->points.end() && memory_->whole(point->second.item) == value.second;
    });
    if (stands && wanted.size() > most)
    {
      most = wanted.size();
      motion = command.second;
    }
  }
  return motion;
}

double ProfileDrive::setpoint() const
{
  for (const char* name : { "forward", "reverse" })
  {
    const auto sequence = profile_->sequences.find(name);
    for (const drive::Step& step :
         sequence == profile_->sequences.end() ? std::vector<drive::Step>() : sequence->second.steps)
    {
      const auto point = profile_->points.find(step.point);
      if (!step.value && point != profile_->points.end())
      {
        return std::min(memory_->whole(point->second.item) * point->second.item.resolution,
                        profile_->maximum_frequency);
      }
    }
  }
  return 0.0;
}

bool ProfileDrive::runCommand() const
{
  return motion_ == Motion::Forward || motion_ == Motion::Reverse;
}

void ProfileDrive::control()
{
  if (!powered() || tripped_ || (motion_ == Motion::Coast && !panel_))
  {
    motor_.cut();
    return;
  }
  const double hertz = runCommand() && !held_ ? setpoint() : 0.0;
  motor_.rampTo(panel_.value_or(motion_ == Motion::Reverse ? -hertz : hertz));
}

simulation::Duration ProfileDrive::timeout() const
{
  const drive::Parameter* parameter = find(profile_->communication_loss.timeout_parameter);
  if (parameter == nullptr || !powered())
  {
    return simulation::Duration::zero();
  }
  const double unit = parameter->item.unit == "ms" ? 0.001 : 1.0;
  return simulation::seconds(memory_->whole(parameter->item) * parameter->item.resolution * unit);
}

TimePoint ProfileDrive::nextChange(TimePoint limit) const
{
  const std::optional<TimePoint> lost = watchdog_.deadline(timeout());
  return nextLook(motor_, clock(), lost ? std::min(limit, *lost) : limit);
}

void ProfileDrive::move(double seconds)
{
  motor_.advance(seconds);
}

void ProfileDrive::change()
{
  if (!watchdog_.expireAt(clock(), timeout()))
  {
    return;
  }
  const drive::CommunicationLoss& loss = profile_->communication_loss;
  const drive::Parameter* action = find(loss.action_parameter);
  held_ = runCommand() && (action == nullptr || loss.runs_on.count(memory_->whole(action->item)) == 0);
  control();
}

void ProfileDrive::losePower()
{
  for (const auto& point : profile_->points)
  {
    memory_->setWhole(point.second.item, 0);
  }
  motion_ = Motion::Rest;
  tripped_ = false;
  held_ = false;
  watchdog_.reset();
  motor_.cut();
}

void ProfileDrive::gainPower()
{
  control();
}
}  // namespace bench
}  // namespace inverter_bus

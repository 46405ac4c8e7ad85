// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Variable areas and operations of the 3G3JE: manual I548, sections 3 and 4; what is invented: see JeDrive.

#include <cmath>
#include <stdexcept>

#include "simulation/compoway/compoway_frame.h"
#include "simulation/drives/je/je_drive.h"
#include "simulation/drives/je/je_parameters.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr std::uint8_t MONITORS = 0xC0;
constexpr std::uint8_t ADJUSTMENT = 0xC1;
constexpr std::uint8_t INITIAL_SETTINGS = 0xC3;
constexpr std::uint32_t REFERENCE = 0x0000;  // of C1; C0 shows it too
constexpr std::uint32_t OUTPUT_FREQUENCY = 0x0001;
constexpr std::uint32_t OUTPUT_CURRENT = 0x0002;
constexpr std::uint32_t STATUS = 0x0003;

/// Command code and related information by meaning. Invented.
const std::map<std::string, std::string>& inventedOperations()
{
  static const std::map<std::string, std::string> CODES = {
    { "run_forward", "1101" },  { "run_reverse", "1102" },    { "stop", "1100" },
    { "fault_reset", "1201" },  { "ram_write_mode", "1401" }, { "backup_write_mode", "1400" },
    { "setup_area_0", "1700" }, { "setup_area_1", "1701" },
  };
  return CODES;
}

std::uint32_t tenths(double value)
{
  return static_cast<std::uint32_t>(std::lround(value * 10.0));
}
}  // namespace

void JeDrive::buildOperations()
{
  std::map<std::string, std::string> codes = inventedOperations();
  for (const auto& entry : options_.operation_codes)
  {
    if (codes.count(entry.first) == 0)
    {
      throw std::invalid_argument("operation_codes: unknown operation " + entry.first +
                                  " (allowed: run_forward, run_reverse, stop, fault_reset, ram_write_mode, "
                                  "backup_write_mode, setup_area_0, setup_area_1)");
    }
    codes[entry.first] = entry.second;
  }
  for (const auto& entry : codes)
  {
    if (entry.second.size() != 4 || !fromHexDigits(entry.second))
    {
      throw std::invalid_argument("operation_codes: " + entry.first + " is " + entry.second +
                                  " (allowed: four digits 0-9, A-F)");
    }
    if (!operations_.emplace(entry.second, entry.first).second)
    {
      throw std::invalid_argument("operation_codes: " + entry.second + " is taken twice (allowed: each code once)");
    }
  }
}

bool JeDrive::hasArea(std::uint8_t type) const
{
  return type == MONITORS || type == ADJUSTMENT || type == INITIAL_SETTINGS;
}

bool JeDrive::hasAddress(std::uint8_t type, std::uint32_t address) const
{
  return address <= (type == MONITORS ? STATUS : (type == ADJUSTMENT ? REFERENCE : JE_LAST_C3));
}

bool JeDrive::readOnly(std::uint8_t type) const
{
  return type == MONITORS;
}

std::uint32_t JeDrive::status() const
{
  static const int FAULT_BITS[] = { 0, 1, 2, 3, 7, 8, 9 };  // of trip 1, 2, ...
  const double frequency = motor_.frequency();
  std::uint32_t word = powered() ? 1U << 12U : 0U;
  word |= frequency != 0.0 ? 1U << 13U : 0U;
  word |= frequency < 0.0 ? 1U << 14U : 0U;
  word |= tripped_ ? 1U << 15U : 0U;
  if (tripped_ && last_trip_ >= 1 && last_trip_ <= 7)
  {
    word |= 1U << static_cast<unsigned int>(FAULT_BITS[last_trip_ - 1]);
  }
  return word;
}

std::uint32_t JeDrive::monitor(std::uint32_t address) const
{
  switch (address)
  {
    case OUTPUT_FREQUENCY:
      return tenths(std::abs(motor_.frequency()));
    case OUTPUT_CURRENT:
      return tenths(motor_.current());
    case STATUS:
      return status();
    default:
      return memory_.ram(code_.reference);
  }
}

CompowayResponse JeDrive::readVariables(std::uint8_t type, std::uint32_t address, std::size_t count,
                                        std::vector<std::uint32_t>& values)
{
  if (type == INITIAL_SETTINGS && area_ == 0 && !options_.area_1_readable)
  {
    return Response::OperationError;
  }
  for (std::uint32_t place = address; place < address + count; ++place)
  {
    values.push_back(type == INITIAL_SETTINGS ? memory_.ram(memory_.at(static_cast<std::uint16_t>(place)))
                                              : monitor(place));
  }
  return Response::Normal;
}

bool JeDrive::accepts(std::uint8_t type, std::uint32_t address, const std::vector<std::uint32_t>& values) const
{
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const bool setting = type == INITIAL_SETTINGS;
    const Index index = setting ? memory_.at(static_cast<std::uint16_t>(address + i)) : code_.reference;
    if (type != MONITORS && !memory_.accepts(index, values[i]))
    {
      return false;
    }
  }
  return true;
}

CompowayResponse JeDrive::writeVariables(std::uint8_t type, std::uint32_t address,
                                         const std::vector<std::uint32_t>& values)
{
  if (busy() || (type == INITIAL_SETTINGS && area_ == 0))
  {
    return Response::OperationError;
  }
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const bool setting = type == INITIAL_SETTINGS;
    const Index index = setting ? memory_.at(static_cast<std::uint16_t>(address + i)) : code_.reference;
    if (ram_mode_ && !setting)
    {
      memory_.writeRam(index, values[i]);
    }
    else
    {
      memory_.writeBoth(index, values[i]);
    }
  }
  control();
  return Response::Normal;
}

CompowayResponse JeDrive::operate(const std::string& code)
{
  const auto found = operations_.find(code);
  const std::string name = found == operations_.end() ? "" : found->second;
  if (name == "run_forward" || name == "run_reverse")
  {
    return changeRun(name == "run_forward" ? Run::Forward : Run::Reverse);
  }
  if (name == "stop")
  {
    return changeRun(Run::Off);
  }
  if (name == "fault_reset")
  {
    return resetTrip();
  }
  if (name == "ram_write_mode" || name == "backup_write_mode")
  {
    return changeWriteMode(name == "ram_write_mode");
  }
  if (name == "setup_area_0" || name == "setup_area_1")
  {
    return changeArea(name == "setup_area_0" ? 0 : 1);
  }
  return Response::ParameterError;
}

CompowayResponse JeDrive::changeRun(Run run)
{
  if (!busCommands() || (run != Run::Off && area_ == 1))
  {
    return Response::OperationError;
  }
  setRun(run);
  return Response::Normal;
}

CompowayResponse JeDrive::resetTrip()
{
  tripped_ = false;
  control();  // a RUN that is still on restarts the motor here
  return Response::Normal;
}

CompowayResponse JeDrive::changeWriteMode(bool ram)
{
  if (area_ == 1)
  {
    return Response::OperationError;
  }
  if (ram_mode_ && !ram && memory_.ramChanges() > 0)
  {
    memory_.store();
  }
  ram_mode_ = ram;
  return Response::Normal;
}

CompowayResponse JeDrive::changeArea(int area)
{
  area_ = area;
  if (area == 1)
  {
    setRun(Run::Off);
  }
  return Response::Normal;
}

std::string JeDrive::controllerStatus() const
{
  const bool running = motor_.turning() || (busRuns() && !tripped_);
  return running ? "0000" : "0100";  // operating status, related information
}
}  // namespace simulation
}  // namespace inverter_bus

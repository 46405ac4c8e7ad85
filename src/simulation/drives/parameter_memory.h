// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_PARAMETER_MEMORY_H
#define INVERTER_BUS_SIMULATION_PARAMETER_MEMORY_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace inverter_bus
{
namespace simulation
{
/// One parameter of a drive. Raw values are what the registers hold: the panel's value without its decimal point.
struct Parameter
{
  std::string code;            ///< as on the panel: "F002"
  std::uint16_t number = 0;    ///< register number as printed in the manual (of the high word, if 2)
  int words = 1;               ///< 1 or 2 (high word first)
  int decimals = 0;            ///< panel value = raw / 10^decimals
  std::uint32_t minimum = 0;   ///< raw
  std::uint32_t maximum = 0;   ///< raw
  std::uint32_t initial = 0;   ///< raw, as the drive leaves the factory
  bool while_running = false;  ///< may be written while the motor runs
  std::uint32_t allowed = 0;   ///< bit n: value n is allowed (0: all of minimum ... maximum)
};

/// RAM and EEPROM of a drive's parameters. A write by the bus reaches the RAM; storing copies what was changed to the
/// EEPROM and counts it; a power cycle brings the EEPROM's values back.
class ParameterMemory
{
public:
  using Index = std::size_t;
  static constexpr Index NONE = static_cast<Index>(-1);

  /// \throws std::invalid_argument when two parameters share a register or a code (a mistake in the table)
  explicit ParameterMemory(std::vector<Parameter> table);

  /// NONE where there is no such parameter.
  Index find(const std::string& code) const;
  /// \p number of either word. NONE where the register is no parameter.
  Index at(std::uint16_t number) const;

  const Parameter& info(Index index) const;
  std::uint32_t ram(Index index) const;
  std::uint32_t eeprom(Index index) const;
  /// The value lies in the parameter's range.
  bool accepts(Index index, std::uint32_t raw) const;

  void writeRam(Index index, std::uint32_t raw);
  /// Writes both memories; counts as one write of the EEPROM.
  void writeBoth(Index index, std::uint32_t raw);
  /// Sets both without counting: how the drive was commissioned before the simulation began.
  void commission(Index index, std::uint32_t raw);
  /// Stores every RAM value that differs; counts as one write of the EEPROM.
  void store();
  /// Power cycle: the RAM gets the EEPROM's values.
  void reload();

  std::size_t ramChanges() const;      ///< parameters whose RAM differs from the EEPROM
  std::uint64_t eepromWrites() const;  ///< times that the EEPROM was written
  std::uint64_t storedValues() const;  ///< values that went into it, in all

private:
  std::vector<Parameter> table_;
  std::vector<std::uint32_t> ram_;
  std::vector<std::uint32_t> eeprom_;
  std::unordered_map<std::string, Index> by_code_;
  std::unordered_map<std::uint16_t, Index> by_number_;
  std::uint64_t eeprom_writes_ = 0;
  std::uint64_t stored_values_ = 0;
};

/// The raw value as the panel shows it: 1000 with two decimals is "10.00".
std::string panelText(const Parameter& parameter, std::uint32_t raw);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_PARAMETER_MEMORY_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_REGISTER_MAP_H
#define INVERTER_BUS_SIMULATION_REGISTER_MAP_H

#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "simulation/drives/parameter_memory.h"

namespace inverter_bus
{
namespace simulation
{
/// The Modbus mapping of an MX2: up to ten external register numbers, each of which means one internal register.
///
/// From the manuals (I585 p. 440, I570 p. 379, Hitachi WJ200 p. 532-569, WJ-C1 p. 354-357): P200 switches it on;
/// P201-P210 are the external numbers as printed, 0000h: slot not used; P211-P220 say signed or not; P221-P230 are the
/// ratios; P301-P310 the internal numbers. Written, an external value is multiplied by the ratio; read, the internal one
/// is divided by it. All of it counts from the next power-on.
///
/// Where they are silent: results are rounded to the nearest number; one that is read and doesn't fit 16 bits is cut off
/// at their end, one that is written is refused as out of range.
class RegisterMap
{
public:
  struct Slot
  {
    std::uint16_t internal = 0;
    bool has_sign = false;
    double ratio = 1.0;

    std::uint16_t shown(std::uint16_t internal_value) const;
    /// Nothing: it doesn't fit 16 bits.
    std::optional<std::uint16_t> taken(std::uint16_t external_value) const;
  };

  /// Power-on: what \p memory has in RAM now counts. A drive without P200 maps nothing.
  void latch(const ParameterMemory& memory);

  bool on() const;
  /// \p number is an external one, whatever its slot is worth.
  bool covers(std::uint16_t number) const;
  /// Null where the drive can't use the slot of \p number: no internal register, or the number is in two slots.
  const Slot* slot(std::uint16_t number) const;

private:
  std::map<std::uint16_t, Slot> slots_;  // by external number
  std::set<std::uint16_t> twice_;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_REGISTER_MAP_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_PLANT_H
#define INVERTER_BUS_FUZZ_PLANT_H

#include <cstddef>
#include <optional>
#include <string>

#include "fuzz/bus/scene.h"
#include "inverter_bus/simulation/simulated_bus.h"

namespace inverter_bus
{
namespace fuzz
{
/// What a motor does at one instant.
struct Truth
{
  double hertz = 0.0;  ///< unsigned
  int direction = 0;
  std::optional<double> torque;  ///< [%] unsigned; not every simulated drive has it
};

/// The simulated drives as they really are, whatever was reported of them.
class Plant
{
public:
  Plant(const Scene& scene, simulation::SimulatedBus& bus);

  /// The drive's own time passes up to \p now.
  void advance(TimePoint now, std::size_t index);
  Truth truth(std::size_t index) const;
  /// The drive holds a RUN.
  bool runLatched(std::size_t index) const;
  /// What `show` says of a drive; empty: it has no such key.
  std::string value(std::size_t index, const std::string& key) const;
  /// A value of `show` that is yes or no.
  bool flag(std::size_t index, const std::string& key) const;
  /// A parameter as it is in force; 0 if there is none.
  double ram(std::size_t index, const std::string& parameter) const;

private:
  const Scene& scene_;
  simulation::SimulatedBus& bus_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_PLANT_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_CONFIG_YAML_SPACING_H
#define INVERTER_BUS_SRC_CONFIG_YAML_SPACING_H

#include <string>

namespace inverter_bus
{
namespace config
{
/// Mistakes that PyYAML, and with it roslaunch, refuses and yaml-cpp ignores; lines from 1, 0: there is none.
struct SpacingMistakes
{
  int tab = 0;         ///< the first tab that is neither in quotes, nor in a comment, nor in a block of text
  int open_quote = 0;  ///< quotes that never close
};

/// Looks at \p yaml up to its first mistake.
SpacingMistakes findSpacingMistakes(const std::string& yaml);
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_CONFIG_YAML_SPACING_H

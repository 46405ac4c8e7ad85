// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_CONFIG_YAML_TEXT_H
#define INVERTER_BUS_SRC_CONFIG_YAML_TEXT_H

#include <optional>
#include <string>

namespace inverter_bus
{
namespace config
{
/// A mistake in a text: one line of any bytes.
struct TextProblem
{
  int line = 0;  ///< from 1; 0: the whole text
  std::string what;
};

/// What is wrong with \p yaml as a text, before a parser sees it: characters that PyYAML refuses and yaml-cpp does not (control
/// characters, bytes that are not UTF-8, tabs between words), and blocks nested so deeply that a parser which recurses would
/// leave its stack.
std::optional<TextProblem> problemOfText(const std::string& yaml);

/// Documents in \p yaml: 0, 1, or 2 for more. Looks at the text before nodes are made of it, since yaml-cpp collects
/// documents without end where one begins with a comma.
/// \throws YAML::Exception for malformed text, and for one that is nested too deeply
int countDocuments(const std::string& yaml);
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_CONFIG_YAML_TEXT_H

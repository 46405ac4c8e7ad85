// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_COMMAND_LINE_H
#define INVERTER_BUS_ROS_COMMAND_LINE_H

#include <optional>
#include <string>
#include <vector>

namespace inverter_bus
{
namespace ros_node
{
/// The answer of a node that takes nothing but ROS's own arguments, in place of starting.
struct CommandLineAnswer
{
  int status = 0;
  /// For the standard output at status 0, else for the standard error.
  std::string text;
};

/// Judges the arguments of a node before ROS sees them: a node of the same name that runs already would be ended by one
/// that only wanted to show its help. Allowed are remappings (`a:=b`, `__name:=x`, `_parameter:=1`).
/// \param arguments without the program's name
/// \return nothing: start; else the usage (-h, --help) or what is wrong
std::optional<CommandLineAnswer> judgeCommandLine(const std::vector<std::string>& arguments, const std::string& usage);

/// The same for main(): prints the answer. Returns the exit status, or nothing: start.
std::optional<int> answerCommandLine(int argc, const char* const* argv, const std::string& usage);
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_COMMAND_LINE_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_TRACE_TEXT_H
#define INVERTER_BUS_ROS_TRACE_TEXT_H

#include <chrono>
#include <ostream>
#include <string>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace ros_node
{
/// "20260705T123456.123456Z".
std::string fileStamp(std::chrono::system_clock::time_point time);

/// Writes \p dump as text, a frame or an event per line in the order of time: UTC with microseconds, microseconds since the line
/// before, what it is, and the bytes in hexadecimal or the event in words. \p steady and \p wall are the same moment on both
/// clocks. docs/troubleshooting.md describes the format.
void writeTrace(const bus::TraceDump& dump, TimePoint steady, std::chrono::system_clock::time_point wall,
                std::ostream& out);
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_TRACE_TEXT_H

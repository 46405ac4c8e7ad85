// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_ROS_DIAGNOSTICS_H
#define INVERTER_BUS_ROS_DIAGNOSTICS_H

#include <cstddef>
#include <string>
#include <thread>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>

#include "inverter_bus/bus/bus.h"
#include "ros/commands.h"
#include "ros/master_watch.h"
#include "ros/trace_files.h"
#include "util/steady_event.h"

namespace inverter_bus
{
namespace ros_node
{
/// Publishes /diagnostics at 1 Hz from a thread of its own on the steady clock: also when the bus or ROS time stops.
class Diagnostics
{
public:
  Diagnostics(const bus::Configuration& configuration, const bus::Bus& bus, const Commands& commands,
              const MasterWatch& master_watch, const TraceFiles& traces);
  /// As stop().
  ~Diagnostics();

  Diagnostics(const Diagnostics&) = delete;
  Diagnostics& operator=(const Diagnostics&) = delete;

  void stop();

private:
  void work();
  void showInverter(std::size_t index, diagnostic_updater::DiagnosticStatusWrapper& entry) const;
  void showBus(diagnostic_updater::DiagnosticStatusWrapper& entry) const;

  const bus::BusConfig config_;
  const std::vector<drive::Drive> drives_;
  const bus::Bus& bus_;
  const Commands& commands_;
  const MasterWatch& master_watch_;
  const TraceFiles& traces_;
  bus::Report report_;  ///< of this round; diagnostics thread only
  diagnostic_updater::Updater updater_;
  util::SteadyEvent stopping_;
  std::thread thread_;
};

/// Level and text of an entry: the worst findings; without any, that all is well.
void summarize(const std::vector<bus::Finding>& findings, const std::string& in_order,
               diagnostic_updater::DiagnosticStatusWrapper& entry);
}  // namespace ros_node
}  // namespace inverter_bus

#endif  // INVERTER_BUS_ROS_DIAGNOSTICS_H

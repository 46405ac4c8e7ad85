// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_DRIVER_H
#define INVERTER_BUS_FUZZ_DRIVER_H

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "bus/bus_loop.h"
#include "bus/coordinator.h"
#include "fuzz/bus/line_watch.h"
#include "support/virtual_world.h"

namespace inverter_bus
{
namespace fuzz
{
/// A port that reports every request to the checker before its first byte leaves.
class WatchedPort : public VirtualPort
{
public:
  WatchedPort(simulation::SimulatedBus& bus, AppointedClock& clock, LineWatch& watch);

  wire::OpenResult open(std::string& error) override;
  bool send(const wire::Bytes& frame) override;
  wire::ReceiveResult receive(wire::Bytes& buffer, TimePoint deadline) override;

  /// What becomes of a request on its way.
  std::function<void(const wire::Bytes&)> on_the_way = [](const wire::Bytes&) {};

private:
  AppointedClock& clock_;
  LineWatch& watch_;
};

/// What is tested: the driver's core from its bus loop down to the port.
struct Driver
{
  Driver(const bus::Configuration& configuration, simulation::SimulatedBus& bus, AppointedClock& clock,
         LineWatch& watch);

  WatchedPort port;
  std::unique_ptr<wire::Protocol> protocol;
  wire::Line line;
  std::mutex mutex;
  bus::Coordinator coordinator;
  bus::BusLoop loop;

  /// The node warns that it can't serve this inverter within its communication time-out.
  bool budgetWarns(TimePoint now, std::size_t index) const;
  /// What the status of each inverter of \p command says now of its lock.
  std::vector<bool> locked(TimePoint now, const bus::VelocityCommand& command) const;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_DRIVER_H

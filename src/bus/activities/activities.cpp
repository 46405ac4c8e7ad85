// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/activities.h"

namespace inverter_bus
{
namespace bus
{
Activities::Activities(BusState& bus)
  : trace(bus)
  , turns(bus)
  , traffic(bus, turns)
  , stops(bus, turns, traffic)
  , services(bus, turns, stops)
  , absences(bus, stops, services)
  , velocities(bus, turns, traffic, stops, absences)
  , guard(bus)
  , polls(bus, turns, guard, stops, absences)
  , settings(bus, turns, services, absences)
  , probes(bus, turns, traffic, stops)
  , telnet(bus, absences)
  , port(bus, stops, absences, telnet)
  , checks(bus, traffic)
  , shutdown(bus, traffic, stops, services)
  , reports(bus, traffic, stops, port)
{
}
}  // namespace bus
}  // namespace inverter_bus

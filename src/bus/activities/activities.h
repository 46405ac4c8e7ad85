// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_ACTIVITIES_H
#define INVERTER_BUS_BUS_ACTIVITIES_H

#include "bus/activities/link_checks.h"
#include "bus/activities/polls.h"
#include "bus/activities/probes.h"
#include "bus/activities/reports.h"
#include "bus/activities/settings_reads.h"
#include "bus/activities/shutdown.h"
#include "bus/activities/trace_notes.h"
#include "bus/activities/velocities.h"
#include "bus/activities/waits.h"

namespace inverter_bus
{
namespace bus
{
/// All that a bus does, in the order in which one knows another: what is listed below may ask what is listed above, never
/// the other way round.
struct Activities
{
  explicit Activities(BusState& bus);
  Activities(const Activities&) = delete;
  Activities& operator=(const Activities&) = delete;

  TraceNotes trace;
  Turns turns;
  GatewayTraffic traffic;
  Stops stops;
  Services services;
  Absences absences;
  Velocities velocities;
  ReplyGuard guard;
  Polls polls;
  SettingsReads settings;
  Probes probes;
  Waits waits;
  TelnetStops telnet;
  PortWatch port;
  LinkChecks checks;
  Shutdown shutdown;
  Reports reports;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_ACTIVITIES_H

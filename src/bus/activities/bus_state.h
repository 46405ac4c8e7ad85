// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_BUS_STATE_H
#define INVERTER_BUS_BUS_BUS_STATE_H

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bus/inverter/inverter.h"
#include "bus/link/connection_watch.h"
#include "bus/link/gateway_queue.h"
#include "bus/link/link_watch.h"
#include "bus/report/group_error.h"
#include "bus/report/line_watch.h"
#include "bus/report/load_meter.h"
#include "bus/report/outbox.h"
#include "bus/report/refusal_log.h"
#include "bus/rules/budget.h"
#include "bus/rules/scheduler.h"
#include "bus/rules/slow_share.h"
#include "inverter_bus/bus/types.h"
#include "inverter_bus/wire/line.h"

namespace inverter_bus
{
namespace bus
{
/// What the activities of one bus share. State that concerns only one activity belongs in that activity.
struct BusState
{
  /// \p line is asked for its timing, and not kept.
  BusState(const Configuration& the_configuration, const wire::Line& line);

  const Configuration& configuration;
  /// Of the configuration alone: it does not change while the bus runs.
  const Budget::Figures budget;
  /// In node order.
  std::vector<std::unique_ptr<Inverter>> inverters;
  Scheduler scheduler;
  SlowShare slow_share;
  Outbox outbox;
  LoadMeter meter;
  LineWatch line_watch;
  RefusalLog refusals;
  GroupError group_error;

  // the way to the drives
  GatewayQueue gateway;
  ConnectionWatch connection;
  LinkWatch link;
  bool connected = false;
  TimePoint opened_at;
  /// The exchange that has just ended was not answered, and says nothing: an older request was unanswered.
  bool behind_another = false;
  /// A broadcast went while the gateway was blocked: no other one meanwhile (contract, 8.8).
  bool broadcast_waits = false;

  CommandId next_command = 1;
  std::uint16_t loopback_number = 0;
  /// Station of the exchange in flight, or of the last one.
  std::uint8_t last_node = 0;
  /// Of the last exchange; 0: it was answered.
  std::uint16_t last_error = 0;

  bool shutting_down = false;
  /// No exchange is asked for any more.
  bool ended = false;
};

/// A drive with a port of its own that has not reported its status yet: to a gateway the same number means something
/// else, so nothing but reads goes there (contract, 8.8).
bool untested(const Inverter& inverter);

/// In the drive's own words where it has answered.
std::string refusalText(const Inverter& inverter, std::uint16_t error_id);

/// How long each service may take: slow buses and long scan lists get more time; docs/commands.md states how much.
ServiceBounds serviceBounds(const BusState& bus);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_BUS_STATE_H

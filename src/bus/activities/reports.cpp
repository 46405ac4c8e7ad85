// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/reports.h"

#include <string>

#include "bus/report/inverter_report.h"
#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double STATUS_PERIOD_OFFLINE_S = 0.5;
constexpr double BUS_STATUS_SHORTEST_S = 0.1;
constexpr double BUS_STATUS_LONGEST_S = 0.9;
}  // namespace

Reports::Reports(BusState& bus, const GatewayTraffic& traffic, const Stops& stops, const Waits& waits,
                 const PortWatch& port)
  : bus_(bus), traffic_(traffic), stops_(stops), waits_(waits), port_(port)
{
}

void Reports::noteAdapter(const std::optional<wire::AdapterLatency>& latency)
{
  adapter_.note(latency);
}

void Reports::publishSlowly(TimePoint now)
{
  // Behind a gateway that is kept busy no refresh comes, but locks and stops must be visible.
  const bool busy = !bus_.gateway.free(now);
  for (const auto& inverter : bus_.inverters)
  {
    const bool held_up = busy && inverter->link.known();
    if ((inverter->link.offline() || held_up) &&
        now - bus_.outbox.lastPublished(inverter->index) >= seconds(STATUS_PERIOD_OFFLINE_S))
    {
      bus_.outbox.publish(now, *inverter);
    }
  }
  const Duration since = now - last_bus_status_;
  const bool cycle_done = bus_.scheduler.cycles() != published_cycle_;
  if (cycle_done)
  {
    bus_.meter.cycle(bus_.scheduler.cycleTime());
  }
  // A loss is reported at once (contract, 8.16).
  const bool connected = port_.usable();
  const bool changed = connected != published_connected_;
  if (changed || (cycle_done && since >= seconds(BUS_STATUS_SHORTEST_S)) || since >= seconds(BUS_STATUS_LONGEST_S))
  {
    bus_.outbox.busStatus(busStatus(now));
    last_bus_status_ = now;
    published_connected_ = connected;
  }
  published_cycle_ = bus_.scheduler.cycles();
}

BusStatus Reports::busStatus(TimePoint now) const
{
  BusStatus status;
  status.connected = port_.usable();
  status.busy = bus_.connected;
  status.node = bus_.last_node;
  status.error_id = bus_.group_error.id() != 0 ? bus_.group_error.id() : bus_.last_error;
  status.error = status.error_id != 0;
  status.counters = bus_.line_watch.facts().counters;
  status.reconnects = port_.reconnects();
  status.cycle_time = toSeconds(bus_.scheduler.cycleTime());
  status.utilization = bus_.meter.utilization(now);
  status.efficiency = bus_.meter.efficiency();
  status.stop_latency_max = toSeconds(stops_.latencyMax());
  for (const auto& inverter : bus_.inverters)
  {
    if (inverter->link.offline())
    {
      status.offline_nodes.push_back(inverter->config.node);
    }
  }
  return status;
}

Report Reports::report(TimePoint now) const
{
  Report report;
  report.bus = busStatus(now);
  addFindings(now, report);
  addValues(report);
  for (const auto& inverter : bus_.inverters)
  {
    InverterReport entry;
    entry.name = inverter->config.name;
    entry.node = inverter->config.node;
    entry.status = statusOf(*inverter, now);
    entry.findings = findingsOf(*inverter, now);
    entry.values = valuesOf(*inverter, now);
    const auto timeout = inverter->settings.driveTimeout();
    if (timeout && !inverter->drive.profile().communication_loss.timeout_parameter.empty())
    {
      if (const auto finding = Budget::judgeDriveTimeout(entry.name, *timeout, bus_.budget.deadline_margin))
      {
        entry.findings.push_back(*finding);
      }
    }
    report.inverters.push_back(entry);
  }
  return report;
}

void Reports::addFindings(TimePoint now, Report& report) const
{
  if (!report.bus.connected)
  {
    report.findings.push_back(
        { Level::Error,
          (port_.error().empty() ? "port " + bus_.configuration.bus.port + " is not open yet" : port_.error()) +
              (bus_.configuration.bus.gateway ? "; check the address, and what else is connected to it"
                                              : "; plug it in or check its name, rights and settings") });
  }
  for (const auto& finding : { traffic_.finding(), traffic_.quirkFinding() })
  {
    if (finding)
    {
      report.findings.push_back(*finding);
    }
  }
  if (const auto finding = bus_.line_watch.foreignFinding(now, bus_.configuration.bus.gateway.has_value()))
  {
    report.findings.push_back(*finding);
  }
  if (const auto finding = adapter_.finding())
  {
    report.findings.push_back(*finding);
  }
  if (bus_.scheduler.pauseWasCut())
  {
    report.findings.push_back({ Level::Warn,
                                "interval is longer than a drive's own communication time-out allows and is "
                                "cut short" });
  }
  for (const Finding& finding : bus_.budget.findings)
  {
    if (finding.level != Level::Ok)
    {
      report.findings.push_back(finding);
    }
  }
}

void Reports::addValues(Report& report) const
{
  report.values.emplace_back("port", bus_.configuration.bus.port);
  report.values.emplace_back("cycle time", util::fixedText(report.bus.cycle_time * 1e3, 1) + " ms");
  report.values.emplace_back("computed cycle", util::millisecondsText(bus_.budget.cycle));
  report.values.emplace_back("utilization", util::fixedText(report.bus.utilization * 100.0, 0) + " %");
  report.values.emplace_back("worst stop latency, computed",
                             util::millisecondsText(bus_.gateway.active() ? traffic_.worstStop() : waits_.worstStop()));
  if (!bus_.gateway.active())
  {
    report.values.emplace_back("worst stop latency behind a stop, a reset or an EEPROM write",
                               util::millisecondsText(traffic_.worstStop()));
  }
  report.values.emplace_back("worst stop latency, measured",
                             util::fixedText(report.bus.stop_latency_max * 1e3, 1) + " ms");
  if (!bus_.configuration.bus.gateway)
  {
    report.values.emplace_back("adapter latency", adapter_.text());
  }
  report.values.emplace_back("longest pause in a reply", util::millisecondsText(bus_.budget.longest_pause));
  if (bus_.gateway.active())
  {
    report.values.emplace_back("gateway blocked by a silent station", util::millisecondsText(bus_.gateway.block(), 0));
    report.values.emplace_back("offline inverter back within", traffic_.returnText());
  }
  report.values.emplace_back("slow values", bus_.slow_share.reads()
                                                ? "at most " + util::fixedText(SLOW_SHARE * 100.0, 1) + " % of the wire"
                                                : std::string("never read"));
  report.values.emplace_back("local echo", bus_.line_watch.facts().echo_found ? "removed" : "none");
  report.values.emplace_back("frames of others", std::to_string(bus_.line_watch.facts().counters.foreign_frames));
}
}  // namespace bus
}  // namespace inverter_bus

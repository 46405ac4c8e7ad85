// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/coordinator.h"
#include "util/text.h"

// What the coordinator tells: status, diagnostics, answers.

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double FOREIGN_SHOWN_S = 60.0;

}  // namespace

void Coordinator::log(Level level, const std::string& text, const std::string& subject)
{
  outputs_.log.push_back({ level, text, subject });
}

void Coordinator::publish(TimePoint now, const Inverter& inverter)
{
  outputs_.statuses.push_back(inverter.status(now));
  last_published_[inverter.index] = now;
}

BusStatus Coordinator::busStatus(TimePoint now) const
{
  BusStatus status;
  status.connected = connected_ && !port_failing_;
  status.busy = connected_;
  status.node = last_node_;
  status.error_id = group_error_ != 0 ? group_error_ : last_error_;
  status.error = status.error_id != 0;
  status.counters = counters_;
  status.reconnects = reconnects_;
  status.cycle_time = toSeconds(scheduler_->cycleTime());
  status.utilization = meter_.utilization(now);
  status.efficiency = meter_.efficiency();
  status.stop_latency_max = toSeconds(stop_latency_max_);
  for (const auto& inverter : inverters_)
  {
    if (inverter->offline())
    {
      status.offline_nodes.push_back(inverter->config.node);
    }
  }
  return status;
}

Outputs Coordinator::takeOutputs()
{
  Outputs outputs;
  std::swap(outputs, outputs_);
  return outputs;
}

PendingAnswers Coordinator::takeAnswers()
{
  PendingAnswers answers;
  std::swap(answers, answers_);
  return answers;
}

std::vector<Finding> Coordinator::budget() const
{
  return budget_.findings;
}

Report Coordinator::report(TimePoint now) const
{
  Report report;
  report.bus = busStatus(now);
  if (!report.bus.connected)
  {
    report.findings.push_back(
        { Level::Error, (port_error_.empty() ? "port " + configuration_.bus.port + " is not open yet" : port_error_) +
                            (configuration_.bus.gateway ? "; check the address, and what else is connected to it"
                                                        : "; plug it in or check its name, rights and settings") });
  }
  for (const auto& finding : { gatewayFinding(), quirkFinding() })
  {
    if (finding)
    {
      report.findings.push_back(*finding);
    }
  }
  if (counters_.foreign_frames > 0 && now - foreign_at_ < seconds(FOREIGN_SHOWN_S))
  {
    report.findings.push_back(
        { Level::Warn, std::string("frames that this node did not ask for are on the line: look for ") +
                           (configuration_.bus.gateway ? "another client of the gateway, or a gateway that "
                                                         "polls by itself"
                                                       : "a second master") +
                           " (" + std::to_string(counters_.foreign_frames) + " so far)" });
  }
  if (const auto finding = adapter_.finding())
  {
    report.findings.push_back(*finding);
  }
  if (scheduler_->pauseWasCut())
  {
    report.findings.push_back({ Level::Warn,
                                "interval is longer than a drive's own communication time-out allows and is "
                                "cut short" });
  }
  for (const Finding& finding : budget_.findings)
  {
    if (finding.level != Level::Ok)
    {
      report.findings.push_back(finding);
    }
  }
  report.values.emplace_back("port", configuration_.bus.port);
  report.values.emplace_back("cycle time", util::fixedText(report.bus.cycle_time * 1e3, 1) + " ms");
  report.values.emplace_back("computed cycle", util::millisecondsText(budget_.cycle));
  report.values.emplace_back("utilization", util::fixedText(report.bus.utilization * 100.0, 0) + " %");
  report.values.emplace_back("worst stop latency, computed", util::millisecondsText(worstStop()));
  report.values.emplace_back("worst stop latency, measured",
                             util::fixedText(report.bus.stop_latency_max * 1e3, 1) + " ms");
  if (!configuration_.bus.gateway)
  {
    report.values.emplace_back("adapter latency", adapter_.text());
  }
  report.values.emplace_back("longest pause in a reply", util::millisecondsText(line_.patience()));
  if (gateway_.active())
  {
    report.values.emplace_back("gateway kept by a silent station", util::millisecondsText(gateway_.block(), 0));
    report.values.emplace_back("offline inverter back within", returnText());
  }
  report.values.emplace_back("local echo", echo_found_ ? "removed" : "none");
  report.values.emplace_back("frames of others", std::to_string(counters_.foreign_frames));
  for (const auto& inverter : inverters_)
  {
    InverterReport entry;
    entry.name = inverter->config.name;
    entry.node = inverter->config.node;
    entry.status = inverter->status(now);
    entry.findings = inverter->findings(now);
    entry.values = inverter->values(now);
    const auto timeout = inverter->settings.driveTimeout();
    if (timeout && !inverter->drive.profile().communication_loss.timeout_parameter.empty())
    {
      if (const auto finding = Budget::judgeDriveTimeout(entry.name, *timeout, budget_.deadline_margin))
      {
        entry.findings.push_back(*finding);
      }
    }
    report.inverters.push_back(entry);
  }
  return report;
}
}  // namespace bus
}  // namespace inverter_bus

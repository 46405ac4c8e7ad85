// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>
#include <cstdio>
#include <iterator>

#include "bus/coordinator.h"

// What the coordinator tells: status, diagnostics, answers.

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double FOREIGN_SHOWN_S = 60.0;

std::string rounded(double value, const char* format)
{
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

Finding portFinding(const BusConfig& bus, const std::string& error)
{
  return { Level::Error, (error.empty() ? "port " + bus.port + " is not open yet" : error) +
                             (bus.gateway ? "; check the address, and what else is connected to it"
                                          : "; plug it in or check its name, rights and settings") };
}

Finding foreignFinding(const BusConfig& bus, std::uint64_t frames)
{
  return { Level::Warn,
           std::string("frames that this node did not ask for are on the line: look for ") +
               (bus.gateway ? "another client of the gateway, or a gateway that polls by itself" : "a second master") +
               " (" + std::to_string(frames) + " so far)" };
}

InverterReport inverterReport(TimePoint now, const Inverter& inverter, Duration deadline_margin)
{
  InverterReport report;
  report.name = inverter.config.name;
  report.node = inverter.config.node;
  report.status = inverter.status(now);
  report.findings = inverter.findings(now);
  report.values = inverter.values(now);
  const auto timeout = inverter.settings.driveTimeout();
  if (timeout && !inverter.drive.profile().communication_loss.timeout_parameter.empty())
  {
    if (const auto finding = Budget::judgeDriveTimeout(report.name, *timeout, deadline_margin))
    {
      report.findings.push_back(*finding);
    }
  }
  return report;
}
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
    report.findings.push_back(portFinding(configuration_.bus, port_error_));
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
    report.findings.push_back(foreignFinding(configuration_.bus, counters_.foreign_frames));
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
  std::copy_if(budget_.findings.begin(), budget_.findings.end(), std::back_inserter(report.findings),
               [](const Finding& finding) { return finding.level != Level::Ok; });
  report.values.emplace_back("port", configuration_.bus.port);
  report.values.emplace_back("cycle time", rounded(report.bus.cycle_time * 1e3, "%.1f ms"));
  report.values.emplace_back("computed cycle", rounded(toSeconds(budget_.cycle) * 1e3, "%.1f ms"));
  report.values.emplace_back("utilization", rounded(report.bus.utilization * 100.0, "%.0f %%"));
  report.values.emplace_back("worst stop latency, computed", rounded(toSeconds(worstStop()) * 1e3, "%.1f ms"));
  report.values.emplace_back("worst stop latency, measured", rounded(report.bus.stop_latency_max * 1e3, "%.1f ms"));
  if (!configuration_.bus.gateway)
  {
    report.values.emplace_back("adapter latency", adapter_.text());
  }
  report.values.emplace_back("longest pause in a reply", rounded(toSeconds(line_.patience()) * 1e3, "%.1f ms"));
  if (gateway_.active())
  {
    report.values.emplace_back("gateway kept by a silent station",
                               rounded(toSeconds(gateway_.block()) * 1e3, "%.0f ms"));
    report.values.emplace_back("offline inverter back within", returnText());
  }
  report.values.emplace_back("local echo", echo_found_ ? "removed" : "none");
  report.values.emplace_back("frames of others", std::to_string(counters_.foreign_frames));
  for (const auto& inverter : inverters_)
  {
    report.inverters.push_back(inverterReport(now, *inverter, budget_.deadline_margin));
  }
  return report;
}
}  // namespace bus
}  // namespace inverter_bus

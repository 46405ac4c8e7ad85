// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/diagnostics.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include <ros/names.h>

#include "util/text.h"

namespace inverter_bus
{
namespace ros_node
{
namespace
{
constexpr Duration PERIOD = std::chrono::seconds(1);

using Entry = diagnostic_updater::DiagnosticStatusWrapper;

std::uint8_t levelOf(bus::Level level)
{
  switch (level)
  {
    case bus::Level::Ok:
      return diagnostic_msgs::DiagnosticStatus::OK;
    case bus::Level::Warn:
      return diagnostic_msgs::DiagnosticStatus::WARN;
    case bus::Level::Error:
      break;
  }
  return diagnostic_msgs::DiagnosticStatus::ERROR;
}

void addValues(const std::vector<std::pair<std::string, std::string>>& values, Entry& entry)
{
  for (const auto& value : values)
  {
    entry.add(value.first, value.second);
  }
}

/// Two masters on one topic: the drive follows the one that spoke last.
void addPublishers(std::uint32_t publishers, const std::string& topic, std::vector<bus::Finding>& findings)
{
  if (publishers > 1)
  {
    const std::string name = ros::names::resolve("~" + topic);
    findings.push_back({ bus::Level::Warn, std::to_string(publishers) + " publishers on " + name +
                                               ": keep only one of them (rostopic info " + name + ")" });
  }
}

std::string motionText(const bus::InverterStatus& status)
{
  if (!status.has_stamp)
  {
    return "no status yet";
  }
  return status.monitor.running.value_or(status.run_command) ? "running" : "at rest";
}
}  // namespace

void summarize(const std::vector<bus::Finding>& findings, const std::string& in_order, Entry& entry)
{
  std::vector<bus::Finding> sorted = findings;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const bus::Finding& a, const bus::Finding& b) { return a.level > b.level; });
  std::vector<std::string> texts;
  for (const bus::Finding& finding : sorted)
  {
    if (finding.level != bus::Level::Ok)
    {
      texts.push_back(finding.text);
    }
  }
  entry.summary(levelOf(sorted.empty() ? bus::Level::Ok : sorted.front().level),
                texts.empty() ? in_order : util::joined(texts, "; "));
}

Diagnostics::Diagnostics(const bus::Configuration& configuration, const bus::Bus& bus, const Commands& commands,
                         const MasterWatch& master_watch, const TraceFiles& traces)
  : config_(configuration.bus)
  , drives_(configuration.drives)
  , bus_(bus)
  , commands_(commands)
  , master_watch_(master_watch)
  , traces_(traces)
{
  updater_.setHardwareID(config_.port);
  updater_.add("bus", [this](Entry& entry) { showBus(entry); });
  for (std::size_t i = 0; i < config_.inverters.size(); ++i)
  {
    updater_.add(config_.inverters[i].name, [this, i](Entry& entry) { showInverter(i, entry); });
  }
  thread_ = std::thread([this] { work(); });
}

Diagnostics::~Diagnostics()
{
  stop();
}

void Diagnostics::stop()
{
  stopping_.set();
  if (thread_.joinable())
  {
    thread_.join();
  }
}

void Diagnostics::work()
{
  TimePoint next = std::chrono::steady_clock::now();
  do
  {
    report_ = bus_.report();
    updater_.force_update();
    next = std::max(next + PERIOD, std::chrono::steady_clock::now());
  } while (!stopping_.waitFor(next - std::chrono::steady_clock::now()));
}

void Diagnostics::showInverter(std::size_t index, Entry& entry) const
{
  const bus::InverterConfig& config = config_.inverters[index];
  entry.hardware_id = drives_[index].profile().name + " at " + config_.port + " station " + std::to_string(config.node);
  if (index >= report_.inverters.size())
  {
    entry.summary(diagnostic_msgs::DiagnosticStatus::WARN, "no report yet");
    return;
  }
  const bus::InverterReport& report = report_.inverters[index];
  std::vector<bus::Finding> findings = report.findings;
  addPublishers(commands_.publishers(index), config.name + "/command", findings);
  summarize(findings, motionText(report.status), entry);
  addValues(report.values, entry);
}

void Diagnostics::showBus(Entry& entry) const
{
  std::vector<bus::Finding> findings = report_.findings;
  addPublishers(commands_.groupPublishers(), "command", findings);
  if (const std::optional<bus::Finding> finding = master_watch_.finding())
  {
    findings.push_back(*finding);
  }
  summarize(findings, report_.bus.connected ? "connected" : "not connected", entry);
  addValues(report_.values, entry);
  const std::optional<TraceFiles::File> file = traces_.last();
  entry.add("flight recorder, last file", file ? file->path : "none since the start");
  entry.add("flight recorder, written because of", file ? file->reason : "");
}
}  // namespace ros_node
}  // namespace inverter_bus

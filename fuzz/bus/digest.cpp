// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/digest.h"

#include <cstdio>
#include <cstring>
#include <tuple>

#include "drive/monitor_fields.h"

namespace inverter_bus
{
namespace fuzz
{
void Hash::bytes(const void* data, std::size_t size)
{
  constexpr std::uint64_t PRIME = 0x100000001B3ULL;
  const auto* byte = static_cast<const std::uint8_t*>(data);
  for (std::size_t index = 0; index < size; ++index)
  {
    value_ = (value_ ^ byte[index]) * PRIME;
  }
}

void Hash::text(const std::string& value)
{
  number(value.size());
  bytes(value.data(), value.size());
}

void Hash::number(std::uint64_t value)
{
  bytes(&value, sizeof value);
}

void Hash::real(double value)
{
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  number(bits);
}

void Hash::time(TimePoint value)
{
  number(static_cast<std::uint64_t>(value.time_since_epoch().count()));
}

void Digest::frame(const simulation::FrameRecord& frame)
{
  frames_.time(frame.time);
  frames_.number(static_cast<std::uint64_t>(frame.source));
  frames_.text(frame.drive);
  frames_.number(frame.bytes.size());
  frames_.bytes(frame.bytes.data(), frame.bytes.size());
  frames_.text(frame.remark);
}

void Digest::commanded(TimePoint now, std::uint16_t result)
{
  decisions_.time(now);
  decisions_.number(result);
}

void Digest::outputs(TimePoint now, const bus::Outputs& outputs)
{
  for (const bus::InverterStatus& one : outputs.statuses)
  {
    decisions_.time(now);
    status(one);
  }
  for (const bus::BusStatus& one : outputs.bus_statuses)
  {
    decisions_.time(now);
    busStatus(one);
  }
  for (const bus::Finding& line : outputs.log)
  {
    decisions_.time(now);
    finding(line);
    texts_.text(line.subject);
  }
  for (const std::string& trace : outputs.traces)
  {
    decisions_.time(now);
    texts_.text(trace);
  }
}

void Digest::answer(TimePoint now, const bus::Answer& answer)
{
  decisions_.time(now);
  decisions_.number(answer.success ? 1 : 0);
  decisions_.number(answer.error_id);
  decisions_.real(answer.value);
  decisions_.number(answer.faults.size());
  record(answer.present);
  for (const drive::FaultRecord& one : answer.faults)
  {
    record(one);
  }
  texts_.text(answer.message);
  texts_.text(answer.unit);
}

/// What /diagnostics would show at the end of the story.
void Digest::report(const bus::Report& report)
{
  busStatus(report.bus);
  const auto values = [this](const auto& pairs) {
    for (const auto& value : pairs)
    {
      texts_.text(value.first);
      texts_.text(value.second);
    }
  };
  values(report.values);
  for (const bus::Finding& one : report.findings)
  {
    finding(one);
  }
  for (const bus::InverterReport& inverter : report.inverters)
  {
    status(inverter.status);
    values(inverter.values);
    for (const bus::Finding& one : inverter.findings)
    {
      finding(one);
    }
  }
}

void Digest::unconfirmed(const std::string& text)
{
  texts_.text(text);
}

std::string Digest::text() const
{
  char text[64];
  std::snprintf(text, sizeof text, "%016llx %016llx %016llx", static_cast<unsigned long long>(frames_.value()),
                static_cast<unsigned long long>(decisions_.value()), static_cast<unsigned long long>(texts_.value()));
  return text;
}

void Digest::monitor(const drive::Monitor& monitor)
{
  std::apply([this](const auto&... field) { (decisions_.field(field), ...); }, drive::monitorFields(monitor));
}

void Digest::status(const bus::InverterStatus& status)
{
  decisions_.number(status.index);
  decisions_.time(status.has_stamp ? status.stamp : TimePoint());
  monitor(status.monitor);
  for (const bool flag : { status.run_command, status.communication_error, status.refuses, status.move_velocity_active,
                           status.reset_active, status.stop_active, status.locked })
  {
    decisions_.number(flag ? 1 : 0);
  }
  decisions_.number(status.error_id);
  decisions_.real(status.commanded_velocity);
  texts_.text(status.model);
  texts_.text(status.error_text);
}

void Digest::busStatus(const bus::BusStatus& status)
{
  for (const bool flag : { status.connected, status.busy, status.error })
  {
    decisions_.number(flag ? 1 : 0);
  }
  decisions_.number(status.node);
  decisions_.number(status.error_id);
  for (const std::uint64_t counter :
       { status.counters.requests, status.counters.replies, status.counters.timeouts, status.counters.corrupt_replies,
         status.counters.exceptions, status.counters.late_replies, status.reconnects })
  {
    decisions_.number(counter);
  }
  for (const double value : { status.cycle_time, status.utilization, status.efficiency, status.stop_latency_max })
  {
    decisions_.real(value);
  }
  decisions_.number(status.offline_nodes.size());
  decisions_.bytes(status.offline_nodes.data(), status.offline_nodes.size());
}

void Digest::record(const drive::FaultRecord& record)
{
  decisions_.number(record.code);
  for (const auto& value :
       { record.output_frequency, record.output_current, record.dc_voltage, record.run_hours, record.power_on_hours })
  {
    decisions_.field(value);
  }
  texts_.text(record.text);
}

void Digest::finding(const bus::Finding& finding)
{
  decisions_.number(static_cast<std::uint64_t>(finding.level));
  texts_.text(finding.text);
}
}  // namespace fuzz
}  // namespace inverter_bus

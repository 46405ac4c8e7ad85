// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <utility>

#include "bus/coordinator.h"

// The doors to the activities: what users ask for, what happens to the port, and what the bus reports.

namespace inverter_bus
{
namespace bus
{
// --- requests of users -----------------------------------------------------------------------------------------------

std::uint16_t Coordinator::command(TimePoint now, const VelocityCommand& command)
{
  bus_.outbox.at(now);
  const std::uint16_t error_id = activities_.velocities.command(now, command);
  activities_.trace.commanded(command, error_id);
  return error_id;
}

bool Coordinator::stops(std::size_t index, double velocity) const
{
  return bus_.inverters[index]->movement.range().stops(velocity);
}

void Coordinator::refuse(TimePoint now, const std::vector<std::size_t>& indices, std::uint16_t error_id,
                         const std::string& text, bool group)
{
  bus_.outbox.at(now);
  activities_.trace.refused(text, error_id);
  activities_.velocities.refuse(now, indices, error_id, text, group);
}

void Coordinator::stop(TimePoint now, std::optional<std::size_t> index, std::uint8_t mode, AnswerCallback callback)
{
  bus_.outbox.at(now);
  activities_.trace.called("stop", index);
  activities_.stops.stop(now, index, mode, std::move(callback));
}

void Coordinator::reset(TimePoint now, std::size_t index, AnswerCallback callback)
{
  bus_.outbox.at(now);
  activities_.trace.called("reset", index);
  activities_.services.reset(now, index, std::move(callback));
}

void Coordinator::readFaults(TimePoint now, std::size_t index, AnswerCallback callback)
{
  bus_.outbox.at(now);
  activities_.trace.called("read_faults", index);
  activities_.services.readFaults(now, index, std::move(callback));
}

void Coordinator::readParameter(TimePoint now, std::size_t index, const std::string& name, AnswerCallback callback)
{
  bus_.outbox.at(now);
  activities_.trace.called("read_parameter", index);
  activities_.services.readParameter(now, index, name, std::move(callback));
}

void Coordinator::writeParameter(TimePoint now, std::size_t index, const std::string& name, double value, bool persist,
                                 AnswerCallback callback)
{
  bus_.outbox.at(now);
  activities_.trace.called("write_parameter", index);
  activities_.services.writeParameter(now, index, name, value, persist, std::move(callback));
}

// --- the line --------------------------------------------------------------------------------------------------------

void Coordinator::lateReply(TimePoint now, const wire::LateReply& late)
{
  bus_.outbox.at(now);
  activities_.probes.lateReply(now, late);
}

void Coordinator::noteLine(TimePoint now, const LineFacts& facts)
{
  bus_.line_watch.note(now, facts);
}

void Coordinator::noteAdapter(const std::optional<wire::AdapterLatency>& latency)
{
  activities_.reports.noteAdapter(latency);
  activities_.waits.noteAdapter(latency ? latency->latency : Duration{ 0 });
}

bool Coordinator::stopWaits(TimePoint now)
{
  bus_.outbox.at(now);
  return activities_.waits.stopWaits(now, in_flight_);
}

// --- the port --------------------------------------------------------------------------------------------------------

void Coordinator::portOpened(TimePoint now)
{
  bus_.outbox.at(now);
  activities_.port.opened(now);
}

void Coordinator::portMissing(TimePoint now, const std::string& error, bool in_use)
{
  bus_.outbox.at(now);
  activities_.port.missing(now, error, in_use);
}

void Coordinator::portPending(TimePoint now)
{
  bus_.outbox.at(now);
  activities_.port.pending(now);
}

void Coordinator::portClosed(TimePoint now)
{
  bus_.outbox.at(now);
  activities_.port.closed(now);
}

TimePoint Coordinator::openNotBefore() const
{
  return bus_.connection.openNotBefore();
}

bool Coordinator::resuming() const
{
  return bus_.connection.resuming();
}

bool Coordinator::renewalDue(TimePoint now)
{
  noteRunning(now);
  return activities_.checks.renewalDue(now);
}

void Coordinator::renewing(TimePoint now)
{
  bus_.outbox.at(now);
  activities_.port.renewing(now);
}

void Coordinator::reopening(TimePoint now)
{
  bus_.outbox.at(now);
  activities_.port.reopening(now);
}

bool Coordinator::telnetOver(TimePoint now)
{
  return activities_.telnet.over(now);
}

void Coordinator::closedForTelnet(TimePoint now)
{
  bus_.outbox.at(now);
  activities_.port.closedForTelnet(now);
}

// --- shutdown --------------------------------------------------------------------------------------------------------

void Coordinator::beginShutdown(TimePoint now)
{
  bus_.outbox.at(now);
  activities_.shutdown.begin(now);
}

bool Coordinator::shutdownDone(TimePoint now)
{
  return activities_.shutdown.done(now);
}

std::vector<std::string> Coordinator::endShutdown()
{
  return activities_.shutdown.end();
}

// --- what it reports ------------------------------------------------------------------------------------------------

Outputs Coordinator::takeOutputs()
{
  return bus_.outbox.takeOutputs();
}

PendingAnswers Coordinator::takeAnswers()
{
  return bus_.outbox.takeAnswers();
}

Report Coordinator::report(TimePoint now) const
{
  return activities_.reports.report(now);
}

ServiceBounds Coordinator::bounds() const
{
  return serviceBounds(bus_);
}

std::vector<Finding> Coordinator::budget() const
{
  return bus_.budget.findings;
}
}  // namespace bus
}  // namespace inverter_bus

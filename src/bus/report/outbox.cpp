// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/report/outbox.h"

#include "bus/report/inverter_report.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr std::size_t MOST_EVENTS = 2048;
}  // namespace

Outbox::Outbox(std::size_t inverters) : published_(inverters)
{
}

void Outbox::at(TimePoint now)
{
  now_ = now;
}

void Outbox::event(const std::string& text)
{
  // More in one turn of the bus than are kept at all: a flood must not fill the memory.
  if (outputs_.events.size() < MOST_EVENTS)
  {
    outputs_.events.push_back(traceEvent(now_, text));
  }
}

void Outbox::log(Level level, const std::string& text, const std::string& subject)
{
  outputs_.log.push_back({ level, text, subject });
  event(text);
}

void Outbox::publish(TimePoint now, const Inverter& inverter)
{
  outputs_.statuses.push_back(statusOf(inverter, now));
  Published& last = published_[inverter.index];
  last.at = now;
  const bool locked = outputs_.statuses.back().locked;
  if (locked != last.locked)
  {
    last.locked = locked;
    event(inverter.config.name + (locked ? ": is locked" : ": is no longer locked"));
  }
}

void Outbox::busStatus(const BusStatus& status)
{
  outputs_.bus_statuses.push_back(status);
}

void Outbox::trace(const std::string& reason)
{
  outputs_.traces.push_back(reason);
}

void Outbox::answer(const AnswerCallback& callback, const Answer& answer)
{
  if (callback)
  {
    answers_.emplace_back(callback, answer);
  }
}

void Outbox::refuse(const AnswerCallback& callback, std::uint16_t error_id, const std::string& message)
{
  Answer refused;
  refused.error_id = error_id;
  refused.message = message;
  answer(callback, refused);
}

TimePoint Outbox::lastPublished(std::size_t inverter) const
{
  return published_[inverter].at;
}

Outputs Outbox::takeOutputs()
{
  Outputs outputs;
  std::swap(outputs, outputs_);
  return outputs;
}

PendingAnswers Outbox::takeAnswers()
{
  PendingAnswers answers;
  std::swap(answers, answers_);
  return answers;
}
}  // namespace bus
}  // namespace inverter_bus

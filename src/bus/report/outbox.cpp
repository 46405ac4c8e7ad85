// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/report/outbox.h"

#include "bus/report/inverter_report.h"

namespace inverter_bus
{
namespace bus
{
Outbox::Outbox(std::size_t inverters) : last_published_(inverters)
{
}

void Outbox::log(Level level, const std::string& text, const std::string& subject)
{
  outputs_.log.push_back({ level, text, subject });
}

void Outbox::publish(TimePoint now, const Inverter& inverter)
{
  outputs_.statuses.push_back(statusOf(inverter, now));
  last_published_[inverter.index] = now;
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
  return last_published_[inverter];
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

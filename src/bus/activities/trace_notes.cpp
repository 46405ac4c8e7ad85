// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/trace_notes.h"

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
const char* textOf(const InFlight& current)
{
  if (current.resync)
  {
    return "a loop-back";
  }
  switch (current.pick.what)
  {
    case Pick::What::Stop:
    case Pick::What::Broadcast:
      return "a stop";
    case Pick::What::Velocity:
      return "a velocity";
    case Pick::What::Service:
      return "a service";
    case Pick::What::Connect:
    case Pick::What::Setting:
      return "a setting's read or write";
    case Pick::What::Release:
      return "the release";
    case Pick::What::Probe:
      return "a probe";
    case Pick::What::Refresh:
    case Pick::What::KeepAlive:
    case Pick::What::Nothing:
      break;
  }
  return "a status read";
}
}  // namespace

TraceNotes::TraceNotes(BusState& bus) : bus_(bus), commands_(bus.inverters.size()), lost_(bus.inverters.size())
{
}

std::string TraceNotes::nameOf(std::size_t index) const
{
  return bus_.inverters[index]->config.name;
}

void TraceNotes::note(Last& last, const std::string& words)
{
  // No more than is kept of it: a message may have any length.
  const std::string text = words.substr(0, sizeof(TraceEvent::text));
  if (text == last.text)
  {
    ++last.repeats;
    return;
  }
  if (last.repeats > 0)
  {
    bus_.outbox.event(std::to_string(last.repeats) + " more times: " + last.text);
  }
  last = { text, 0 };
  bus_.outbox.event(text);
}

void TraceNotes::commanded(const VelocityCommand& command, std::uint16_t error_id)
{
  if (command.targets.empty())
  {
    return;
  }
  std::string text = error_id == 0 ? "accepted:" : "refused (" + errorIdText(error_id) + "):";
  for (const auto& target : command.targets)
  {
    text += " " + nameOf(target.first) + " " + util::numberText(target.second);
  }
  note(commands_[command.targets.front().first], text + " from " + command.publisher.name);
}

void TraceNotes::refused(const std::string& text, std::uint16_t error_id)
{
  note(malformed_, "refused (" + errorIdText(error_id) + "): " + text);
}

void TraceNotes::called(const std::string& service, std::optional<std::size_t> index)
{
  bus_.outbox.event((index ? nameOf(*index) : std::string("all")) + ": " + service + " was called");
}

void TraceNotes::sent(const InFlight& current)
{
  wire::Bytes& lost = lost_[current.inverter];
  if (!lost.empty() && current.pick.what != Pick::What::Broadcast && lost == current.request.pdu)
  {
    bus_.outbox.event(nameOf(current.inverter) + ": " + textOf(current) + " is tried again");
  }
}

void TraceNotes::ended(const InFlight& current, const wire::Reply& reply)
{
  if (current.pick.what == Pick::What::Broadcast)
  {
    return;
  }
  // A loop-back comes between a lost request and its repeat.
  wire::Bytes& lost = lost_[current.inverter];
  lost = current.resync ? lost : wire::Bytes();
  if (isAnswered(reply) || !current.request.expects_reply || current.pick.what == Pick::What::Probe)
  {
    return;
  }
  lost = current.resync ? lost : current.request.pdu;
  if (reply.cut)
  {
    bus_.outbox.event(nameOf(current.inverter) + ": a stop has cut the wait for the reply to " + textOf(current));
    return;
  }
  const bool damaged = reply.outcome == wire::Outcome::Damaged;
  const bool gone = reply.outcome == wire::Outcome::PortLost;
  bus_.outbox.event(nameOf(current.inverter) + ": " +
                    (damaged ? "damaged" : (gone ? "the port was lost before the" : "no")) + " reply to " +
                    textOf(current));
}
}  // namespace bus
}  // namespace inverter_bus

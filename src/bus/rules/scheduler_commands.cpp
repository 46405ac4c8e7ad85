// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>
#include <tuple>

#include "bus/rules/scheduler.h"

// Which commands wait, and in which order. Who goes next of all stands in scheduler.cpp.

namespace inverter_bus
{
namespace bus
{
// --- commands --------------------------------------------------------------------------------------------------------

std::deque<Scheduler::Ticket>::iterator Scheduler::find(CommandId id)
{
  return std::find_if(tickets_.begin(), tickets_.end(), [&](const Ticket& ticket) { return ticket.command.id == id; });
}

void Scheduler::push(const WaitingCommand& command)
{
  Ticket ticket;
  ticket.command = command;
  ticket.epoch = epoch_;
  ticket.sequence = ++sequence_;
  if (command.kind == CommandKind::Velocity)
  {
    for (const std::size_t inverter : command.inverters)
    {
      for (const Ticket& other : tickets_)
      {
        const auto& members = other.command.inverters;
        if (other.command.kind != CommandKind::Velocity ||
            std::find(members.begin(), members.end(), inverter) == members.end())
        {
          continue;
        }
        ticket.epoch = other.begun ? ticket.epoch : std::min(ticket.epoch, other.epoch);
        ticket.sequence = other.begun ? ticket.sequence : std::min(ticket.sequence, other.sequence);
        // Groups that follow each other faster than a frame takes must not give the turn to the same member each time.
        ticket.served = other.served ? other.served : ticket.served;
      }
      eraseVelocity(inverter);
    }
  }
  tickets_.push_back(ticket);
}

void Scheduler::erase(CommandId id)
{
  const auto found = find(id);
  if (found != tickets_.end())
  {
    tickets_.erase(found);
  }
}

void Scheduler::eraseVelocity(std::size_t inverter)
{
  for (auto ticket = tickets_.begin(); ticket != tickets_.end();)
  {
    auto& members = ticket->command.inverters;
    if (ticket->command.kind == CommandKind::Velocity)
    {
      members.erase(std::remove(members.begin(), members.end(), inverter), members.end());
    }
    ticket = members.empty() ? tickets_.erase(ticket) : ticket + 1;
  }
}

void Scheduler::makeUrgent(std::size_t inverter, bool urgent)
{
  for (Ticket& ticket : tickets_)
  {
    const auto& members = ticket.command.inverters;
    if (ticket.command.kind == CommandKind::Velocity &&
        std::find(members.begin(), members.end(), inverter) != members.end())
    {
      // What is left of a group may have another 0 in it.
      ticket.command.urgent = urgent || (members.size() > 1 && ticket.command.urgent);
    }
  }
}

void Scheduler::postpone(CommandId id, TimePoint not_before)
{
  const auto found = find(id);
  if (found != tickets_.end())
  {
    found->command.not_before = not_before;
  }
}

void Scheduler::splitOff(CommandId group, std::size_t inverter, CommandId own, TimePoint not_before, bool urgent)
{
  const auto found = find(group);
  if (found == tickets_.end() || found->command.inverters.size() == 1)
  {
    postpone(group, not_before);
    return;
  }
  auto& members = found->command.inverters;
  members.erase(std::remove(members.begin(), members.end(), inverter), members.end());
  Ticket alone = *found;
  alone.command.id = own;
  alone.command.inverters = { inverter };
  alone.command.not_before = not_before;
  alone.command.urgent = urgent;
  tickets_.push_back(alone);
}

bool Scheduler::velocityWaits(std::size_t inverter) const
{
  return std::any_of(tickets_.begin(), tickets_.end(), [&](const Ticket& ticket) {
    const auto& members = ticket.command.inverters;
    return ticket.command.kind == CommandKind::Velocity &&
           std::find(members.begin(), members.end(), inverter) != members.end();
  });
}

std::vector<std::size_t> Scheduler::members(CommandId id) const
{
  const auto found =
      std::find_if(tickets_.begin(), tickets_.end(), [&](const Ticket& ticket) { return ticket.command.id == id; });
  return found == tickets_.end() ? std::vector<std::size_t>() : found->command.inverters;
}

void Scheduler::readSoon(std::size_t inverter)
{
  if (std::find(read_soon_.begin(), read_soon_.end(), inverter) == read_soon_.end())
  {
    read_soon_.push_back(inverter);
  }
}

void Scheduler::turnSoon(std::size_t inverter)
{
  if (!isPutOff(inverter))
  {
    put_off_.push_back(inverter);
  }
}

std::size_t Scheduler::readyCommands(TimePoint now) const
{
  return static_cast<std::size_t>(
      std::count_if(tickets_.begin(), tickets_.end(), [&](const Ticket& ticket) { return ready(ticket, now); }));
}

bool Scheduler::ready(const Ticket& ticket, TimePoint now) const
{
  const bool behind_stop =
      ticket.command.kind != CommandKind::Velocity && stop_pending_[ticket.command.inverters.front()];
  return ticket.command.not_before <= now && !behind_stop;
}

/// The member of a velocity whose frame is next: they take turns, and nobody comes twice while another one can.
std::size_t Scheduler::nextMember(const Ticket& ticket) const
{
  const auto& members = ticket.command.inverters;
  const auto after = [&members](std::size_t inverter) {
    const auto next = std::upper_bound(members.begin(), members.end(), inverter);
    return next == members.end() ? members.front() : *next;
  };
  const std::size_t next = ticket.served ? after(*ticket.served) : members.front();
  const bool again = next == avoided_ || (ticket.begun && next == last_inverter_);
  return again ? after(next) : next;
}

/// Rule 3.4: a velocity that came together with one that is under way is part of what is under way.
bool Scheduler::startsTogether(const Ticket& ticket, TimePoint now) const
{
  return ticket.command.kind == CommandKind::Velocity &&
         std::any_of(tickets_.begin(), tickets_.end(), [&](const Ticket& other) {
           return other.begun && other.epoch == ticket.epoch && ready(other, now);
         });
}

/// Units under way first, but not the inverter that had the last exchange while another one waits.
int Scheduler::rank(const Ticket& ticket, TimePoint now, bool one_goes_on) const
{
  const bool again = nextMember(ticket) == last_inverter_;
  if (ticket.begun || startsTogether(ticket, now))
  {
    return again ? 2 : 0;
  }
  return one_goes_on && again ? 3 : 1;
}

const Scheduler::Ticket* Scheduler::firstReady(TimePoint now, bool urgent_only) const
{
  const bool one_goes_on = std::any_of(tickets_.begin(), tickets_.end(), [&](const Ticket& ticket) {
    return ticket.begun && ready(ticket, now) && nextMember(ticket) == last_inverter_;
  });
  const auto key = [&](const Ticket& ticket) {
    return std::make_tuple(!ticket.command.urgent, rank(ticket, now, one_goes_on), ticket.epoch, ticket.command.kind,
                           ticket.frames, ticket.command.inverters.front(), ticket.sequence);
  };
  const Ticket* first = nullptr;
  for (const Ticket& ticket : tickets_)
  {
    const bool eligible =
        ready(ticket, now) && (ticket.command.urgent || !urgent_only) && nextMember(ticket) != avoided_;
    if (eligible && (first == nullptr || key(ticket) < key(*first)))
    {
      first = &ticket;
    }
  }
  return first;
}

}  // namespace bus
}  // namespace inverter_bus

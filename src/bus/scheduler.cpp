// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/bus/scheduler.h"

#include <algorithm>
#include <tuple>

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, rule 3.3: three attempts at once, then every second exchange at most.
constexpr unsigned STOP_ATTEMPTS_AT_ONCE = 3;
// A flood of stops: after so many exchanges, a read-back or a needless stop alternates with exchanges of another kind.
constexpr unsigned MOST_STOPS_IN_A_ROW = 8;
// Other exchanges between two frames of a stop that insists.
constexpr std::uint64_t INSISTING_SPACING = 1;
// Rule 3.14: the lowest class gets at least every eighth exchange.
constexpr unsigned EXCHANGES_PER_BACKGROUND = 8;
// A lone command goes at once (rule 3.6); a flood of them, each arriving during the one before, lets a refresh through.
constexpr unsigned LONE_COMMANDS_IN_A_ROW = 3;
constexpr double LONGEST_SLEEP_S = 0.25;
// Contract, 8.8: each offline inverter at most so often.
constexpr double PROBE_PERIOD_S = 0.5;
}  // namespace

Scheduler::Scheduler(const Settings& settings)
  : settings_(settings)
  , stop_pending_(settings.inverters, false)
  , last_stop_exchange_(settings.inverters, 0)
  , silent_at_deadline_(settings.inverters, 0)
  , last_probe_(settings.inverters)
{
}

// --- commands --------------------------------------------------------------------------------------------------------

std::deque<Scheduler::Ticket>::iterator Scheduler::find(CommandId id)
{
  return std::find_if(tickets_.begin(), tickets_.end(), [&](const Ticket& ticket) { return ticket.command.id == id; });
}

void Scheduler::push(const WaitingCommand& command)
{
  Ticket ticket{ command, epoch_, ++sequence_ };
  if (command.kind == CommandKind::Velocity)
  {
    for (const std::size_t inverter : command.inverters)
    {
      for (const Ticket& other : tickets_)
      {
        const auto& members = other.command.inverters;
        if (other.command.kind == CommandKind::Velocity && other.command.id != unit_ &&
            std::find(members.begin(), members.end(), inverter) != members.end())
        {
          ticket.epoch = std::min(ticket.epoch, other.epoch);
          ticket.sequence = std::min(ticket.sequence, other.sequence);
        }
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
  endUnit(id);
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
    if (members.empty())
    {
      endUnit(ticket->command.id);
      ticket = tickets_.erase(ticket);
    }
    else
    {
      ++ticket;
    }
  }
}

void Scheduler::makeUrgent(std::size_t inverter)
{
  for (Ticket& ticket : tickets_)
  {
    const auto& members = ticket.command.inverters;
    if (ticket.command.kind == CommandKind::Velocity &&
        std::find(members.begin(), members.end(), inverter) != members.end())
    {
      ticket.command.urgent = true;
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

void Scheduler::endUnit(CommandId id)
{
  if (unit_ == id)
  {
    unit_ = 0;
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

const Scheduler::Ticket* Scheduler::firstReady(TimePoint now, bool urgent_only) const
{
  const auto key = [](const Ticket& ticket) {
    return std::make_tuple(!ticket.command.urgent, ticket.epoch, ticket.command.kind, ticket.command.inverters.front(),
                           ticket.sequence);
  };
  const Ticket* first = nullptr;
  for (const Ticket& ticket : tickets_)
  {
    const bool eligible = ready(ticket, now) && (ticket.command.urgent || !urgent_only);
    if (eligible && (first == nullptr || key(ticket) < key(*first)))
    {
      first = &ticket;
    }
  }
  return first;
}

// --- decisions -------------------------------------------------------------------------------------------------------

Pick Scheduler::next(TimePoint now, const std::vector<InverterView>& views, const Gate& gate)
{
  bare_probes_ = gate.bare_probes;
  for (std::size_t index = 0; index < views.size(); ++index)
  {
    stop_pending_[index] = views[index].stop_pending;
  }
  if (half_refreshed_ && views[*half_refreshed_].offline)
  {
    half_refreshed_.reset();
  }
  Pick pick = gate.stops_only ? chooseBehindGateway(now, views, gate) : choose(now, views);
  if (pick.what == Pick::What::Nothing)
  {
    return pick;
  }
  ++epoch_;
  // The further reads of a refresh that a deadline began are part of it: they don't count, and they don't end the row.
  const bool goes_on = pick.what == Pick::What::Refresh && half_refreshed_ == pick.inverter;
  deadlines_in_a_row_ = pick.deadline ? deadlines_in_a_row_ + 1 : goes_on ? deadlines_in_a_row_ : 0;
  const bool stop = pick.what == Pick::What::Stop;
  stops_in_a_row_ = stop ? stops_in_a_row_ + 1 : let_through_ ? stops_in_a_row_ : 0;
  if (stop)
  {
    bookStop(pick, views);
  }
  return pick;
}

Pick Scheduler::choose(TimePoint now, const std::vector<InverterView>& views)
{
  if (auto stop = pickStop(now, views, false))
  {
    // Who stops again and again must not blind the driver: not the write of a stop that takes RUN off, but its read-back
    // and one that only repeats it let another exchange through.
    const InverterView& view = views[stop->inverter];
    const bool may_wait = view.stop_written || view.stop_repeats;
    const bool gives_way = may_wait && !let_through_ && stops_in_a_row_ >= MOST_STOPS_IN_A_ROW;
    const auto other = gives_way ? chooseBehindStops(now, views) : std::nullopt;
    let_through_ = other.has_value();
    return other ? *other : *stop;
  }
  let_through_ = false;
  if (auto urgent = pickCommand(now, true))
  {
    return *urgent;
  }
  if (auto other = chooseBehindStops(now, views))
  {
    return *other;
  }
  // A live drive's stop that insists lets something else through; if there is nothing else, it goes on.
  if (auto stop = pickStop(now, views, true))
  {
    return *stop;
  }
  const auto late = pickDeadline(now, views);
  return late ? *late : nothing(now, views);
}

/// The gateway still works on a request that was lost: whatever follows it would wait in there.
Pick Scheduler::chooseBehindGateway(TimePoint now, const std::vector<InverterView>& views, const Gate& gate)
{
  if (const auto stop = pickStop(now, views, true))
  {
    return *stop;
  }
  if (const auto deadline = pickDeadline(now, views))
  {
    return *deadline;
  }
  Pick pick = nothing(now, views);
  pick.wake = gate.until > now ? std::min(pick.wake, gate.until) : pick.wake;
  return pick;
}

/// Everything but stops and what wants to stop.
std::optional<Pick> Scheduler::chooseBehindStops(TimePoint now, const std::vector<InverterView>& views)
{
  const auto unit = find(unit_);
  if (unit != tickets_.end() && unit->command.not_before <= now)
  {
    Pick pick;
    pick.what = Pick::What::Command;
    pick.command = unit_;
    return pick;
  }
  if (half_refreshed_ && views[*half_refreshed_].refresh_not_before <= now)
  {
    // The words of one status belong together.
    Pick pick;
    pick.what = Pick::What::Refresh;
    pick.inverter = *half_refreshed_;
    return pick;
  }
  // Time-outs that can't be met must not take the bus from everything else.
  const auto supervised = static_cast<unsigned>(std::count_if(
      views.begin(), views.end(), [](const InverterView& view) { return view.serve_by && !view.offline; }));
  const auto deadline = deadlines_in_a_row_ < supervised ? pickDeadline(now, views) : std::nullopt;
  if (deadline)
  {
    return deadline;
  }
  const auto background = pickBackground(views);
  if (background && exchanges_without_background_ + 1 >= EXCHANGES_PER_BACKGROUND)
  {
    return background;
  }
  const auto probe = pickProbe(now, views);
  if (probe && probe->what == Pick::What::Stop)
  {
    return probe;
  }
  if (auto command = pickCommand(now, false))
  {
    const bool give_way =
        commands_in_a_row_ > 0 && (readyCommands(now) > 1 || commands_in_a_row_ >= LONE_COMMANDS_IN_A_ROW);
    if (give_way && probe)
    {
      return probe;
    }
    const auto refresh = give_way ? pickRefresh(now, views) : std::nullopt;
    return refresh ? refresh : command;
  }
  if (probe)
  {
    return probe;
  }
  const auto refresh = pickRefresh(now, views);
  return refresh ? refresh : background;
}

std::optional<Pick> Scheduler::pickStop(TimePoint now, const std::vector<InverterView>& views, bool nothing_else) const
{
  using Key = std::tuple<bool, unsigned, bool, std::uint64_t, std::size_t>;
  std::optional<Key> best;
  for (std::size_t index = 0; index < views.size(); ++index)
  {
    const InverterView& view = views[index];
    // An offline inverter's stop is tried once at once; then it is that inverter's probe.
    const bool at_once = view.offline ? view.stop_attempts == 0 : view.stop_attempts < STOP_ATTEMPTS_AT_ONCE;
    const bool spaced = exchanges_ - last_insisting_exchange_ >= INSISTING_SPACING || last_insisting_exchange_ == 0;
    const bool insisting = !view.offline && (spaced || nothing_else);
    if (!view.stop_pending || view.stop_not_before > now || !(at_once || insisting))
    {
      continue;
    }
    const Key key(view.offline, view.stop_attempts, view.stop_written, last_stop_exchange_[index], index);
    if (!best || key < *best)
    {
      best = key;
    }
  }
  if (!best)
  {
    return std::nullopt;
  }
  Pick pick;
  pick.what = Pick::What::Stop;
  pick.inverter = std::get<4>(*best);
  pick.probe = std::get<0>(*best);
  return pick;
}

void Scheduler::bookStop(const Pick& pick, const std::vector<InverterView>& views)
{
  last_stop_exchange_[pick.inverter] = exchanges_ + 1;
  if (views[pick.inverter].stop_attempts + 1 >= STOP_ATTEMPTS_AT_ONCE)
  {
    last_insisting_exchange_ = exchanges_ + 1;
  }
}

std::optional<Pick> Scheduler::pickCommand(TimePoint now, bool urgent_only) const
{
  const Ticket* ticket = firstReady(now, urgent_only);
  if (ticket == nullptr)
  {
    return std::nullopt;
  }
  Pick pick;
  pick.what = Pick::What::Command;
  pick.command = ticket->command.id;
  return pick;
}

std::optional<Pick> Scheduler::pickDeadline(TimePoint now, const std::vector<InverterView>& views)
{
  // One that did not answer when its time came lets the others go before it is tried again; several such take turns, since
  // the time of one that never answers never moves.
  const auto key = [&](std::size_t index) {
    return std::make_tuple(silent_at_deadline_[index], *views[index].serve_by);
  };
  std::optional<std::size_t> most_urgent;
  for (std::size_t index = 0; index < views.size(); ++index)
  {
    const InverterView& view = views[index];
    const bool due = view.serve_by && *view.serve_by <= now && view.refresh_not_before <= now;
    if (view.offline || !due || view.refresh_unanswered)
    {
      continue;
    }
    if (!most_urgent || key(index) < key(*most_urgent))
    {
      most_urgent = index;
    }
  }
  if (!most_urgent)
  {
    return std::nullopt;
  }
  pause_cut_ = pause_cut_ || now < pause_until_;
  Pick pick;
  pick.what = Pick::What::Refresh;
  pick.inverter = *most_urgent;
  pick.deadline = true;
  return pick;
}

std::optional<Pick> Scheduler::pickProbe(TimePoint now, const std::vector<InverterView>& views) const
{
  if (now < next_probe_)
  {
    return std::nullopt;
  }
  for (std::size_t step = 0; step < views.size(); ++step)
  {
    const std::size_t index = (probe_cursor_ + step) % views.size();
    if (mayProbe(now, views[index], index))
    {
      Pick pick;
      pick.what = views[index].stop_pending ? Pick::What::Stop : Pick::What::Probe;
      pick.inverter = index;
      pick.probe = true;
      return pick;
    }
  }
  return std::nullopt;
}

bool Scheduler::mayProbe(TimePoint now, const InverterView& view, std::size_t index) const
{
  const bool rested = last_probe_[index] == TimePoint() || now - last_probe_[index] >= seconds(PROBE_PERIOD_S);
  const bool allowed = view.stop_pending ? view.stop_not_before <= now : bare_probes_;
  return view.offline && view.refresh_not_before <= now && rested && allowed;
}

bool Scheduler::takesPart(const InverterView& view) const
{
  return !view.offline && (!view.at_rest || rounds_ % settings_.idle_divisor == 0);
}

bool Scheduler::findNextOfCycle(TimePoint now, const std::vector<InverterView>& views)
{
  for (; cursor_ < views.size(); ++cursor_)
  {
    if (takesPart(views[cursor_]) && views[cursor_].refresh_not_before <= now)
    {
      return true;
    }
  }
  return false;
}

void Scheduler::closeCycle(TimePoint now)
{
  ++rounds_;
  cycle_open_ = false;
  if (refreshed_in_cycle_)
  {
    ++cycles_;
    cycle_time_ = now - cycle_start_;
    pause_until_ = now + settings_.interval;
  }
}

std::optional<Pick> Scheduler::pickRefresh(TimePoint now, const std::vector<InverterView>& views)
{
  // One round more than the divisor, so that a cycle without anybody cannot hide those at rest.
  for (unsigned round = 0; round <= settings_.idle_divisor; ++round)
  {
    if (now < pause_until_)
    {
      return std::nullopt;
    }
    if (!cycle_open_)
    {
      cycle_open_ = true;
      cycle_start_ = now;
      refreshed_in_cycle_ = false;
      cursor_ = 0;
    }
    if (findNextOfCycle(now, views))
    {
      Pick pick;
      pick.what = Pick::What::Refresh;
      pick.inverter = cursor_;
      return pick;
    }
    closeCycle(now);
  }
  return std::nullopt;
}

std::optional<Pick> Scheduler::pickBackground(const std::vector<InverterView>& views) const
{
  for (std::size_t step = 0; step < views.size(); ++step)
  {
    const std::size_t index = (background_cursor_ + step) % views.size();
    if (views[index].background && !views[index].offline)
    {
      Pick pick;
      pick.what = Pick::What::Background;
      pick.inverter = index;
      return pick;
    }
  }
  return std::nullopt;
}

Pick Scheduler::nothing(TimePoint now, const std::vector<InverterView>& views) const
{
  Pick pick;
  pick.wake = now + seconds(LONGEST_SLEEP_S);
  const auto wakeAt = [&](TimePoint time) {
    if (time > now)
    {
      pick.wake = std::min(pick.wake, time);
    }
  };
  wakeAt(pause_until_);
  wakeAt(next_probe_);
  for (std::size_t index = 0; index < views.size(); ++index)
  {
    const InverterView& view = views[index];
    wakeAt(view.refresh_not_before);
    wakeAt(view.stop_pending ? view.stop_not_before : TimePoint());
    wakeAt(view.offline ? last_probe_[index] + seconds(PROBE_PERIOD_S) : TimePoint());
    if (view.serve_by)
    {
      wakeAt(*view.serve_by);
    }
  }
  for (const Ticket& ticket : tickets_)
  {
    wakeAt(ticket.command.not_before);
  }
  return pick;
}

void Scheduler::done(const Pick& pick, TimePoint start, TimePoint end, bool more, bool answered)
{
  ++exchanges_;
  ++exchanges_without_background_;
  if (pick.probe)
  {
    probe_cursor_ = pick.inverter + 1;
    last_probe_[pick.inverter] = end;
    chargeProbe(end, answered ? Duration::zero() : end - start);
  }
  switch (pick.what)
  {
    case Pick::What::Command:
    {
      const auto ticket = find(pick.command);
      if (ticket != tickets_.end() && more)
      {
        unit_ = ticket->command.kind == CommandKind::Velocity ? pick.command : unit_;
        break;
      }
      ++commands_in_a_row_;
      erase(pick.command);
      break;
    }
    case Pick::What::Refresh:
      commands_in_a_row_ = 0;
      if (cycle_open_ && pick.inverter == cursor_)
      {
        refreshed_in_cycle_ = true;
        cursor_ += more ? 0 : 1;
      }
      silent_at_deadline_[pick.inverter] = answered ? 0 : exchanges_;
      // A repeat has no right to the next exchange: another drive's time may come meanwhile.
      noteHalfRefresh(pick, more && answered);
      break;
    case Pick::What::Background:
      exchanges_without_background_ = 0;
      background_cursor_ = pick.inverter + 1;
      break;
    default:
      break;
  }
}

void Scheduler::chargeProbe(TimePoint now, Duration cost)
{
  next_probe_ = now + std::chrono::duration_cast<Duration>(cost * (1.0 / settings_.probe_share - 1.0));
}

void Scheduler::noteHalfRefresh(const Pick& pick, bool more)
{
  const bool by_deadline = pick.deadline || half_refreshed_ == pick.inverter;
  if (more && by_deadline)
  {
    half_refreshed_ = pick.inverter;
  }
  else
  {
    half_refreshed_.reset();
  }
}

// --- cycle -----------------------------------------------------------------------------------------------------------

std::uint64_t Scheduler::cycles() const
{
  return cycles_;
}

Duration Scheduler::cycleTime() const
{
  return cycle_time_;
}

bool Scheduler::pauseWasCut() const
{
  return pause_cut_;
}

std::uint64_t Scheduler::exchanges() const
{
  return exchanges_;
}

void Scheduler::restartCycle(TimePoint now, bool probes_at_once)
{
  cycle_open_ = false;
  pause_until_ = now;
  if (probes_at_once)
  {
    next_probe_ = now;
    std::fill(last_probe_.begin(), last_probe_.end(), TimePoint());
  }
}
}  // namespace bus
}  // namespace inverter_bus

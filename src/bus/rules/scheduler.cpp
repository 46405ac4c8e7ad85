// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/rules/scheduler.h"

#include <algorithm>
#include <tuple>

namespace inverter_bus
{
namespace bus
{
namespace
{
// A flood of stops: after so many exchanges, a read-back or a needless stop alternates with exchanges of another kind.
constexpr unsigned MOST_STOPS_IN_A_ROW = 8;
// Other exchanges between two frames of a stop that insists.
constexpr std::uint64_t INSISTING_SPACING = 1;
// A stop that was tried so often in vain leaves half of the time to the others: a drive that loses every write for hours,
// or a wire, must not make the driver blind for its neighbours.
constexpr unsigned STOP_ATTEMPTS_BEFORE_PATIENCE = 6;
// Rule 3.14: the lowest class gets at least every eighth exchange.
constexpr unsigned EXCHANGES_PER_BACKGROUND = 8;
// A lone command goes at once (rule 3.6); a flood of them, each arriving during the one before, lets a refresh through.
constexpr unsigned LONE_COMMANDS_IN_A_ROW = 3;
constexpr double LONGEST_SLEEP_S = 0.25;
// How soon it is noticed that a gateway has answered late, so that the others may go on.
constexpr double LATE_ANSWER_PERIOD_S = 0.02;
}  // namespace

Scheduler::Scheduler(const Settings& settings)
  : settings_(settings)
  , stop_pending_(settings.inverters, false)
  , last_stop_exchange_(settings.inverters, 0)
  , silent_at_deadline_(settings.inverters, 0)
  , probe_account_(settings.inverters, settings.probe_share)
{
}

// --- decisions -------------------------------------------------------------------------------------------------------

Pick Scheduler::next(TimePoint now, const std::vector<InverterView>& views, const Gate& gate)
{
  bare_probes_ = gate.bare_probes;
  for (std::size_t index = 0; index < views.size(); ++index)
  {
    stop_pending_[index] = views[index].stop_pending;
  }
  forgetOffline(views);
  Pick pick = gate.stops_only ? chooseBehindGateway(now, views, gate) : choose(now, views);
  if (pick.what == Pick::What::Nothing)
  {
    return pick;
  }
  ++epoch_;
  if (pick.isCommand())
  {
    find(pick.command)->served = pick.inverter;
  }
  // The further reads of a refresh that a deadline began are part of it: they don't count, and they don't end the row.
  const bool goes_on = pick.what == Pick::What::Refresh && std::find(half_refreshed_.begin(), half_refreshed_.end(),
                                                                     pick.inverter) != half_refreshed_.end();
  const bool stop = pick.what == Pick::What::Stop;
  // Nor does a stop: one that insists would otherwise leave every second exchange to deadlines for ever.
  deadlines_in_a_row_ = pick.deadline ? deadlines_in_a_row_ + 1 : goes_on || stop ? deadlines_in_a_row_ : 0;
  stops_in_a_row_ = stop ? stops_in_a_row_ + 1 : let_through_ ? stops_in_a_row_ : 0;
  if (stop)
  {
    bookStop(pick, views);
  }
  const bool settles = pick.what == Pick::What::Refresh && views[pick.inverter].connect_due;
  pick.what = settles ? Pick::What::Connect : pick.what;
  return pick;
}

void Scheduler::forgetOffline(const std::vector<InverterView>& views)
{
  for (auto* waiting : { &half_refreshed_, &put_off_, &read_soon_ })
  {
    waiting->erase(
        std::remove_if(waiting->begin(), waiting->end(), [&](std::size_t index) { return views[index].offline; }),
        waiting->end());
  }
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
  if (const auto stop = pickStop(now, views, !gate.others_wait))
  {
    return *stop;
  }
  if (const auto deadline = pickDeadline(now, views))
  {
    return *deadline;
  }
  Pick pick = nothing(now, views);
  pick.wake = gate.until > now ? std::min({ pick.wake, gate.until, now + seconds(LATE_ANSWER_PERIOD_S) }) : pick.wake;
  return pick;
}

/// Everything but stops and what wants to stop.
std::optional<Pick> Scheduler::chooseBehindStops(TimePoint now, const std::vector<InverterView>& views)
{
  if (const auto read = pickReadSoon(now, views))
  {
    return read;
  }
  if (last_lost_)
  {
    // Who did not answer has no right to the next exchange, whatever it is for.
    const auto other = chooseForAnother(now, views);
    return other ? other : chooseInTurn(now, views);
  }
  const auto going_on = chooseGoingOn(now, views);
  return going_on ? going_on : chooseInTurn(now, views);
}

/// Whether a drive is away decides over everybody's time.
std::optional<Pick> Scheduler::pickReadSoon(TimePoint now, const std::vector<InverterView>& views) const
{
  const auto soon = std::find_if(read_soon_.begin(), read_soon_.end(), [&](std::size_t index) {
    return index != last_inverter_ && views[index].refresh_not_before <= now;
  });
  if (soon == read_soon_.end())
  {
    return std::nullopt;
  }
  Pick pick;
  pick.what = Pick::What::Refresh;
  pick.inverter = *soon;
  return pick;
}

std::optional<Pick> Scheduler::chooseForAnother(TimePoint now, const std::vector<InverterView>& views)
{
  avoided_ = last_inverter_;
  const auto other = chooseInTurn(now, views);
  avoided_.reset();
  return other;
}

std::optional<Pick> Scheduler::chooseGoingOn(TimePoint now, const std::vector<InverterView>& views)
{
  const auto unit = goOnWithUnit(now, views);
  return unit ? unit : goOnWithRefresh(now, views);
}

/// Frames that belong together go back to back, but for another inverter's deadline, and in turns.
std::optional<Pick> Scheduler::goOnWithUnit(TimePoint now, const std::vector<InverterView>& views)
{
  const bool any = std::any_of(tickets_.begin(), tickets_.end(),
                               [&](const Ticket& ticket) { return ticket.begun && ready(ticket, now); });
  if (!any || commands_in_a_row_ > 0)
  {
    return std::nullopt;
  }
  avoided_ = last_inverter_;
  const auto deadline = deadlines_in_a_row_ == 0 ? pickDeadline(now, views) : std::nullopt;
  avoided_.reset();
  if (deadline)
  {
    return deadline;
  }
  const auto command = pickCommand(now, false);
  const bool another_one = command && command->command != last_command_;
  return another_one && backgroundIsDue(now, views) ? std::nullopt : command;
}

/// The words of one status belong together.
std::optional<Pick> Scheduler::goOnWithRefresh(TimePoint now, const std::vector<InverterView>& views)
{
  const auto half = std::find_if(half_refreshed_.begin(), half_refreshed_.end(),
                                 [&](std::size_t index) { return views[index].refresh_not_before <= now; });
  if (half == half_refreshed_.end())
  {
    return std::nullopt;
  }
  if (*half == last_inverter_)
  {
    avoided_ = last_inverter_;
    auto other = deadlinesMayGo(views) ? pickDeadline(now, views) : std::nullopt;
    // One refresh of a deadline may begin before the last one is over, for ever.
    other = !other && backgroundIsDue(now, views) ? backgroundInTurn(now, views) : other;
    const auto command = other ? std::nullopt : pickCommand(now, false);
    // Where deadlines never end, these are the only turns that commands and the refreshes of the others have.
    other = command && commandsGiveWay(now, views) ? pickRefresh(now, views) : other;
    other = other ? other : command;
    avoided_.reset();
    if (other)
    {
      return other;
    }
  }
  Pick pick;
  pick.what = Pick::What::Refresh;
  pick.inverter = *half;
  return pick;
}

/// Time-outs that can't be met must not take the bus from everything else.
bool Scheduler::deadlinesMayGo(const std::vector<InverterView>& views) const
{
  const auto supervised = static_cast<unsigned>(std::count_if(
      views.begin(), views.end(), [](const InverterView& view) { return view.serve_by && !view.offline; }));
  return deadlines_in_a_row_ < supervised;
}

/// One exchange earlier while commands wait: at the eighth it may be the turn of who had the last exchange.
bool Scheduler::backgroundIsDue(TimePoint now, const std::vector<InverterView>& views) const
{
  const auto background = pickBackground(views);
  const unsigned exchange = exchanges_without_background_ + 1;
  const bool early = exchange + 1 == EXCHANGES_PER_BACKGROUND && readyCommands(now) > 0;
  return background && (exchange >= EXCHANGES_PER_BACKGROUND || (early && background->inverter != last_inverter_));
}

/// The long jobs' turn, but not for who had the last exchange while another one waits.
std::optional<Pick> Scheduler::backgroundInTurn(TimePoint now, const std::vector<InverterView>& views)
{
  const auto background = pickBackground(views);
  if (!background || background->inverter != last_inverter_)
  {
    return background;
  }
  const auto avoided = avoided_;
  avoided_ = last_inverter_;
  const auto other = pickCommand(now, false);
  avoided_ = avoided;
  return other ? other : background;
}

/// Commands and refreshes take turns, whatever goes between them because its time has come.
bool Scheduler::commandsGiveWay(TimePoint now, const std::vector<InverterView>& views) const
{
  // A stop that insists between any two of them makes each one wait for long: then a lone command has company, too.
  const bool insisted = std::any_of(views.begin(), views.end(), [](const InverterView& view) {
    return view.stop_pending && !view.offline && view.stop_attempts >= STOP_ATTEMPTS_AT_ONCE;
  });
  return commands_since_turn_ > 0 &&
         (insisted || readyCommands(now) > 1 || commands_since_turn_ >= LONE_COMMANDS_IN_A_ROW);
}

std::optional<Pick> Scheduler::chooseInTurn(TimePoint now, const std::vector<InverterView>& views)
{
  const auto deadline = deadlinesMayGo(views) ? pickDeadline(now, views) : std::nullopt;
  if (deadline)
  {
    return deadline;
  }
  const auto background = pickBackground(views);
  if (backgroundIsDue(now, views))
  {
    return backgroundInTurn(now, views);
  }
  const auto probe = pickProbe(now, views);
  if (probe && probe->what == Pick::What::Stop)
  {
    return probe;
  }
  if (auto command = pickCommand(now, false))
  {
    const bool give_way = commandsGiveWay(now, views);
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
  using Key = std::tuple<bool, bool, unsigned, bool, std::uint64_t, std::size_t>;
  std::optional<Key> best;
  for (std::size_t index = 0; index < views.size(); ++index)
  {
    const InverterView& view = views[index];
    // An offline inverter's stop is tried once at once; then it is that inverter's probe.
    const bool at_once = view.offline ? view.stop_attempts == 0 : view.stop_attempts < STOP_ATTEMPTS_AT_ONCE;
    const bool spaced = exchanges_ - last_insisting_exchange_ >= INSISTING_SPACING || last_insisting_exchange_ == 0;
    const bool patient = view.stop_attempts >= STOP_ATTEMPTS_BEFORE_PATIENCE && now < patient_until_;
    const bool insisting = !view.offline && ((spaced && !patient) || nothing_else);
    if (!view.stop_pending || view.stop_not_before > now || !(at_once || insisting))
    {
      continue;
    }
    // One of a flood goes behind those that take RUN off, and behind their read-backs.
    const Key key(view.offline, view.stop_repeats, view.stop_attempts, view.stop_written, last_stop_exchange_[index],
                  index);
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
  pick.inverter = std::get<5>(*best);
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
  pick.what = ticket->command.kind == CommandKind::Velocity ? Pick::What::Velocity : Pick::What::Service;
  pick.command = ticket->command.id;
  pick.inverter = nextMember(*ticket);
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
    if (index == avoided_ || view.offline || !due || view.refresh_unanswered)
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
  if (now < probe_account_.opensAt())
  {
    return std::nullopt;
  }
  for (std::size_t step = 0; step < views.size(); ++step)
  {
    const std::size_t index = (probe_cursor_ + step) % views.size();
    if (index != avoided_ && mayProbe(now, views[index], index))
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
  const bool rested = probe_account_.opensAt(index) <= now;
  const bool allowed = view.stop_pending ? view.stop_not_before <= now : bare_probes_;
  return view.offline && view.refresh_not_before <= now && rested && allowed;
}

bool Scheduler::takesPart(const InverterView& view) const
{
  return !view.offline && (!view.at_rest || rounds_ % settings_.idle_divisor == 0);
}

bool Scheduler::isPutOff(std::size_t inverter) const
{
  return std::find(put_off_.begin(), put_off_.end(), inverter) != put_off_.end();
}

/// Whose turn it is in the open cycle; nobody: it is over.
std::optional<std::size_t> Scheduler::nextOfCycle(TimePoint now, const std::vector<InverterView>& views)
{
  for (; cursor_ < views.size(); ++cursor_)
  {
    if (!takesPart(views[cursor_]) || views[cursor_].refresh_not_before > now || isPutOff(cursor_))
    {
      continue;
    }
    if (cursor_ != avoided_)
    {
      return cursor_;
    }
    put_off_.push_back(cursor_);
  }
  return std::nullopt;
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
  const auto of_cycle = cycle_first_ ? pickOfCycle(now, views) : std::nullopt;
  const auto put_off = of_cycle ? of_cycle : pickPutOff(now, views);
  return put_off || cycle_first_ ? put_off : pickOfCycle(now, views);
}

std::optional<Pick> Scheduler::pickPutOff(TimePoint now, const std::vector<InverterView>& views) const
{
  const auto put_off = std::find_if(put_off_.begin(), put_off_.end(), [&](std::size_t index) {
    return index != avoided_ && views[index].refresh_not_before <= now;
  });
  if (put_off == put_off_.end())
  {
    return std::nullopt;
  }
  Pick pick;
  pick.what = Pick::What::Refresh;
  pick.inverter = *put_off;
  return pick;
}

std::optional<Pick> Scheduler::pickOfCycle(TimePoint now, const std::vector<InverterView>& views)
{
  Pick pick;
  pick.what = Pick::What::Refresh;
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
    if (const auto next = nextOfCycle(now, views))
    {
      pick.inverter = *next;
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
    if (index != avoided_ && views[index].background && !views[index].offline)
    {
      Pick pick;
      pick.what = Pick::What::Setting;
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
  const auto wake_at = [&](TimePoint time) {
    if (time > now)
    {
      pick.wake = std::min(pick.wake, time);
    }
  };
  wake_at(pause_until_);
  wake_at(probe_account_.opensAt());
  for (std::size_t index = 0; index < views.size(); ++index)
  {
    const InverterView& view = views[index];
    wake_at(view.refresh_not_before);
    wake_at(view.stop_pending ? view.stop_not_before : TimePoint());
    wake_at(view.offline ? probe_account_.opensAt(index) : TimePoint());
    if (view.serve_by)
    {
      wake_at(*view.serve_by);
    }
  }
  for (const Ticket& ticket : tickets_)
  {
    wake_at(ticket.command.not_before);
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
    probe_account_.ended(end, pick.inverter, answered ? Duration::zero() : end - start, pick.in_turn);
  }
  last_inverter_ = pick.what == Pick::What::Stop ? std::nullopt : std::optional<std::size_t>(pick.inverter);
  last_lost_ = last_inverter_ && !answered;
  if (pick.what == Pick::What::Stop)
  {
    patient_until_ = answered ? end : end + (end - start);
  }
  last_command_ = pick.isCommand() ? pick.command : 0;
  if (pick.isCommand())
  {
    doneCommand(pick, more);
  }
  else if (pick.inTurnOfRefresh())
  {
    doneRefresh(pick, more, answered);
  }
  else if (pick.what == Pick::What::Setting)
  {
    exchanges_without_background_ = 0;
    background_cursor_ = pick.inverter + 1;
  }
}

ProbeAccount& Scheduler::probeAccount()
{
  return probe_account_;
}

void Scheduler::doneCommand(const Pick& pick, bool more)
{
  const auto ticket = find(pick.command);
  const bool unit_goes_on = more && ticket != tickets_.end() && ticket->command.kind == CommandKind::Velocity;
  // Each frame of a long job is queued anew, and is a command of its own.
  commands_since_turn_ += unit_goes_on ? 0 : 1;
  if (ticket == tickets_.end() || !more)
  {
    ++commands_in_a_row_;
    erase(pick.command);
    return;
  }
  ticket->begun = ticket->command.kind == CommandKind::Velocity;
  ticket->served = pick.inverter;
  ++ticket->frames;
}

void Scheduler::doneRefresh(const Pick& pick, bool more, bool answered)
{
  commands_in_a_row_ = 0;
  const bool by_deadline = pick.deadline || std::find(half_refreshed_.begin(), half_refreshed_.end(), pick.inverter) !=
                                                half_refreshed_.end();
  commands_since_turn_ = by_deadline ? commands_since_turn_ : 0;
  silent_at_deadline_[pick.inverter] = answered ? 0 : exchanges_;
  read_soon_.erase(std::remove(read_soon_.begin(), read_soon_.end(), pick.inverter), read_soon_.end());
  const bool was_put_off = isPutOff(pick.inverter);
  put_off_.erase(std::remove(put_off_.begin(), put_off_.end(), pick.inverter), put_off_.end());
  cycle_first_ = was_put_off && !(more && answered);
  const bool in_turn = cycle_open_ && pick.inverter == cursor_;
  refreshed_in_cycle_ = refreshed_in_cycle_ || in_turn;
  if (more && answered && was_put_off)
  {
    put_off_.push_front(pick.inverter);
  }
  else if (more && !answered && (in_turn || was_put_off))
  {
    put_off_.push_back(pick.inverter);
  }
  cursor_ += in_turn && !(more && answered) ? 1 : 0;
  // A repeat has no right to the next exchange: another drive's time may come meanwhile.
  noteHalfRefresh(pick, more && answered);
}

void Scheduler::noteHalfRefresh(const Pick& pick, bool more)
{
  const auto half = std::find(half_refreshed_.begin(), half_refreshed_.end(), pick.inverter);
  const bool was_half = half != half_refreshed_.end();
  if (more && pick.deadline && !was_half)
  {
    half_refreshed_.push_back(pick.inverter);
  }
  if (!more && was_half)
  {
    half_refreshed_.erase(half);
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
    probe_account_.restart(now);
  }
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/coordinator.h"

#include <algorithm>
#include <utility>

#include "wire/shown_number.h"

// The loop's side of the coordinator: which exchange is next. What follows from its end stands in
// coordinator_outcomes.cpp, what users ask for in coordinator_requests.cpp, what it tells in coordinator_report.cpp.

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, rule 3.7: an inverter is found again within 3 s; with a little margin.
constexpr double PROBE_ROUND_S = 2.7;
constexpr double SHORTEST_PROBE_TIMEOUT_S = 0.015;
// Every so many probes waits the whole response_timeout, for a drive that has become slow.
constexpr std::size_t FULL_PROBE_EVERY = 4;
constexpr std::size_t FULL_PROBE_EVERY_OF_MANY = 16;
// A pick that turned out to have nothing to send is dropped; more in a row than this would be a mistake of ours.
constexpr int MOST_EMPTY_PICKS = 100;
constexpr double STATUS_PERIOD_OFFLINE_S = 0.5;
constexpr double BUS_STATUS_SHORTEST_S = 0.1;
constexpr double BUS_STATUS_LONGEST_S = 0.9;
constexpr double BLIND_RESET_PERIOD_S = 0.02;
constexpr double STATUS_WAIT_S = 0.02;

/// At shutdown stops take turns: every one is written before the first of them is read back, so that no motor waits for
/// another's confirmation; nor for one that somebody asks to be stopped again and again.
bool goesBefore(const StopJob& stop, const StopJob& other)
{
  return std::make_pair(stop.attempts(), stop.lastSentAt()) < std::make_pair(other.attempts(), other.lastSentAt());
}

Duration longestResponseTimeout(const BusConfig& bus)
{
  double longest = bus.response_timeout;
  for (const InverterConfig& inverter : bus.inverters)
  {
    longest = std::max(longest, inverter.response_timeout);
  }
  return seconds(longest);
}
}  // namespace

Coordinator::Coordinator(const Configuration& configuration, const wire::Line& line)
  : configuration_(configuration)
  , line_(line)
  , budget_(Budget(configuration, line).figures())
  , gateway_({ configuration.bus.modbus_tcp, seconds(configuration.bus.gateway_timeout),
               longestResponseTimeout(configuration.bus) })
  , link_(longestResponseTimeout(configuration.bus))
  , refusals_(configuration.bus.inverters.size())
{
  for (std::size_t index = 0; index < configuration.bus.inverters.size(); ++index)
  {
    inverters_.push_back(std::make_unique<Inverter>(index, configuration.bus.inverters[index],
                                                    configuration.drives[index], configuration.bus.offline_after,
                                                    configuration.bus.retries));
  }
  Scheduler::Settings settings;
  settings.inverters = inverters_.size();
  settings.interval = seconds(configuration.bus.interval);
  settings.idle_divisor = static_cast<unsigned>(configuration.bus.idle_divisor);
  scheduler_ = std::make_unique<Scheduler>(settings);
  last_published_.resize(inverters_.size());
  attempts_at_open_.resize(inverters_.size(), 0);
  shutdown_tried_.resize(inverters_.size(), false);
  released_.resize(inverters_.size(), false);
}

Coordinator::~Coordinator() = default;

// --- time ------------------------------------------------------------------------------------------------------------

bool Coordinator::tick(TimePoint now)
{
  noteRunning(now);
  watchDeadMen(now);
  const bool lost_one = watchStatuses(now);
  for (const std::string& line : refusals_.takeLines(now))
  {
    log(Level::Warn, line);
  }
  expireJobs(now);
  finishStopCalls(now);
  publishSlowly(now);
  return lost_one;
}

/// Looks for a jump of time. Only who watches for answers of drives forgives it; dead men and locks go by the real time.
void Coordinator::noteRunning(TimePoint now)
{
  const Duration frozen = freeze_.back(now);
  if (frozen == Duration::zero() || !connected_)
  {
    return;
  }
  log(Level::Warn, "this node did not run for " + wire::shownDuration(frozen) +
                       ": it was stopped, or its machine is overloaded; nothing was sent meanwhile, no stop either");
  for (const auto& inverter : inverters_)
  {
    inverter->liveness.notWatching(now, frozen);
  }
  link_.notWatching(frozen);
}

/// With what the drives themselves have told of their wait.
Duration Coordinator::longestExchange() const
{
  return budget_.longest_exchange + longestReplyDelay();
}

/// Since when an exchange has taken time from others: not while this node itself did not run.
TimePoint Coordinator::countedFrom(const wire::Reply& reply) const
{
  return std::max(reply.sent_at, reply.finished_at - longestExchange());
}

void Coordinator::watchDeadMen(TimePoint now)
{
  for (const auto& inverter : inverters_)
  {
    // A stop that locks nothing (a 0, a RUN that got lost) may be pending: silence locks all the same.
    if (inverter->interlock.deadManDue(now) && !inverter->interlock.stopPending())
    {
      requestStop(now, *inverter, StopMode::Decelerate, true,
                  refusals_.deadManReason(inverter->index, inverter->config.command_timeout));
    }
  }
}

/// Contract, 8.15: without a complete status for too long an inverter is offline, whatever else it answers.
bool Coordinator::watchStatuses(TimePoint now)
{
  if (!connected_ || shutting_down_)
  {
    return false;
  }
  bool lost_one = false;
  for (const auto& inverter : inverters_)
  {
    if (inverter->overdue(now, refreshPeriod(*inverter)))
    {
      const std::uint16_t error_id = inverter->liveness.lastError();
      inverter->goOffline(error_id);
      wentOffline(now, *inverter);
      lost_one = true;
    }
  }
  return lost_one;
}

/// The longest time between two of its refreshes as the configuration has it, and as a gateway may stretch it.
Duration Coordinator::refreshPeriod(const Inverter& inverter) const
{
  const Duration period = budget_.cycle + seconds(configuration_.bus.interval);
  const int cycles = inverter.view(opened_at_, budget_.deadline_margin).at_rest ? configuration_.bus.idle_divisor : 1;
  return cycles * period + gateway_.longestPause();
}

void Coordinator::expireJobs(TimePoint now)
{
  std::vector<CommandId> expired;
  for (const auto& entry : jobs_)
  {
    if (now >= entry.second.expires)
    {
      expired.push_back(entry.first);
    }
  }
  for (const CommandId id : expired)
  {
    RunningJob& running = jobs_.at(id);
    Answer late = running.job->answer();
    late.success = false;
    late.error_id = late.error_id != 0 ? late.error_id : wire::ERROR_TIMEOUT;
    late.message = late.message.empty() ? "not finished within the time that this service may take" : late.message;
    late.message += inverters_[running.inverter]->stop.pending() ? "; a stop is not confirmed yet" : "";
    scheduler_->erase(id);
    endJob(id, late);
  }
}

void Coordinator::publishSlowly(TimePoint now)
{
  // Behind a gateway that is kept busy no refresh comes, but locks and stops are to be seen.
  const bool busy = !gateway_.free(now);
  for (const auto& inverter : inverters_)
  {
    const bool held_up = busy && inverter->known();
    if ((inverter->offline() || held_up) && now - last_published_[inverter->index] >= seconds(STATUS_PERIOD_OFFLINE_S))
    {
      publish(now, *inverter);
    }
  }
  const Duration since = now - last_bus_status_;
  const bool cycle_done = scheduler_->cycles() != published_cycle_;
  if (cycle_done)
  {
    meter_.cycle(scheduler_->cycleTime());
  }
  // A loss is told at once (contract, 8.16).
  const bool connected = connected_ && !port_failing_;
  const bool changed = connected != published_connected_;
  if (changed || (cycle_done && since >= seconds(BUS_STATUS_SHORTEST_S)) || since >= seconds(BUS_STATUS_LONGEST_S))
  {
    outputs_.bus_statuses.push_back(busStatus(now));
    last_bus_status_ = now;
    published_connected_ = connected;
  }
  published_cycle_ = scheduler_->cycles();
}

TimePoint Coordinator::earliestDeadMan(TimePoint wake) const
{
  for (const auto& inverter : inverters_)
  {
    if (const auto at = inverter->interlock.deadManAt())
    {
      wake = std::min(wake, *at);
    }
  }
  return wake;
}

// --- the next exchange -----------------------------------------------------------------------------------------------

std::vector<InverterView> Coordinator::views(TimePoint now) const
{
  std::vector<InverterView> views;
  views.reserve(inverters_.size());
  for (const auto& inverter : inverters_)
  {
    views.push_back(inverter->view(now, budget_.deadline_margin));
    views.back().stop_pending = views.back().stop_pending && !untested(*inverter);
    views.back().stop_not_before = stopNotBefore(now, *inverter);
    views.back().refresh_unanswered = gateway_.refreshUnanswered(now, inverter->index);
  }
  return views;
}

Pick Coordinator::pick(TimePoint now)
{
  Gate allowed = gate(now);
  stopInsteadOfZeros(now);
  if (shutting_down_)
  {
    return pickShutdown(now);
  }
  if (line_.telnetFound())
  {
    return pickOverTelnet(now);
  }
  const auto check = pickCheck(now, allowed);
  return check ? *check : scheduler_->next(now, views(now), allowed);
}

std::optional<Coordinator::Exchange> Coordinator::next(TimePoint now, TimePoint& wake)
{
  if (tick(now))
  {
    // Users hear of an inverter that is offline before it is probed.
    wake = now;
    return std::nullopt;
  }
  for (int attempt = 0; attempt < MOST_EMPTY_PICKS; ++attempt)
  {
    std::optional<Current> current = composeBroadcast(now);
    if (!current)
    {
      const Pick chosen = pick(now);
      if (chosen.what == Pick::What::Nothing)
      {
        wake = std::max(earliestDeadMan(chosen.wake), now);
        freeze_.backBy(wake);
        return std::nullopt;
      }
      current = compose(now, chosen);
    }
    if (current && !mustWait(now, *current) && makeSafe(now, *current))
    {
      current_ = current;
      freeze_.backBy(now + longestExchange());
      Exchange exchange;
      exchange.request = current->request;
      if (current->request.broadcast)
      {
        exchange.turnaround = seconds(inverters_.front()->drive.profile().broadcast_turnaround);
      }
      return exchange;
    }
  }
  wake = now + seconds(BUS_STATUS_SHORTEST_S);
  freeze_.backBy(wake);
  return std::nullopt;
}

std::optional<Coordinator::Current> Coordinator::composeBroadcast(TimePoint now)
{
  // Who stops all again and again must not keep the single stops from being sent and confirmed.
  const bool again = broadcast_last_;
  broadcast_last_ = false;
  if (!broadcast_due_ || again)
  {
    return std::nullopt;
  }
  const bool kept = !gateway_.free(now);
  if (kept && broadcast_waits_)
  {
    // One is in the gateway already (contract, 8.8), and each inverter's own stop goes all the same.
    broadcast_due_ = false;
    return std::nullopt;
  }
  broadcast_waits_ = kept;
  broadcast_due_ = false;
  broadcast_last_ = true;
  const Inverter& any = *inverters_.front();
  const drive::Step& step = any.drive.sequence("stop")->steps.front();
  Current current;
  current.purpose = Purpose::Broadcast;
  current.request = any.drive.broadcast(step.point, step.value.value_or(0));
  return current;
}

Pick Coordinator::pickShutdown(TimePoint now)
{
  Pick pick;
  pick.what = Pick::What::Stop;
  const Inverter* best = nullptr;
  for (const auto& inverter : inverters_)
  {
    const bool may_go = inverter->stop.pending() && stopNotBefore(now, *inverter) <= now;
    const bool live = may_go && !inverter->silent();
    if (live && (best == nullptr || goesBefore(inverter->stop, best->stop)))
    {
      best = inverter.get();
    }
  }
  for (const auto& inverter : inverters_)
  {
    const bool one_frame =
        inverter->stop.pending() && inverter->silent() && !shutdown_tried_[inverter->index] && !untested(*inverter);
    if (best == nullptr && one_frame)
    {
      best = inverter.get();
      shutdown_tried_[best->index] = true;
    }
  }
  for (const auto& inverter : inverters_)
  {
    if (best == nullptr && releaseDue(*inverter))
    {
      best = inverter.get();
      pick.what = Pick::What::Background;
    }
  }
  if (best == nullptr)
  {
    pick.what = Pick::What::Nothing;
    pick.wake = gateway_.active() ? std::max(now, std::min(shutdown_deadline_, nextStop(now))) : now;
    return pick;
  }
  pick.inverter = best->index;
  return pick;
}

/// When the next frame of a live inverter's stop may go that waits for a gateway; one that is silent has had its own.
TimePoint Coordinator::nextStop(TimePoint now) const
{
  TimePoint at = TimePoint::max();
  for (const auto& inverter : inverters_)
  {
    at = inverter->stop.pending() && !inverter->silent() ? std::min(at, stopNotBefore(now, *inverter)) : at;
  }
  return at;
}

bool Coordinator::releaseDue(const Inverter& inverter) const
{
  return inverter.config.release_on_exit && !released_[inverter.index] && !inverter.offline() &&
         !inverter.stop.pending() && inverter.drive.sequence("release") != nullptr;
}

std::optional<Coordinator::Current> Coordinator::compose(TimePoint now, const Pick& pick)
{
  Current current;
  current.pick = pick;
  current.inverter = pick.inverter;
  Inverter& inverter = *inverters_[pick.inverter];
  switch (pick.what)
  {
    case Pick::What::Stop:
      if (shutting_down_ && inverter.silent() && inverter.stop.written())
      {
        // Rule 4.4: its one frame is the stop itself.
        inverter.stop.writeAgain();
      }
      current.purpose = Purpose::StopFrame;
      current.request = inverter.prepared(inverter.stop.next());
      if (pick.probe)
      {
        current.request.response_timeout = std::min(current.request.response_timeout, probeTimeout(inverter));
      }
      return current;
    case Pick::What::Command:
      return jobs_.count(pick.command) != 0 ? composeJob(now, pick) : composeVelocity(now, pick);
    case Pick::What::Refresh:
      return composeRefresh(now, pick);
    case Pick::What::Probe:
      return composeProbe(pick);
    case Pick::What::Background:
      if (shutting_down_)
      {
        const drive::Step& step = inverter.drive.sequence("release")->steps.front();
        released_[pick.inverter] = true;
        current.purpose = Purpose::Release;
        current.request = inverter.prepared(inverter.drive.command(inverter.config.node, step));
        return current;
      }
      current.purpose = Purpose::Setting;
      current.request = inverter.prepared(inverter.settings.next());
      return current;
    default:
      return std::nullopt;
  }
}

Coordinator::Current Coordinator::composeRefresh(TimePoint now, const Pick& pick)
{
  Inverter& inverter = *inverters_[pick.inverter];
  Current current;
  current.pick = pick;
  current.inverter = pick.inverter;
  if (inverter.connectDue(now))
  {
    current.purpose = Purpose::Setting;
    current.request = inverter.prepared(inverter.settings.next());
    return current;
  }
  current.purpose = Purpose::Refresh;
  const bool resync = inverter.loopbackUsable() && inverter.drive.loopback(inverter.config.node, 0);
  drive::ReadBlock block = inverter.refresh.next(now);
  current.request = inverter.drive.read(inverter.config.node, block);
  while (!resync && !line_.mayAsk(current.request) && inverter.refresh.skipSlow())
  {
    // What decides over safety does not wait a second for a temperature.
    block = inverter.refresh.next(now);
    current.request = inverter.drive.read(inverter.config.node, block);
  }
  // Rule 4.1: the confirmed words are repeated only while the last exchange showed our RUN in force; never through a gateway,
  // which could carry them out when everything has changed, or has just been connected anew (contract, 8.8, 8.9 and 8.11).
  if (!configuration_.bus.gateway && !block.chosen.empty() && inverter.mayRepeatWords(now))
  {
    const std::vector<drive::Word> words = inverter.movement.wordsInForce();
    const wire::Request both =
        words.empty() ? current.request : inverter.drive.writeAndRead(inverter.config.node, words, block);
    // After a lost 17H that shape is barred for a while, the plain read is not.
    current.request = line_.mayAsk(both) ? both : current.request;
  }
  std::optional<drive::ReadBlock> variant = block;
  while (!resync && variant && !line_.mayAsk(current.request))
  {
    // Without a loop-back a lost read would leave the drive unwatched for a second: another length is no risk.
    variant = inverter.drive.variantOf(*variant);
    current.request = variant ? inverter.drive.read(inverter.config.node, *variant) : current.request;
  }
  const auto serve_by = inverter.serveBy(budget_.deadline_margin);
  if (!resync && !line_.mayAsk(current.request) && serve_by && *serve_by <= now)
  {
    const auto spare = keepAlive(inverter);
    current.purpose = spare ? Purpose::KeepAlive : current.purpose;
    current.request = spare.value_or(current.request);
  }
  current.request = inverter.prepared(current.request);
  return current;
}

/// A read that no late reply can answer; nothing: this drive has none.
std::optional<wire::Request> Coordinator::keepAlive(const Inverter& inverter) const
{
  for (std::optional<drive::ReadBlock> read : inverter.reads())
  {
    for (; read; read = inverter.drive.variantOf(*read))
    {
      const wire::Request request = inverter.drive.read(inverter.config.node, *read);
      if (line_.mayAsk(request))
      {
        return request;
      }
    }
  }
  return std::nullopt;
}

/// All command words in one frame where the drive can; a word at a time where such a frame could give back a RUN that the
/// drive has lost (rule 4.1), or where a late reply could be taken for its answer.
std::optional<Write> Coordinator::nextWrite(TimePoint now, const Inverter& inverter) const
{
  const bool in_force = inverter.mayRepeatWords(now);
  if (inverter.refresh.block() && (in_force || !inverter.movement.runConfirmed()))
  {
    auto combined = inverter.movement.nextCombined(in_force ? inverter.refresh.block() : std::nullopt);
    if (combined && line_.mayAsk(combined->request))
    {
      return combined;
    }
  }
  return inverter.movement.next();
}

std::optional<Coordinator::Current> Coordinator::composeVelocity(TimePoint now, const Pick& pick)
{
  std::vector<std::size_t> members = scheduler_->members(pick.command);
  // The member whose turn it is, and if it needs no frame any more, the next one.
  std::rotate(members.begin(), std::lower_bound(members.begin(), members.end(), pick.inverter), members.end());
  for (const std::size_t member : members)
  {
    Inverter& inverter = *inverters_[member];
    if (const auto write = nextWrite(now, inverter))
    {
      if (write->starts && inverter.mustBeSeenRunning())
      {
        scheduler_->splitOff(pick.command, member, next_command_++, now + seconds(STATUS_WAIT_S), false);
        continue;
      }
      Current current;
      current.pick = pick;
      current.pick.inverter = member;
      current.purpose = Purpose::Velocity;
      current.inverter = member;
      current.write = *write;
      current.moves = inverter.movement.target() && !inverter.movement.target()->zero;
      current.request = inverter.prepared(write->request);
      return current;
    }
    scheduler_->eraseVelocity(member);
  }
  return std::nullopt;
}

std::optional<Coordinator::Current> Coordinator::composeJob(TimePoint now, const Pick& pick)
{
  RunningJob& running = jobs_.at(pick.command);
  Inverter& inverter = *inverters_[running.inverter];
  const bool blind_reset = running.job->kind() == CommandKind::Reset && !inverter.drive.tellsRun();
  if (blind_reset && inverter.movement.runPossible() && !inverter.stop.pending())
  {
    requestStop(now, inverter, StopMode::Decelerate, true, "RUN must be off before the trip is reset");
  }
  if (blind_reset && inverter.stop.pending())
  {
    // Nobody can ask this drive whether RUN is off: the stop must be confirmed first.
    scheduler_->postpone(pick.command, now + seconds(BLIND_RESET_PERIOD_S));
    return std::nullopt;
  }
  if (running.job->needsRest() && (inverter.mayRun() || inverter.movement.target()))
  {
    Answer moving;
    moving.error_id = ERROR_NOT_OFFERED;
    moving.message = "not while the motor runs: it was started meanwhile";
    scheduler_->erase(pick.command);
    endJob(pick.command, moving);
    return std::nullopt;
  }
  Current current;
  current.pick = pick;
  current.purpose = Purpose::Job;
  current.inverter = running.inverter;
  current.job = pick.command;
  current.request = inverters_[running.inverter]->prepared(running.job->next());
  return current;
}

Coordinator::Current Coordinator::composeProbe(const Pick& pick)
{
  Inverter& inverter = *inverters_[pick.inverter];
  Current current;
  current.pick = pick;
  current.purpose = Purpose::Probe;
  current.inverter = pick.inverter;
  current.loopback = inverter.probesByLoopback() && inverter.drive.loopback(inverter.config.node, 0).has_value();
  current.request = inverter.probe(++loopback_number_, probeTimeout(inverter));
  ++inverter.probes;
  return current;
}

/// Probes share 5 % of the bus time, and each dead inverter shall be asked every 3 s: the more are dead, the shorter each
/// one may be waited for, but never shorter than the inverter has ever needed. Its reply still counts when it comes late.
Duration Coordinator::probeTimeout(const Inverter& inverter) const
{
  const Duration full = seconds(inverter.config.response_timeout);
  const auto dead = std::count_if(inverters_.begin(), inverters_.end(),
                                  [](const std::unique_ptr<Inverter>& other) { return other->silent(); });
  // Staggered by index, so that no round has more than a few full ones.
  const std::size_t every = dead > 1 ? FULL_PROBE_EVERY_OF_MANY : FULL_PROBE_EVERY;
  if ((inverter.probes + inverter.index) % every == every - 1)
  {
    return full;
  }
  const wire::Request bare = inverter.probe(0, Duration::zero());
  const Duration share = seconds(PROBE_ROUND_S * PROBE_SHARE / static_cast<double>(std::max<long>(dead, 1)));
  const Duration needed = inverter.slowestReply() + inverter.slowestReply() / 2;
  const Duration least = std::max(needed, seconds(SHORTEST_PROBE_TIMEOUT_S));
  return std::min(full, std::max(least, share - line_.costUnanswered(bare)));
}

/// Rule 3.9: after a time-out nothing of the same shape is asked of this station before its late reply, or a loop-back
/// with a fresh number, has come. A stop's write is exempt: its read-back decides, or a second write after a loop-back.
bool Coordinator::makeSafe(TimePoint now, Current& current)
{
  Inverter& inverter = *inverters_[current.inverter];
  if (current.request.broadcast || line_.mayAsk(current.request))
  {
    return true;
  }
  const bool stop_write = current.purpose == Purpose::StopFrame && !inverter.stop.written();
  current.may_be_late = stop_write;
  const bool last_frame = shutting_down_ && inverter.silent();
  if (stop_write && (last_frame || !inverter.stop.wantsClearLine()))
  {
    return true;
  }
  const auto loopback =
      inverter.loopbackUsable() ? inverter.drive.loopback(inverter.config.node, ++loopback_number_) : std::nullopt;
  if (loopback)
  {
    const Duration timeout = current.request.response_timeout;
    current.request = inverter.prepared(*loopback);
    current.request.response_timeout = timeout;
    current.resync = true;
    current.loopback = true;
    return true;
  }
  if (current.purpose == Purpose::StopFrame)
  {
    return stop_write || readBackSafely(inverter, current);
  }
  const TimePoint allowed = std::max(line_.mayAskAt(current.request), now + std::chrono::milliseconds(1));
  if (current.purpose == Purpose::Velocity)
  {
    // The other members of a group don't wait for it.
    scheduler_->splitOff(current.pick.command, current.inverter, next_command_++, allowed,
                         inverter.movement.target() && inverter.movement.target()->zero);
  }
  else if (current.purpose == Purpose::Job)
  {
    scheduler_->postpone(current.pick.command, allowed);
  }
  else if (current.purpose == Purpose::Setting)
  {
    // The status may have another shape.
    inverter.setting_not_before = allowed;
  }
  else
  {
    const auto serve_by =
        current.purpose == Purpose::Refresh ? inverter.serveBy(budget_.deadline_margin) : std::nullopt;
    const bool early = serve_by && *serve_by < allowed && keepAlive(inverter);
    inverter.refresh_not_before = early ? std::max(*serve_by, now + std::chrono::milliseconds(1)) : allowed;
  }
  return false;
}

/// RUN that was read off in the late reply to another request is no proof: it is asked in another shape, or, where the
/// drive has none, the write goes again until the bar has ended.
bool Coordinator::readBackSafely(Inverter& inverter, Current& current) const
{
  for (auto read = inverter.drive.variantOf(*inverter.drive.runBlock()); read; read = inverter.drive.variantOf(*read))
  {
    wire::Request request = inverter.prepared(inverter.drive.read(inverter.config.node, *read));
    if (line_.mayAsk(request))
    {
      request.response_timeout = current.request.response_timeout;
      current.request = request;
      return true;
    }
  }
  inverter.stop.writeAgain();
  return false;
}

void Coordinator::sent(TimePoint now)
{
  if (!current_)
  {
    return;
  }
  last_node_ = current_->request.station;
  Inverter& inverter = *inverters_[current_->inverter];
  if (!current_->resync)
  {
    countWear(*current_);
  }
  const auto job = jobs_.find(current_->job);
  if (current_->purpose == Purpose::Job && job != jobs_.end())
  {
    const auto* write = dynamic_cast<const WriteParameterJob*>(job->second.job.get());
    inverter.setup_open = inverter.setup_open || (write != nullptr && write->inSetup());
  }
  if (current_->purpose == Purpose::Velocity && !current_->resync)
  {
    inverter.movement.sent(current_->write);
    if (current_->write.starts)
    {
      // The stop that follows is none of a flood.
      inverter.stop.forgetConfirmation();
    }
  }
  if (current_->purpose == Purpose::Broadcast && !gateway_.active())
  {
    noteStopLatency(now - broadcast_requested_);
  }
  if (current_->purpose == Purpose::StopFrame && !current_->resync)
  {
    tellOfCostlyStop(inverter);
    const auto latency = inverter.stop.sent(now);
    // Behind a gateway the frame's way ends somewhere else (contract, 8.16). An inverter that can't be reached, or a port
    // that was gone, is no measure of the scheduler's latency.
    if (latency && !current_->pick.probe && !gateway_.active())
    {
      noteStopLatency(*latency);
    }
  }
}

/// The longest wait of a drive's own (C078) as read from it, beyond what its profile says.
Duration Coordinator::longestReplyDelay() const
{
  Duration longest{ 0 };
  for (const auto& inverter : inverters_)
  {
    const Duration known = seconds(inverter->drive.profile().reply_delay);
    longest = std::max(longest, inverter->settings.replyDelay() - known);
  }
  return longest;
}

void Coordinator::noteStopLatency(Duration latency)
{
  stop_latency_max_ = std::max(stop_latency_max_, latency);
  const Duration in_gateway = worstStop() - budget_.worst_stop - longestReplyDelay();
  if (latency > budget_.longest_exchange + longestReplyDelay() + line_.timing().characters(64) + in_gateway)
  {
    outputs_.traces.push_back("stop took " + wire::shownDuration(latency) + " to the wire");
  }
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bus_fuzz_checker.h"

// What may move: locks, commands, RUN frames, stops.

namespace inverter_bus
{
namespace fuzz
{
namespace
{
constexpr double SHORTEST_SILENCE_S = 0.5;  // contract, rule 4.2
constexpr double LONGEST_SILENCE_S = 5.0;
constexpr double TOLERANCE_S = 1e-3;
// A 3G3JE wants 5 ms of silence between the decision and the first byte.
constexpr double QUIET_S = 0.006;
constexpr double TURNAROUND_S = 0.03;  // after a broadcast, with a margin
// Who stops again and again what is at rest lets other exchanges through.
constexpr unsigned FLOOD_OF_STOPS = 4;
constexpr double FLOOD_PAUSE_S = 1.0;
constexpr double ZERO_BOUND_EXCHANGES = 8.0;
constexpr double LIMIT_ROUNDING = 1e-6;      // contract, 8.5: of a publisher that computes in 32 bits
constexpr double SHORTEST_SHUTDOWN_S = 2.0;  // contract, rule 4.4
constexpr double LONGEST_SHUTDOWN_S = 10.0;

std::string text(double value)
{
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3f", value);
  return buffer;
}
}  // namespace

// --- locks -----------------------------------------------------------------------------------------------------------------

void Checker::forbid(TimePoint now, Lane& lane)
{
  lane.permit_off_at = lane.permit ? now : lane.permit_off_at;
  lane.permit = false;
  lane.settled = false;
  lane.lost_frames = 0;
  lane.fed.reset();
}

/// Everybody must return to neutral.
void Checker::lockUp(TimePoint now, Lane& lane, bool by_stop)
{
  forbid(now, lane);
  ++lane.lock;
  lane.locked_at = now;
  lane.open_at.reset();
  lane.needs_stop_reply = lane.needs_stop_reply || by_stop;
  lane.stop_under_way = lane.stopping && !lane.due;
  for (auto& stream : lane.streams)
  {
    stream.second.neutral = false;
  }
}

void Checker::tryOpen(TimePoint now, Lane& lane)
{
  if (!lane.open_at && !lane.needs_status && !lane.needs_stop_reply)
  {
    // The silence counts from the stop where there was one, otherwise from the status.
    const TimePoint confirmed = lane.stop_replied > lane.locked_at ? lane.stop_replied : lane.confirmed_at;
    lane.open_at = confirmed > lane.locked_at ? confirmed : now;
  }
}

/// Rule 4.3. The node looks at its dead men before each exchange.
void Checker::watchDeadMen(TimePoint now)
{
  // The silence before its frame comes after the decision, and a second master's frame in it makes it longer.
  const Duration quiet = scene_.compoway ? seconds(QUIET_S) + babble(now) : Duration{ 0 };
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    Lane& lane = lanes_[index];
    const Duration timeout = seconds(scene_.inverters[index].command_timeout);
    if (!lane.fed || timeout == Duration{ 0 } || now - quiet < *lane.fed + timeout)
    {
      continue;
    }
    const TimePoint since = *lane.fed + timeout;
    lane.fed.reset();
    if (!lane.run_sent)
    {
      continue;
    }
    const bool counts = lane.run_answered && !lane.stopping && online(index);
    lockUp(since, lane, true);
    if (counts)
    {
      lane.due = since;
      lane.due_counts = false;
      lane.stopping = true;
    }
  }
}

// --- stops ---------------------------------------------------------------------------------------------------------------

void Checker::stopAsked(TimePoint now, std::optional<std::size_t> index)
{
  for (std::size_t one = 0; one < lanes_.size(); ++one)
  {
    if (index && *index != one)
    {
      continue;
    }
    Lane& lane = lanes_[one];
    const bool flood = lane.stops_in_a_row >= FLOOD_OF_STOPS && now - lane.stop_sent < seconds(FLOOD_PAUSE_S);
    // At shutdown each one is stopped anyway, in an order of its own.
    const bool counts = !lane.stopping && !lane.due && !flood && !shutting_down_;
    if (!online(one))
    {
      // It is tried once at once, then it is the probe.
      probe_allowance_ += toSeconds(scene_.longestExchange());
    }
    lockUp(now, lane, true);
    lane.zero_due.reset();
    lane.stopping = true;
    if (counts)
    {
      lane.due = now;
      lane.due_counts = true;
    }
  }
}

void Checker::stopConfirmed(std::size_t index, TimePoint asked_at) const
{
  const Lane& lane = lanes_[index];
  const TimePoint now = now_();
  // What was commanded since is not this stop's business.
  if (runLatched(index) && lane.accepted_at < asked_at)
  {
    fail(now, "a confirmed stop", nameOf(index) + " still has RUN on");
  }
  const Brand brand = scene_.inverters[index].brand;
  const bool tells = brand == Brand::HITACHI || brand == Brand::TOSHIBA;
  // A 3G3JE tells neither its RUN nor which request it answers: there another drive's late reply under its station passes.
  const bool imitated = scene_.compoway && lane.imitated_at >= asked_at;
  if (lane.stop_replied < asked_at && lane.run_read < asked_at && !imitated)
  {
    fail(now, "a confirmed stop", nameOf(index) + " has acknowledged no stop since it was asked for");
  }
  if (tells && lane.run_read < asked_at)
  {
    fail(now, "a confirmed stop", nameOf(index) + " was not asked whether RUN is off");
  }
}

/// Rule 4.4. The order of these stops is the shutdown's own.
void Checker::shutdownBegun(TimePoint now)
{
  shutting_down_ = true;
  for (Lane& lane : lanes_)
  {
    lockUp(now, lane, true);
    lane.due.reset();
    lane.zero_due.reset();
    // One frame to each that is offline.
    probe_allowance_ += toSeconds(scene_.longestExchange());
  }
}

void Checker::shutdownEnded(TimePoint now, TimePoint begun, const std::vector<std::string>& unconfirmed) const
{
  const double exchange = toSeconds(scene_.longestExchange());
  const double two_each = 2.0 * exchange * static_cast<double>(lanes_.size());
  const double bound = std::min(LONGEST_SHUTDOWN_S, std::max(SHORTEST_SHUTDOWN_S, two_each)) + exchange;
  if (now - begun > seconds(bound) + babble(now))
  {
    fail(now, "shutdown", "takes " + text(toSeconds(now - begun)) + " s");
  }
  if (!calls_.empty())
  {
    fail(now, "every service is answered within its bound", calls_.begin()->second.what + " at the end");
  }
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    const std::string name = scene_.inverters[index].name + ":";
    const bool named = std::any_of(unconfirmed.begin(), unconfirmed.end(),
                                   [&](const std::string& text) { return text.compare(0, name.size(), name) == 0; });
    const bool commanded = lanes_[index].accepted_at != TimePoint();
    if (commanded && !named && runLatched(index))
    {
      fail(now, "shutdown", nameOf(index) + " still has RUN on and is not named");
    }
    if (commanded && runLatched(index) && online(index) && lanes_[index].stop_sent < begun)
    {
      fail(now, "shutdown", nameOf(index) + " still has RUN on and was sent no stop");
    }
  }
}

/// What goes now may have been decided before \p time: a 3G3JE wants silence between the decision and the first byte, and what
/// comes late in that silence prolongs it.
bool Checker::decidedBefore(TimePoint now, TimePoint time) const
{
  const Duration quiet = scene_.compoway ? seconds(QUIET_S) : Duration{ 0 };
  const bool prolonged = scene_.compoway && time != TimePoint() && between_heard_at_ > time - quiet;
  return now - time < quiet || prolonged;
}

/// Rules 3.1 and 4.3: while a stop waits for its first byte, nothing else goes.
void Checker::checkStopFirst(TimePoint now)
{
  std::size_t waiting = lanes_.size();
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    const Lane& lane = lanes_[index];
    waiting = lane.due && !decidedBefore(now, *lane.due) && online(index) ? index : waiting;
  }
  if (waiting == lanes_.size())
  {
    return;
  }
  // Several stops take turns, each once before one is repeated.
  // What a command of 0 had decided before the stop came was no frame of that stop.
  const Duration quiet = scene_.compoway ? seconds(QUIET_S) : Duration{ 0 };
  const bool first = facts_.inverter && lanes_[*facts_.inverter].stop_sent < *lanes_[waiting].due + quiet;
  if (!facts_.stop || !(facts_.broadcast || first))
  {
    fail(now, "a stop is the next frame on the wire",
         "a stop of " + nameOf(waiting) + " waits since " + text(toSeconds(now - *lanes_[waiting].due) * 1e3) +
             " ms, and another frame goes: " + simulation::toHex(request_));
  }
}

/// The time of an exchange in flight, the gap, and what a broadcast takes.
void Checker::checkOverdue(TimePoint now)
{
  const Duration bound = scene_.longestExchange() + 2 * scene_.gap() + seconds(QUIET_S + TURNAROUND_S) + babble(now);
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    const Lane& lane = lanes_[index];
    if (lane.due && online(index) && now - std::max(*lane.due, last_due_served_) > bound)
    {
      fail(now, "a stop's first byte within the exchange in flight plus the gap",
           nameOf(index) + " waits since " + text(toSeconds(now - *lane.due)) + " s");
    }
    // The node looks at its dead men before each exchange, and wakes up for them while there is none.
    const Duration timeout = seconds(scene_.inverters[index].command_timeout);
    const bool watched = lane.fed && timeout > Duration{ 0 } && lane.run_answered && !lane.stopping && online(index);
    if (watched && now - *lane.fed > timeout + bound)
    {
      fail(now, "the dead man stops the inverter",
           nameOf(index) + " has no command since " + text(toSeconds(now - *lane.fed)) + " s and no stop");
    }
    const auto zero_bound = ZERO_BOUND_EXCHANGES + 3.0 * static_cast<double>(lanes_.size());
    if (lane.zero_due && online(index) && now - *lane.zero_due > seconds(zero_bound * toSeconds(bound)))
    {
      fail(now, "a command of 0 takes RUN off",
           nameOf(index) + " has got no stop since " + text(toSeconds(now - *lane.zero_due)) + " s");
    }
  }
}

void Checker::noteStopFrame(TimePoint now, std::size_t index)
{
  Lane& lane = lanes_[index];
  const TimePoint served_before = last_due_served_;
  last_due_served_ = now;
  if (lane.due)
  {
    const Duration latency = now - *lane.due;
    if (lane.due_counts)
    {
      ++statistics_.stops;
      // Stops that were asked for together go one after the other: the first one tells the latency.
      statistics_.worst_stop =
          served_before < *lane.due ? std::max(statistics_.worst_stop, latency) : statistics_.worst_stop;
    }
  }
  lane.due.reset();
  lane.zero_due.reset();
  lane.stops_in_a_row = now - lane.stop_sent < seconds(FLOOD_PAUSE_S) ? lane.stops_in_a_row + 1 : 1;
  lane.stop_sent = now;
  lane.stopping = true;
  lane.run_answered = false;
  lane.run_sent = false;
  lane.settled = false;
  lane.set_answered.reset();
  lane.power_lost.reset();
}

// --- frames that move ----------------------------------------------------------------------------------------------------

void Checker::checkMotion(TimePoint now)
{
  if (facts_.broadcast)
  {
    if (!scene_.one_brand || !facts_.stop)
    {
      fail(now, "broadcasts", "a broadcast that is no stop, or on a bus of several brands");
    }
    return;
  }
  const std::size_t index = *facts_.inverter;
  Lane& lane = lanes_[index];
  if (facts_.reset && runLatched(index))
  {
    fail(now, "reset sends nothing unless RUN is off", nameOf(index) + " is reset with RUN on");
  }
  if (facts_.run)
  {
    ++statistics_.runs;
    checkRun(now, lane);
  }
  if (facts_.set_hertz)
  {
    checkSetPoint(now, lane);
  }
  if (facts_.stop)
  {
    noteStopFrame(now, index);
  }
}

/// Rules 4.1 and 4.2: every RUN has a fresh, allowed command.
void Checker::checkRun(TimePoint now, Lane& lane)
{
  const std::size_t index = *facts_.inverter;
  const bool just_now = now == lane.permit_off_at || decidedBefore(now, lane.permit_off_at);
  // MX2 and RX have a coil of its own for the direction: RUN says nothing of it.
  const bool undirected = scene_.inverters[index].brand == Brand::HITACHI;
  facts_.reverse = undirected ? lane.hertz < 0.0 : facts_.reverse;
  if (!lane.permit && !just_now)
  {
    fail(now, "no RUN without a fresh, allowed command", nameOf(index));
  }
  const bool just_changed = scene_.compoway && decidedBefore(now, lane.accepted_at);
  if (lane.permit && facts_.reverse != (lane.hertz < 0.0) && !just_changed)
  {
    fail(now, "the newest velocity wins", nameOf(index) + " is sent the wrong direction");
  }
  const bool repeated = lane.run_answered && (undirected || lane.run_reverse == facts_.reverse);
  if ((repeated || facts_.with_read) && !lane.shown)
  {
    fail(now, "no RUN by a refresh or a repeat",
         nameOf(index) + ": RUN is repeated though the last exchange has not shown it in force");
  }
  if (!repeated && lane.permit && !just_changed && ++lane.run_copies > scene_.retries + 1)
  {
    fail(now, "no RUN by a retry", nameOf(index) + ": more copies of RUN than retries");
  }
  const bool turns = lane.run_answered && !repeated;
  if (lane.power_lost && !turns && !repeated)
  {
    const Stream& stream = lane.streams[lane.commander];
    const bool silent = lane.accepted_at - *lane.power_lost >= seconds(SHORTEST_SILENCE_S - TOLERANCE_S);
    if (stream.zeroed_at < *lane.power_lost && !silent)
    {
      fail(now, "no RUN by a power cycle", nameOf(index) + " had lost its RUN, and nobody has returned to neutral");
    }
  }
  lane.run_sent = true;
  lane.stops_in_a_row = 0;
  // Whatever ran before, nobody knows until this one is answered.
  lane.run_answered = lane.run_answered && repeated;
}

/// Rule 3.5: only the newest velocity, and each one once.
void Checker::checkSetPoint(TimePoint now, Lane& lane)
{
  const std::size_t index = *facts_.inverter;
  if (!lane.permit && now != lane.permit_off_at && !decidedBefore(now, lane.permit_off_at))
  {
    fail(now, "a cancelled velocity is not sent", nameOf(index));
  }
  const double resolution = scene_.inverters[index].brand == Brand::JE ? 0.051 : 0.0051;
  const bool newest = std::fabs(*facts_.set_hertz - std::fabs(lane.hertz)) <= resolution;
  const bool just_changed = scene_.compoway && decidedBefore(now, lane.accepted_at);
  if (lane.permit && !newest && !just_changed)
  {
    fail(now, "the newest velocity wins",
         nameOf(index) + " is sent " + text(*facts_.set_hertz) + " Hz instead of " + text(std::fabs(lane.hertz)) +
             " Hz");
  }
  if (facts_.run && lane.shown)
  {
    // Words in force, repeated with a refresh.
    return;
  }
  if (lane.settled)
  {
    fail(now, "no velocity is queued twice", nameOf(index) + " has confirmed it already");
  }
  // A block write tells all words at once, also where it is selected between the set-point and RUN.
  int& copies = facts_.run ? lane.run_set_copies : lane.set_copies;
  if (!just_changed && ++copies > scene_.retries + 1)
  {
    fail(now, "no velocity is queued twice", nameOf(index) + ": more copies of a set-point than retries");
  }
}

// --- commands --------------------------------------------------------------------------------------------------------------

bool Checker::isRepeat(const Lane& lane, const bus::Publisher& publisher) const
{
  const auto stream = lane.streams.find(publisher.name);
  return publisher.latched && publisher.first_on_connection && stream != lane.streams.end() &&
         stream->second.topics.count(publisher.topic) != 0;
}

void Checker::book(TimePoint now, Lane& lane, const bus::Publisher& publisher, bool zero)
{
  const bool known = lane.streams.count(publisher.name) != 0;
  Stream& stream = lane.streams[publisher.name];
  // Near zero is silence: who has sent nothing else yet has no spacing.
  stream.spacing = known && stream.last != TimePoint() ? now - stream.last : Duration{ 0 };
  stream.last = now;
  stream.neutral = zero;
  stream.zeroed_at = zero ? now : stream.zeroed_at;
  stream.topics.insert(publisher.topic);
}

/// Rounds to 0 Hz, or lies below the minimum (contract, 8.5).
bool Checker::isNearZero(std::size_t index, double velocity) const
{
  const InverterFacts& facts = scene_.inverters[index];
  const double step = facts.brand == Brand::JE ? 0.1 : 0.01;
  const double hertz = std::fabs(velocity * facts.hz_per_unit);
  return velocity != 0.0 && (hertz < 0.5 * step || std::fabs(velocity) < facts.min_velocity * (1.0 - LIMIT_ROUNDING));
}

bool Checker::isBeyond(std::size_t index, double velocity) const
{
  const InverterFacts& facts = scene_.inverters[index];
  if (facts.max_velocity > 0.0)
  {
    return std::fabs(velocity) > facts.max_velocity * (1.0 + LIMIT_ROUNDING);
  }
  // No profile goes so far, and no story sends anything between.
  return std::fabs(velocity) > 1000.0 && std::fabs(velocity) > std::fabs(60.0 / facts.hz_per_unit);
}

/// One for all members: the smallest that any of those that saturate needs.
double Checker::factorOf(const bus::VelocityCommand& command) const
{
  double factor = 1.0;
  for (const auto& target : command.targets)
  {
    const InverterFacts& facts = scene_.inverters[target.first];
    if (facts.saturates && std::isfinite(target.second) && isBeyond(target.first, target.second))
    {
      factor = std::min(factor, facts.max_velocity / std::fabs(target.second));
    }
  }
  return factor;
}

void Checker::checkResult(TimePoint now, const bus::VelocityCommand& command, std::uint16_t result) const
{
  bool out_of_range = false;
  bool all_stop = true;
  const double factor = factorOf(command);
  for (const auto& target : command.targets)
  {
    const bool stops = target.second == 0.0 || isNearZero(target.first, target.second);
    const bool refused = isBeyond(target.first, target.second) && !scene_.inverters[target.first].saturates;
    const bool reduced_too_far = !stops && !refused && isNearZero(target.first, target.second * factor);
    out_of_range = out_of_range || !std::isfinite(target.second) || refused || reduced_too_far;
    all_stop = all_stop && stops;
  }
  // Contract, section 2: the end of the program is named before a value.
  const std::uint16_t refusal = shutting_down_ ? bus::ERROR_SHUTTING_DOWN : bus::ERROR_OUT_OF_RANGE;
  const bool repeat = std::any_of(command.targets.begin(), command.targets.end(), [&](const auto& target) {
    return std::isfinite(target.second) && isRepeat(lanes_[target.first], command.publisher);
  });
  if (out_of_range && result != refusal && !(repeat && result == 0))
  {
    fail(now, "NaN, infinity and what is out of range are refused", "answer " + std::to_string(result));
  }
  if (all_stop && result != 0)
  {
    fail(now, "a command of 0, or near it, is never refused", "answer " + std::to_string(result));
  }
}

void Checker::commanded(TimePoint now, const bus::VelocityCommand& command, std::uint16_t result)
{
  ++statistics_.commands;
  checkResult(now, command, result);
  bool repeat = false;
  for (const auto& target : command.targets)
  {
    const bool moves = target.second != 0.0 && std::isfinite(target.second) && !isNearZero(target.first, target.second);
    repeat = repeat || (moves && isRepeat(lanes_[target.first], command.publisher));
  }
  const double factor = factorOf(command);
  for (const auto& target : command.targets)
  {
    Lane& lane = lanes_[target.first];
    if (target.second == 0.0)
    {
      takeZero(now, target.first, command.publisher);
    }
    else if (isNearZero(target.first, target.second))
    {
      takeNearZero(now, target.first, command.publisher);
    }
    else if (result == 0 && !repeat)
    {
      accept(now, target.first, target.second * factor, command.publisher);
    }
    else if (!repeat)
    {
      book(now, lane, command.publisher, false);
      lane.refused_at = lane.refused_at ? lane.refused_at : now;
    }
  }
}

void Checker::takeRunOff(TimePoint now, Lane& lane, std::size_t index)
{
  if (lane.run_answered && !lane.stopping && online(index) && !lane.zero_due)
  {
    lane.zero_due = now;
  }
  lane.refused_at.reset();
  forbid(now, lane);
}

void Checker::takeZero(TimePoint now, std::size_t index, const bus::Publisher& publisher)
{
  Lane& lane = lanes_[index];
  book(now, lane, publisher, true);
  takeRunOff(now, lane, index);
}

/// For the lock it is as if nothing had come, but whoever sent it has been heard.
void Checker::takeNearZero(TimePoint now, std::size_t index, const bus::Publisher& publisher)
{
  Lane& lane = lanes_[index];
  lane.streams[publisher.name].topics.insert(publisher.topic);
  takeRunOff(now, lane, index);
}

/// Rule 4.2 from the messages alone: may this command have been accepted?
void Checker::accept(TimePoint now, std::size_t index, double velocity, const bus::Publisher& publisher)
{
  ++statistics_.accepted;
  Lane& lane = lanes_[index];
  if (!lane.open_at || lane.needs_no_fault)
  {
    fail(now, "a lock is forgotten",
         nameOf(index) + " takes a velocity " +
             (lane.needs_status       ? "before its first status, or while offline"
              : lane.needs_stop_reply ? "before its stop is confirmed"
                                      : "while it is tripped"));
  }
  const auto found = lane.streams.find(publisher.name);
  const bool known = found != lane.streams.end();
  Duration needed = std::max(seconds(scene_.inverters[index].command_timeout), seconds(SHORTEST_SILENCE_S));
  TimePoint since = *lane.open_at;
  if (known)
  {
    needed = std::max(needed, std::min(2 * found->second.spacing, seconds(LONGEST_SILENCE_S)));
    since = std::max(since, found->second.last);
  }
  const bool admitted = known && (found->second.neutral || found->second.admitted == lane.lock);
  if (!admitted && now - since < needed - seconds(TOLERANCE_S))
  {
    fail(now, "a lock is forgotten",
         nameOf(index) + " takes a velocity of " + publisher.name + ", who has not returned to neutral: silent for " +
             text(toSeconds(now - since)) + " s of " + text(toSeconds(needed)) + " s");
  }
  if (publisher.latched && publisher.first_on_connection && publisher.before_start && !known)
  {
    fail(now, "a lock is forgotten", nameOf(index) + " takes a message that was latched before the start");
  }
  book(now, lane, publisher, false);
  lane.streams[publisher.name].admitted = lane.lock;
  const double hertz = velocity * scene_.inverters[index].hz_per_unit;
  lane.settled = lane.settled && lane.permit && std::fabs(hertz - lane.hertz) < 1e-9;

  lane.hertz = hertz;
  lane.permit = true;
  lane.accepted_at = now;
  lane.refused_at.reset();
  lane.fed = now;
  lane.commander = publisher.name;
  lane.run_copies = 0;
  lane.set_copies = 0;
  lane.run_set_copies = 0;
  lane.zero_due.reset();
}
}  // namespace fuzz
}  // namespace inverter_bus

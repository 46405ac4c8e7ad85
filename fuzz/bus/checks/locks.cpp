// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/locks.h"

#include <algorithm>

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
namespace
{
constexpr double LONGEST_SILENCE_S = 5.0;  // contract, rule 4.2
}  // namespace

Locks::Locks(const Observed& observed, TimePoint start) : observed_(observed), lanes_(observed.inverters.size())
{
  for (Lane& lane : lanes_)
  {
    lane.locked_at = start;
  }
}

void Locks::lock(TimePoint now, std::size_t index, bool by_stop, bool stop_under_way)
{
  Lane& lane = lanes_[index];
  ++lane.lock;
  lane.locked_at = now;
  lane.open_at.reset();
  lane.needs_stop_reply = lane.needs_stop_reply || by_stop;
  lane.stop_under_way = stop_under_way;
  for (auto& admission : lane.admissions)
  {
    admission.second.neutral = false;
  }
}

void Locks::backdate(std::size_t index, TimePoint since)
{
  lanes_[index].locked_at = since;
  lanes_[index].open_at = since;
}

void Locks::tripped(std::size_t index, TimePoint since)
{
  for (const auto& stream : observed_.inverters[index].streams)
  {
    // A 0 that came between the two may have come after the lock.
    const TimePoint zeroed_at = stream.second.zeroed_at;
    lanes_[index].admissions[stream.first].neutral = zeroed_at > since && zeroed_at == stream.second.last;
  }
  backdate(index, since);
  lanes_[index].needs_no_fault = true;
}

void Locks::wentOffline(std::size_t index)
{
  lanes_[index].needs_status = true;
  lanes_[index].open_at.reset();
}

void Locks::hasStatus(std::size_t index, bool faulted)
{
  Lane& lane = lanes_[index];
  lane.needs_status = false;
  lane.needs_no_fault = lane.needs_no_fault && faulted;
}

void Locks::tryOpen(TimePoint now, std::size_t index)
{
  Lane& lane = lanes_[index];
  if (!lane.open_at && !lane.needs_status && !lane.needs_stop_reply)
  {
    // The silence counts from the stop where there was one, otherwise from the status.
    const TimePoint acknowledged = observed_.inverters[index].stop.acknowledged;
    const TimePoint confirmed = acknowledged > lane.locked_at ? acknowledged : lane.confirmed_at;
    lane.open_at = confirmed > lane.locked_at ? confirmed : now;
  }
}

void Locks::answered(TimePoint now, std::size_t index, const ReplyFacts& reply)
{
  const Exchange& exchange = observed_.exchange;
  if (reply.kind == ReplyFacts::Kind::LateStop)
  {
    noteStop(now, index, observed_.inverters[index].stop.sent, false);
    return;
  }
  if (exchange.facts.reads_run)
  {
    noteRunRead(now, index, reply.settlesRun());
  }
  if (exchange.facts.stop && reply.good)
  {
    noteStop(now, index, exchange.began, true);
  }
}

void Locks::noteRunRead(TimePoint now, std::size_t index, bool settled)
{
  Lane& lane = lanes_[index];
  const StopRecord& stop = observed_.inverters[index].stop;
  lane.needs_stop_reply = lane.needs_stop_reply && !lane.stop_under_way;
  tryOpen(now, index);
  const bool first = stop.acknowledged >= stop.sent && lane.confirmed_at < stop.acknowledged;
  lane.confirmed_at = settled && first ? now : lane.confirmed_at;
}

void Locks::noteStop(TimePoint now, std::size_t index, TimePoint sent_at, bool prompt)
{
  Lane& lane = lanes_[index];
  const bool older = sent_at < lane.locked_at && !(prompt && lane.stop_under_way);
  lane.needs_stop_reply = lane.needs_stop_reply && older;
  tryOpen(now, index);
}

void Locks::booked(std::size_t index, const std::string& publisher, bool zero)
{
  lanes_[index].admissions[publisher].neutral = zero;
}

void Locks::admitted(std::size_t index, const std::string& publisher)
{
  booked(index, publisher, false);
  lanes_[index].admissions[publisher].lock = lanes_[index].lock;
}

void Locks::check(TimePoint now, std::size_t index, const bus::Publisher& publisher)
{
  ++checked_;
  const Lane& lane = lanes_[index];
  if (!lane.open_at || lane.needs_no_fault)
  {
    fail(now, "a lock is forgotten",
         observed_.scene.title(index) + " takes a velocity " +
             (lane.needs_status       ? "before its first status, or while offline"
              : lane.needs_stop_reply ? "before its stop is confirmed"
                                      : "while it is tripped"));
  }
  checkNeutral(now, index, publisher);
  const bool known = observed_.inverters[index].streams.count(publisher.name) != 0;
  if (publisher.latched && publisher.first_on_connection && publisher.before_start && !known)
  {
    fail(now, "a lock is forgotten",
         observed_.scene.title(index) + " takes a message that was latched before the start");
  }
}

void Locks::checkNeutral(TimePoint now, std::size_t index, const bus::Publisher& publisher) const
{
  const Lane& lane = lanes_[index];
  const auto& streams = observed_.inverters[index].streams;
  const auto stream = streams.find(publisher.name);
  const double timeout = observed_.scene.inverters[index].command_timeout;
  Duration needed = std::max(seconds(timeout), seconds(SHORTEST_SILENCE_S));
  TimePoint since = *lane.open_at;
  if (stream != streams.end())
  {
    needed = std::max(needed, std::min(2 * stream->second.spacing, seconds(LONGEST_SILENCE_S)));
    since = std::max(since, stream->second.last);
  }
  const auto admission = lane.admissions.find(publisher.name);
  const bool admitted =
      admission != lane.admissions.end() && (admission->second.neutral || admission->second.lock == lane.lock);
  if (!admitted && now - since < needed - seconds(SILENCE_TOLERANCE_S))
  {
    fail(now, "a lock is forgotten",
         observed_.scene.title(index) + " takes a velocity of " + publisher.name +
             ", which has not returned to neutral: silent for " + decimal(toSeconds(now - since)) + " s of " +
             decimal(toSeconds(needed)) + " s");
  }
}

std::uint64_t Locks::checked() const
{
  return checked_;
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

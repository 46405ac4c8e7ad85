// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/waits.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
Waits::Waits(BusState& bus, Stops& stops, const Velocities& velocities, const Probes& probes)
  : bus_(bus), stops_(stops), velocities_(velocities), probes_(probes)
{
}

void Waits::noteAdapter(Duration latency)
{
  adapter_ = latency;
}

void Waits::note(const InFlight& current, const wire::Reply& reply)
{
  if (!current.request.expects_reply || reply.cut)
  {
    return;
  }
  Inverter& inverter = *bus_.inverters[current.inverter];
  ReplyTimes& times = inverter.reply_times;
  if (!isAnswered(reply))
  {
    times.missed();
    if (current.brief)
    {
      inverter.liveness.waitedBriefly(reply.sent_at);
    }
  }
  else if (!current.lasting && !current.may_be_late)
  {
    times.replied(reply.turnaround, reply.heard_after);
  }
}

void Waits::shorten(InFlight& current, const LineView& line) const
{
  const Inverter& inverter = *bus_.inverters[current.inverter];
  const bool a_stop_insists = std::any_of(bus_.inverters.begin(), bus_.inverters.end(), [](const auto& other) {
    return other->stop.pending() && !other->link.silent() && other->stop.attempts() >= STOP_ATTEMPTS_AT_ONCE;
  });
  const bool write = current.pick.what == Pick::What::Velocity && !current.resync;
  const bool stop = current.pick.what == Pick::What::Stop || current.pick.what == Pick::What::Broadcast;
  if (a_stop_insists && !stop && !write && !current.lasting && !inverter.reply_times.answers() &&
      !bus_.gateway.active())
  {
    const Duration brief = probes_.shortTimeout(inverter, line);
    current.brief = brief < current.request.response_timeout;
    current.request.response_timeout = std::min(current.request.response_timeout, brief);
  }
}

std::optional<Duration> Waits::cutAfter(const InFlight& current) const
{
  // To an offline inverter a stop is its probe (contract, 3.3), and gives way like one.
  const Inverter& inverter = *bus_.inverters[current.inverter];
  const bool frame_of_a_stop = current.pick.what == Pick::What::Stop && !inverter.link.offline();
  const bool zero = current.pick.what == Pick::What::Velocity && !current.moves;
  const bool stop_word = current.keeps_alive && !current.may_start;
  const bool stop = frame_of_a_stop || zero || stop_word || current.pick.what == Pick::What::Broadcast;
  // A loop-back that goes in its place writes nothing.
  const bool lasting = current.lasting && !current.resync;
  if (bus_.gateway.active() || stop || lasting || !current.request.expects_reply)
  {
    return std::nullopt;
  }
  return inverter.reply_times.cutAfter(inverter.settings.replyDelay(), adapter_);
}

/// As printed at start-up, with what the drives and the adapter have shown since.
Duration Waits::worstStop() const
{
  Duration more{ 0 };
  for (const auto& inverter : bus_.inverters)
  {
    const Duration assumed = ReplyTimes().cutAfter(seconds(inverter->drive.profile().reply_delay), Duration{ 0 });
    more = std::max(more, inverter->reply_times.cutAfter(inverter->settings.replyDelay(), adapter_) - assumed);
  }
  return bus_.budget.worst_stop + more + adapter_;
}

bool Waits::stopWaits(TimePoint now, const std::optional<InFlight>& current)
{
  // A silence is noticed in the middle of a wait, too.
  stops_.checkWatchdogs(now);
  return std::any_of(bus_.inverters.begin(), bus_.inverters.end(),
                     [&](const auto& inverter) { return current ? ends(*inverter, *current) : stopIsNext(*inverter); });
}

/// One that is tried at once.
bool Waits::stopIsNext(const Inverter& inverter) const
{
  const unsigned at_once = inverter.link.silent() ? 1 : STOP_ATTEMPTS_AT_ONCE;
  return inverter.stop.pending() && inverter.stop.attempts() < at_once;
}

/// One that was requested since \p current was chosen: a stop that keeps trying lets others through on purpose.
bool Waits::ends(const Inverter& inverter, const InFlight& current) const
{
  const bool may_start_it = current.may_start && !current.resync && current.inverter == inverter.index;
  const bool needless = inverter.stop.repeats() && !inverter.movement.runPossible();
  const bool probe_of_a_probe = current.pick.what == Pick::What::Stop && inverter.link.offline();
  if (may_start_it || needless || probe_of_a_probe)
  {
    return false;
  }
  return inverter.stop.askedSince(current.chosen_at) || velocities_.zeroAskedSince(inverter.index, current.chosen_at);
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/stops.h"

#include <algorithm>

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
/// The stop of this drive to all stations; nothing: its profile has none.
std::optional<wire::Request> broadcastStop(const drive::Drive& drive)
{
  const drive::Sequence* stop = drive.sequence("stop");
  if (stop == nullptr)
  {
    return std::nullopt;
  }
  const drive::Step& step = stop->steps.front();
  return drive.broadcast(step.point, step.value.value_or(0));
}
}  // namespace

/// Address 0 is executed by every drive, and the same register means something else on each brand.
bool Stops::broadcastIsSafe() const
{
  const drive::Drive& first = bus_.inverters.front()->drive;
  const auto stop_frame = [](const drive::Drive& drive) {
    const auto request = broadcastStop(drive);
    return request ? request->pdu : wire::Bytes();
  };
  // Its answer could pass for a single stop's where a gateway does not keep numbers and units.
  return bus_.connected && bus_.inverters.size() > 1 && !stop_frame(first).empty() &&
         bus_.line_watch.facts().gateway_quirk.empty() &&
         std::all_of(bus_.inverters.begin(), bus_.inverters.end(), [&](const std::unique_ptr<Inverter>& inverter) {
           const drive::Profile& profile = inverter->drive.profile();
           return profile.name == first.profile().name && profile.broadcast_stop && !inverter->config.ownPort() &&
                  inverter->settings.identity() == Identity::Right && stop_frame(inverter->drive) == stop_frame(first);
         });
}

std::optional<InFlight> Stops::composeBroadcast(TimePoint now)
{
  // A stop of all that is requested again and again must not keep the single stops from being sent and confirmed.
  const bool again = broadcast_last_;
  broadcast_last_ = false;
  if (!broadcast_due_ || again)
  {
    return std::nullopt;
  }
  const bool kept = !bus_.gateway.free(now);
  if (kept && bus_.broadcast_waits)
  {
    // One is in the gateway already (contract, 8.8), and each inverter's own stop goes all the same.
    broadcast_due_ = false;
    return std::nullopt;
  }
  bus_.broadcast_waits = kept;
  broadcast_due_ = false;
  broadcast_last_ = true;
  Pick pick;
  pick.what = Pick::What::Broadcast;
  InFlight current = exchangeFor(pick);
  // broadcastIsSafe() has seen that there is one.
  current.request = *broadcastStop(bus_.inverters.front()->drive);
  return current;
}

/// The next frame of the stop of one inverter.
InFlight Stops::compose(const Pick& pick)
{
  Inverter& inverter = *bus_.inverters[pick.inverter];
  if (bus_.shutting_down && inverter.link.silent() && inverter.stop.written())
  {
    // Rule 4.4: its one frame is the stop itself.
    inverter.stop.writeAgain();
  }
  InFlight current = exchangeFor(pick);
  current.request = inverter.prepared(inverter.stop.next());
  return current;
}

/// The first byte of a frame of a stop leaves now.
void Stops::sent(TimePoint now, const InFlight& current)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  if (current.pick.what == Pick::What::Broadcast && !bus_.gateway.active())
  {
    noteLatency(now - broadcast_requested_);
  }
  if (current.pick.what == Pick::What::Stop && !current.resync)
  {
    traffic_.tellOfCostlyStop(inverter);
    const auto latency = inverter.stop.sent(now);
    // Behind a gateway the frame's way ends somewhere else (contract, 8.16). An inverter that can't be reached, or a port
    // that was gone, is no measure of the scheduler's latency.
    if (latency && !current.pick.probe && !bus_.gateway.active())
    {
      noteLatency(*latency);
    }
  }
}

/// The end of a frame of a stop, or of its read-back.
Ending Stops::ended(const InFlight& current, const wire::Reply& reply)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  turns_.finish(current, reply, false);
  if (!inverter.stop.pending())
  {
    // A fresh command replaced a stop by 0 while its frame was on the wire: write all words again.
    inverter.movement.forgetWords();
    return Ending::Nothing;
  }
  const bool write = !current.resync && !inverter.stop.written();
  if (reply.connection_closed && !inverter.link.offline() && !bus_.connection.closedAgain(current.inverter))
  {
    // It counts no try: the same frame goes first over the next connection. Closed again in its place, it is its station
    // that is silent.
    return write ? Ending::LostWrite : Ending::Lost;
  }
  noteGatewayLatency(current, reply);
  if (write && bus_.gateway.motionUntil(reply.sent_at, current.inverter))
  {
    inverter.stop.writeOnceMore();
    inverter.interlock.stopRequested();
    return Ending::Nothing;
  }
  const StopJob::Progress progress = inverter.stop.done(reply, current.may_be_late);
  if (write && reply.outcome == wire::Outcome::Ok && !current.may_be_late)
  {
    inverter.lost_writes.acknowledged();
  }
  if (!write && !current.resync && reply.outcome == wire::Outcome::Ok)
  {
    inverter.liveness.dataRead();
  }
  if (progress == StopJob::Progress::Confirmed)
  {
    confirmed(reply.finished_at, inverter);
  }
  if (isAnswered(reply))
  {
    // An offline inverter's stop is its probe, however politely it is refused.
    return reply.outcome == wire::Outcome::Exception ? Ending::Refused : Ending::Nothing;
  }
  return write ? Ending::LostStopWrite : Ending::Lost;
}

void Stops::noteGatewayLatency(const InFlight& current, const wire::Reply& reply)
{
  if (bus_.gateway.active() && isAnswered(reply))
  {
    const auto latency = bus_.inverters[current.inverter]->stop.answered(reply.finished_at);
    if (latency && !current.pick.probe)
    {
      noteLatency(*latency);
    }
  }
}

void Stops::noteLatency(Duration latency)
{
  latency_max_ = std::max(latency_max_, latency);
  const Duration in_gateway = traffic_.worstStop() - bus_.budget.worst_stop_uncut - turns_.longestReplyDelay();
  if (latency > turns_.longestExchange() + bus_.budget.stop_slack + in_gateway)
  {
    bus_.outbox.trace("stop took " + util::durationText(latency) + " to the wire");
  }
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/reply_guard.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
ReplyGuard::ReplyGuard(BusState& bus) : bus_(bus)
{
}

/// Rule 3.9: after a time-out nothing of the same shape is asked of this station before its late reply, or a loop-back
/// with a fresh number, has come. A stop's write is exempt: its read-back decides, or a second write after a loop-back.
bool ReplyGuard::makeSafe(TimePoint now, InFlight& current, const LineView& line)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  if (current.request.broadcast || line.mayAsk(current.request, now))
  {
    return true;
  }
  const bool stop_write = current.pick.what == Pick::What::Stop && !inverter.stop.written();
  current.may_be_late = stop_write;
  const bool last_frame = bus_.shutting_down && inverter.link.silent();
  if (stop_write && (last_frame || !inverter.stop.wantsClearLine()))
  {
    return true;
  }
  const auto loopback =
      inverter.loopbackUsable() ? inverter.drive.loopback(inverter.config.node, ++bus_.loopback_number) : std::nullopt;
  if (loopback)
  {
    const Duration timeout = current.request.response_timeout;
    current.request = inverter.prepared(*loopback);
    current.request.response_timeout = timeout;
    current.resync = true;
    current.loopback = true;
    return true;
  }
  if (current.pick.what == Pick::What::Stop)
  {
    return stop_write || readBackSafely(now, current, line);
  }
  const TimePoint allowed = std::max(line.mayAskAt(current.request, now), now + std::chrono::milliseconds(1));
  if (current.pick.what == Pick::What::Velocity)
  {
    // The other members of a group don't wait for it.
    bus_.scheduler.splitOff(current.pick.command, current.inverter, bus_.next_command++, allowed,
                            inverter.movement.target() && inverter.movement.target()->zero);
  }
  else if (current.pick.what == Pick::What::Service)
  {
    bus_.scheduler.postpone(current.pick.command, allowed);
  }
  else if (current.pick.what == Pick::What::Setting || current.pick.what == Pick::What::Connect)
  {
    // The status may have another shape.
    inverter.pauses.holdSettings(allowed);
  }
  else
  {
    const auto serve_by =
        current.pick.what == Pick::What::Refresh ? inverter.serveBy(bus_.budget.deadline_margin) : std::nullopt;
    const bool early = serve_by && *serve_by < allowed && spareRead(now, inverter, line);
    inverter.pauses.holdStatus(early ? std::max(*serve_by, now + std::chrono::milliseconds(1)) : allowed);
  }
  return false;
}

/// RUN that was read off in the late reply to another request is no proof: it is asked in another shape, or, where the
/// drive has none, the write goes again until the bar has ended.
bool ReplyGuard::readBackSafely(TimePoint now, InFlight& current, const LineView& line) const
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  for (auto read = inverter.drive.variantOf(*inverter.drive.runBlock()); read; read = inverter.drive.variantOf(*read))
  {
    wire::Request request = inverter.prepared(inverter.drive.read(inverter.config.node, *read));
    if (line.mayAsk(request, now))
    {
      request.response_timeout = current.request.response_timeout;
      current.request = request;
      return true;
    }
  }
  inverter.stop.writeAgain();
  return false;
}

/// A read that no late reply can answer; nothing: this drive has none.
std::optional<wire::Request> ReplyGuard::spareRead(TimePoint now, const Inverter& inverter, const LineView& line) const
{
  std::vector<drive::ReadBlock> reads = inverter.refresh.reads().blocks(StatusRead::Kind::Fast);
  const std::vector<drive::ReadBlock> slow = inverter.refresh.reads().blocks(StatusRead::Kind::Slow);
  reads.insert(reads.end(), slow.begin(), slow.end());
  for (std::optional<drive::ReadBlock> read : reads)
  {
    for (; read; read = inverter.drive.variantOf(*read))
    {
      const wire::Request request = inverter.drive.read(inverter.config.node, *read);
      if (line.mayAsk(request, now))
      {
        return request;
      }
    }
  }
  return std::nullopt;
}
}  // namespace bus
}  // namespace inverter_bus

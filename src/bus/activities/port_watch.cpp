// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/port_watch.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, 8.9: one line a minute.
constexpr double RESUMED_LOG_PERIOD_S = 60.0;
}  // namespace

PortWatch::PortWatch(BusState& bus, Stops& stops, Absences& absences, TelnetStops& telnet)
  : bus_(bus), stops_(stops), absences_(absences), telnet_(telnet)
{
}

void PortWatch::opened(TimePoint now)
{
  bus_.connected = true;
  bus_.opened_at = now;
  works_ = false;
  ++opens_;
  bus_.link.opened(now);
  telnet_.opened();
  last_unanswered_.reset();
  const bool same = bus_.connection.resuming() || renewing_;
  renewing_ = false;
  // Connections that are closed again and again must not be a way round the probes' share (contract, 8.9).
  bus_.scheduler.restartCycle(now, !same && bus_.connection.closedUnused() == 0);
  bus_.connection.opened(now, onlineInverters());
  if (!failing_ && !same)
  {
    complained_ = false;
    error_.clear();
    bus_.last_error = 0;
    bus_.outbox.log(Level::Ok, "port " + bus_.configuration.bus.port + " is open", PORT_SUBJECT);
  }
  for (const auto& inverter : bus_.inverters)
  {
    inverter->pauses.holdStatus(now);
    if (!inverter->link.known())
    {
      inverter->liveness.watchFrom(now);
    }
  }
}

/// Something was read from it, or it has been open for long: an adapter with I/O errors opens too.
void PortWatch::works()
{
  works_ = true;
  if (failing_)
  {
    failing_ = false;
    complained_ = false;
    error_.clear();
    bus_.outbox.log(Level::Ok, "port " + bus_.configuration.bus.port + " works again", PORT_SUBJECT);
  }
}

void PortWatch::missing(TimePoint now, const std::string& error, bool in_use)
{
  if (bus_.connection.resuming() && bus_.connection.notOpen(now) == ConnectionWatch::Verdict::Resume)
  {
    return;
  }
  const bool news = bus_.connected || !complained_;
  bus_.connected = false;
  renewing_ = false;
  bus_.last_error = wire::ERROR_PORT_LOST;
  failing_ = false;
  error_ = error;
  if (news)
  {
    // Even if it was reported before: what has answered over a connection since then is gone now.
    complained_ = true;
    bus_.outbox.log(in_use ? Level::Warn : Level::Error,
                    error + (in_use ? "; trying again for a while" : "; the node keeps trying"), PORT_SUBJECT);
    lost(now);
  }
}

void PortWatch::pending(TimePoint now)
{
  if (bus_.connection.resuming() && bus_.connection.notOpen(now) == ConnectionWatch::Verdict::Lost)
  {
    lost(now);
  }
}

void PortWatch::closed(TimePoint now)
{
  if (!resumes(now, std::nullopt))
  {
    lost(now);
  }
}

void PortWatch::lost(TimePoint now)
{
  const std::string& port = bus_.configuration.bus.port;
  const bool unused = !works_;
  if (unused && bus_.configuration.bus.gateway)
  {
    const std::string& words = bus_.line_watch.facts().peer_words;
    fails(now, "port " + port + " is closed by the other end as soon as it is opened" +
                   (words.empty() ? "" : ", which says '" + words + "'") +
                   ": another client may hold it, or it serves another protocol mode");
    return;
  }
  fails(now, "port " + port +
                 (unused                           ? " can be opened, but fails in use: see dmesg, check the adapter"
                  : bus_.configuration.bus.gateway ? " is gone"
                                                   : " is gone: plug it in"));
}

/// \p error says what is wrong with it, once.
void PortWatch::fails(TimePoint now, const std::string& error)
{
  bus_.connection.lost();
  bus_.gateway.connectionEnded(now);
  if (bus_.connected && !(failing_ && error_ == error))
  {
    failing_ = !works_ || bus_.line_watch.facts().telnet_found;
    error_ = error;
    bus_.outbox.log(Level::Error, error_ + "; the node keeps trying", PORT_SUBJECT);
    complained_ = true;
  }
  bus_.connected = false;
  bus_.last_error = wire::ERROR_PORT_LOST;
  stops_.dropBroadcast();
  absences_.loseEverybody(now, wire::ERROR_PORT_LOST);
}

void PortWatch::closedForTelnet(TimePoint now)
{
  bus_.connection.slowDown();
  fails(now, "port " + bus_.configuration.bus.port + " is a telnet server (telnet mode): set the port to raw");
}

/// The other end has closed the connection, in place of the answer of \p index or between two exchanges. True: it is opened
/// again at once, and nothing else happens.
bool PortWatch::resumes(TimePoint now, std::optional<std::size_t> index)
{
  if (!bus_.connected || bus_.line_watch.facts().last_loss != wire::Loss::ClosedByPeer)
  {
    bus_.connection.lost();
    return false;
  }
  // This node's own time-out may have passed before the gateway's.
  const ConnectionWatch::Verdict verdict = bus_.connection.closed(now, index ? index : last_unanswered_);
  if (verdict == ConnectionWatch::Verdict::TakenByAnother)
  {
    bus_.outbox.log(Level::Warn,
                    "port " + bus_.configuration.bus.port +
                        ": the other end closes the connection again and again: does another client use it?");
  }
  if (verdict != ConnectionWatch::Verdict::Resume)
  {
    return false;
  }
  bus_.gateway.connectionEnded(now);
  ++resumed_.times;
  if (!resumed_.logged_at || now - *resumed_.logged_at >= seconds(RESUMED_LOG_PERIOD_S))
  {
    bus_.outbox.log(
        Level::Ok,
        "port " + bus_.configuration.bus.port + ": the other end has closed the connection; it is opened again" +
            (resumed_.times > 1 ? " (" + std::to_string(resumed_.times) + " times since the last line)" : ""));
    resumed_.logged_at = now;
    resumed_.times = 0;
  }
  return true;
}

std::vector<std::size_t> PortWatch::onlineInverters() const
{
  std::vector<std::size_t> online;
  for (const auto& inverter : bus_.inverters)
  {
    if (!inverter->link.offline() && inverter->link.known())
    {
      online.push_back(inverter->index);
    }
  }
  return online;
}

/// After each exchange: which inverters answer over this connection.
void PortWatch::noteConnection(TimePoint now, const InFlight& current, const wire::Reply& reply)
{
  last_unanswered_.reset();
  if (isAnswered(reply))
  {
    bus_.connection.answered(now, current.inverter);
  }
  else
  {
    last_unanswered_ = current.inverter;
    bus_.connection.unanswered(current.inverter);
  }
  if (bus_.connection.nobodyAnswered())
  {
    bus_.outbox.log(Level::Error, "port " + bus_.configuration.bus.port + ": is open again, but no drive answers",
                    PORT_SUBJECT);
    bus_.connection.lost();
    absences_.loseEverybody(now, wire::ERROR_TIMEOUT);
  }
}

void PortWatch::renewing(TimePoint now)
{
  if (bus_.link.renewing(now))
  {
    bus_.outbox.log(Level::Warn,
                    "port " + bus_.configuration.bus.port +
                        ": is open, but no drive answers any more: it is reopened from time to time while that lasts",
                    PORT_SUBJECT);
  }
  // So long without an answer is no gap any more: whatever runs is to be stopped first when a drive answers again.
  absences_.loseEverybody(now, wire::ERROR_TIMEOUT);
  bus_.connection.lost();
  bus_.gateway.connectionEnded(now);
  renewing_ = true;
}

void PortWatch::reopening(TimePoint now)
{
  bus_.connection.reopening(now);
  bus_.gateway.connectionEnded(now);
}

bool PortWatch::usable() const
{
  return bus_.connected && !failing_;
}

std::uint64_t PortWatch::reconnects() const
{
  return opens_ == 0 ? 0 : opens_ - 1;
}

const std::string& PortWatch::error() const
{
  return error_;
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/bus_loop.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
// An adapter that is plugged in again is found within this time.
constexpr double OPEN_PERIOD_S = 0.2;
// A connection that its other end has closed is retried at this period for as long as motors run on.
constexpr double RESUME_PERIOD_S = 0.05;
// Every try moves the RTS line of the process that has the port.
constexpr double IN_USE_PERIOD_S = 1.0;
constexpr double IN_USE_PATIENCE_S = 30.0;
// The adapter may be set while the bus runs.
constexpr double ADAPTER_PERIOD_S = 5.0;

/// What the coordinator may ask of a line.
class ViewOfLine final : public LineView
{
public:
  explicit ViewOfLine(const wire::Line& line) : line_(line)
  {
  }
  TimePoint mayAskAt(const wire::Request& request, TimePoint now) const override
  {
    return line_.mayAskAt(request, now);
  }
  Duration cost(const wire::Request& request) const override
  {
    return line_.cost(request, Duration{ 0 });
  }
  Duration costUnanswered(const wire::Request& request) const override
  {
    return line_.costUnanswered(request);
  }

private:
  const wire::Line& line_;
};

LineFacts factsOf(const wire::Line& line)
{
  LineFacts facts;
  facts.counters = line.counters();
  facts.echo_found = line.echoFound();
  facts.gateway_quirk = line.gatewayQuirk();
  facts.telnet_found = line.telnetFound();
  facts.proven_since_open = line.provenSinceOpen();
  facts.last_loss = line.lastLoss();
  facts.peer_words = line.peerWords();
  return facts;
}
}  // namespace

BusLoop::BusLoop(Coordinator& coordinator, wire::Line& line, util::Clock& clock, std::mutex& mutex)
  : coordinator_(coordinator), line_(line), clock_(clock), mutex_(mutex)
{
  give_way_.stop_waits = [this] {
    const std::lock_guard<std::mutex> guard(mutex_);
    return coordinator_.stopWaits(clock_.now());
  };
  give_way_.pause = line_.timing().briefPause();
}

bool BusLoop::portInUse() const
{
  return given_up_;
}

void BusLoop::close()
{
  line_.close();
}

TimePoint BusLoop::openPort()
{
  const TimePoint now = clock_.now();
  TimePoint not_before;
  {
    // Statuses go on at their pace, however seldom the port is tried.
    const std::lock_guard<std::mutex> guard(mutex_);
    coordinator_.tick(now);
    not_before = coordinator_.resuming() ? now : std::max(next_open_, coordinator_.openNotBefore());
  }
  if (now < not_before && !opening_)
  {
    return std::min(not_before, now + seconds(OPEN_PERIOD_S));
  }
  std::string error;
  const wire::OpenResult result = line_.open(error);
  opening_ = result == wire::OpenResult::Pending;
  if (!opening_)
  {
    next_open_ = now + seconds(result == wire::OpenResult::InUse ? IN_USE_PERIOD_S : OPEN_PERIOD_S);
  }
  const std::lock_guard<std::mutex> guard(mutex_);
  return noteOpening(result, error);
}

/// How an attempt to open the port ended, and when the next round is.
TimePoint BusLoop::noteOpening(wire::OpenResult result, const std::string& error)
{
  const TimePoint now = clock_.now();
  coordinator_.noteLine(now, factsOf(line_));
  switch (result)
  {
    case wire::OpenResult::Opened:
      ever_opened_ = true;
      coordinator_.portOpened(now);
      next_look_ = now;
      return now;
    case wire::OpenResult::Pending:
      coordinator_.portPending(now);
      return now;
    default:
      break;
  }
  const bool in_use = result == wire::OpenResult::InUse;
  coordinator_.portMissing(now, error, in_use);
  judgePatience(now, in_use);
  return now + seconds(coordinator_.resuming() ? RESUME_PERIOD_S : OPEN_PERIOD_S);
}

/// A port that this node has never had may stay with another process; one that it has had will come back.
void BusLoop::judgePatience(TimePoint now, bool in_use)
{
  if (!in_use || ever_opened_)
  {
    in_use_since_.reset();
    return;
  }
  in_use_since_ = in_use_since_ ? in_use_since_ : std::optional<TimePoint>(now);
  given_up_ = given_up_ || now - *in_use_since_ >= seconds(IN_USE_PATIENCE_S);
}

void BusLoop::lookAtAdapter()
{
  const TimePoint now = clock_.now();
  if (now < next_look_)
  {
    return;
  }
  next_look_ = now + seconds(ADAPTER_PERIOD_S);
  const std::optional<wire::AdapterLatency> latency = line_.adapterLatency();
  // Time in the adapter is no pause of the drive.
  give_way_.pause = line_.timing().briefPause() + (latency ? latency->latency : Duration{ 0 });
  const std::lock_guard<std::mutex> guard(mutex_);
  coordinator_.noteAdapter(latency);
}

/// This node's own reasons to give up an open port and reopen it; true if there was one.
bool BusLoop::reopen()
{
  bool abandon = false;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    const TimePoint now = clock_.now();
    coordinator_.noteLine(now, factsOf(line_));
    if (coordinator_.telnetOver(now))
    {
      coordinator_.closedForTelnet(now);
      abandon = true;
    }
    else if (coordinator_.renewalDue(now))
    {
      coordinator_.renewing(now);
      // A moment, so that the other side sees it.
      next_open_ = now + seconds(OPEN_PERIOD_S);
      abandon = true;
    }
    else if (!line_.mustReopen().empty())
    {
      coordinator_.reopening(now);
      abandon = true;
    }
  }
  if (abandon)
  {
    line_.abandon();
  }
  return abandon;
}

TimePoint BusLoop::step()
{
  if (!line_.isOpen())
  {
    return openPort();
  }
  lookAtAdapter();
  // First the silence that every request needs, then the decision: what arrives meanwhile, above all a stop, is taken.
  const bool there = line_.settle(give_way_);
  if (there && reopen())
  {
    return clock_.now();
  }
  std::optional<Coordinator::Exchange> exchange;
  TimePoint wake;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    const TimePoint now = clock_.now();
    coordinator_.noteLine(now, factsOf(line_));
    for (const wire::LateReply& late : line_.takeLateReplies())
    {
      coordinator_.lateReply(now, late);
    }
    if (!there)
    {
      coordinator_.portClosed(now);
      coordinator_.tick(now);
    }
    else if ((exchange = coordinator_.next(now, ViewOfLine(line_), wake)))
    {
      coordinator_.sent(clock_.now());
    }
  }
  if (!there)
  {
    line_.close();
    return clock_.now();
  }
  if (!exchange)
  {
    return wake;
  }
  give_way_.silence = exchange->cut_after.value_or(Duration{ 0 });
  const wire::Reply reply =
      line_.exchange(exchange->request, exchange->turnaround, exchange->cut_after ? give_way_ : wire::GiveWay());
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    coordinator_.noteLine(clock_.now(), factsOf(line_));
    coordinator_.done(reply);
  }
  if (reply.outcome == wire::Outcome::PortLost)
  {
    // One that lasted is opened again at once, one that fails as soon as it is open (I/O errors) at the period's pace.
    line_.close();
  }
  return clock_.now();
}
}  // namespace bus
}  // namespace inverter_bus

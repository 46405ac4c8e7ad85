// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/wire/line.h"

#include <algorithm>
#include <utility>

#include "wire/line/line_waiting.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
/// What a reply may exceed its computed length by: characters (noise before it) and time (delivery by the adapter, or the
/// pause that is allowed for if that is longer).
constexpr double REPLY_SLACK_CHARACTERS = 16.0;
constexpr std::chrono::milliseconds REPLY_SLACK{ 30 };
/// How long a stop may stay unnoticed while a wait could be cut.
constexpr std::chrono::milliseconds LOOK_PERIOD{ 1 };
}  // namespace

Line::Line(Port& port, Protocol& protocol, util::Clock& clock, LineTiming timing)
  : port_(port), protocol_(protocol), clock_(clock), timing_(timing)
{
  if (protocol_.gatewayGapCharacters() > 0.0)
  {
    gateway_.emplace();
  }
}

void Line::setFrameObserver(FrameObserver observer)
{
  observer_ = std::move(observer);
}

OpenResult Line::open(std::string& error)
{
  const OpenResult result = port_.open(error);
  if (result != OpenResult::Opened)
  {
    return result;
  }
  buffer_.clear();
  damaged_.clear();
  bars_.clear();
  echo_.forget();
  silent_request_.reset();
  telnet_.forget();
  words_.forget();
  last_loss_ = Loss::None;
  proven_ = false;
  behind_reply_ = false;
  if (gateway_)
  {
    gateway_->opened();
  }
  // Another master's frame may have been under way.
  last_use_at_ = clock_.now();
  ready_at_ = last_use_at_ + gap();
  return result;
}

void Line::close()
{
  port_.close();
}

void Line::abandon()
{
  port_.abandon();
}

bool Line::isOpen() const
{
  return port_.isOpen();
}

TimePoint Line::readyAt() const
{
  return ready_at_;
}

bool Line::settle(const GiveWay& give_way)
{
  return settleFor(Duration{ 0 }, give_way);
}

bool Line::mayAsk(const Request& request) const
{
  // One look at the clock: two of them would differ.
  const TimePoint now = clock_.now();
  return mayAskAt(request, now) <= now;
}

TimePoint Line::mayAskAt(const Request& request) const
{
  return mayAskAt(request, clock_.now());
}

TimePoint Line::mayAskAt(const Request& request, TimePoint now) const
{
  const std::string shape = protocol_.shape(request);
  return gateway_ ? gateway_->mayAskAt(shape, now) : std::max(bars_.barredUntil(shape), now);
}

Reply Line::exchange(const Request& request, Duration turnaround_after, const GiveWay& give_way)
{
  flushIdle();
  Reply reply;
  // What ends before it has begun took no time.
  reply.sent_at = clock_.now();
  if (request.quiet_before > Duration{ 0 } && !settleFor(request.quiet_before, give_way))
  {
    lose(reply);
    return reply;
  }
  silent_request_.reset();
  const Bytes frame = protocol_.frame(request);
  if (!send(frame, reply))
  {
    lose(reply);
    return reply;
  }
  expectEcho(request, frame);
  Waiting waiting = startWaiting(request, reply.sent_at, give_way);
  waiting.shape = protocol_.shape(request);
  noteAsked(waiting, reply);
  last_use_at_ = waiting.request_end;
  ready_at_ = waiting.request_end + (request.broadcast ? std::max(gap(), turnaround_after) : gap());
  waitForReply(waiting, reply);
  return reply;
}

const LineCounters& Line::counters() const
{
  return counters_;
}

const LineTiming& Line::timing() const
{
  return timing_;
}

bool Line::echoFound() const
{
  return echo_.found();
}

Loss Line::lastLoss() const
{
  return last_loss_;
}

bool Line::provenSinceOpen() const
{
  return proven_;
}

bool Line::telnetFound() const
{
  return telnet_.found();
}

std::string Line::peerWords() const
{
  return words_.text();
}

std::vector<Outstanding> Line::outstanding() const
{
  return gateway_ ? gateway_->outstanding() : std::vector<Outstanding>();
}

bool Line::gatewayTrusted() const
{
  return gateway_ && gateway_->trusted();
}

std::string Line::gatewayQuirk() const
{
  return gateway_ ? gateway_->quirk() : "";
}

std::string Line::mustReopen() const
{
  return gateway_ && port_.isOpen() ? gateway_->mustReopen(clock_.now()) : "";
}

void Line::setGatewayTimeout(Duration timeout)
{
  if (gateway_)
  {
    gateway_->setTimeout(timeout);
  }
}

std::vector<LateReply> Line::takeLateReplies()
{
  return std::exchange(late_, {});
}

bool Line::send(const Bytes& frame, Reply& reply)
{
  reply.sent_at = clock_.now();
  if (!port_.isOpen() || !port_.send(telnet_.sent(frame)))
  {
    return false;
  }
  reply.ticket = ++counters_.requests;
  observe(FrameEvent::Kind::Request, frame, reply.sent_at);
  return true;
}

/// Enters what is under way into the gateway's record.
void Line::noteAsked(const Waiting& waiting, const Reply& reply)
{
  if (!gateway_)
  {
    return;
  }
  GatewayRecord::Asked asked;
  asked.ticket = reply.ticket;
  asked.number = protocol_.lastNumber();
  asked.station = waiting.request.station;
  asked.shape = waiting.shape;
  asked.sent_at = reply.sent_at;
  asked.request_end = waiting.request_end;
  asked.silent = waiting.request.broadcast || !waiting.request.expects_reply;
  asked.own_exceptions = waiting.request.own_exceptions;
  gateway_->asked(asked, reply.sent_at);
}

/// Has the echo of \p frame taken out where the adapter returns what it sends.
void Line::expectEcho(const Request& request, const Bytes& frame)
{
  if (gateway_ || port_.isNetwork())
  {
    // A server may answer a broadcast by its own frame, and no adapter is on the way.
    return;
  }
  const bool reply_may_equal =
      !request.broadcast && protocol_.parse(frame.data(), frame.size(), &request).kind == Parsed::Kind::Reply;
  echo_.expect(frame, reply_may_equal);
}

Line::Waiting Line::startWaiting(const Request& request, TimePoint sent_at, const GiveWay& give_way)
{
  Waiting waiting(request, give_way);
  waiting.sent_at = sent_at;
  // The UART sends on after the write has returned, unless the write had to wait for it.
  const auto request_length = static_cast<double>(protocol_.requestLength(request));
  waiting.request_end = std::max(sent_at + timing_.characters(request_length), clock_.now()) + gatewayGap();
  waiting.first_byte_deadline = waiting.request_end + gap();
  waiting.last_deadline = waiting.first_byte_deadline;
  if (request.expects_reply && !request.broadcast)
  {
    waiting.reply_length = protocol_.replyLength(request);
    const double characters = static_cast<double>(waiting.reply_length) + REPLY_SLACK_CHARACTERS;
    waiting.first_byte_deadline += heldBack(request) + request.reply_delay + request.response_timeout;
    const Duration slack = std::max<Duration>(REPLY_SLACK, patience());
    waiting.last_deadline = waiting.first_byte_deadline + timing_.characters(characters) + slack;
  }
  return waiting;
}

void Line::waitForReply(Waiting& waiting, Reply& reply)
{
  ReceiveResult result = ReceiveResult::Data;
  while (result == ReceiveResult::Data)
  {
    const bool nothing_came = buffer_.empty() && damaged_.empty();
    const TimePoint cut_from = waiting.cutFrom(nothing_came ? TimePoint() : last_byte_at_);
    result = receiveUnlessCut(waitUntil(waiting), cut_from, waiting.give_way, waiting.cut);
    if (consume(waiting, reply))
    {
      return;
    }
    if (clock_.now() >= waiting.last_deadline && result == ReceiveResult::Data)
    {
      result = ReceiveResult::Silence;
    }
  }
  if (result == ReceiveResult::Gone)
  {
    lose(reply);
    return;
  }
  giveUp(waiting, reply);
}

TimePoint Line::waitUntil(const Waiting& waiting) const
{
  const std::size_t pending = buffer_.size() + damaged_.size();
  if (pending == 0)
  {
    return waiting.first_byte_deadline;
  }
  const TimePoint rest = last_byte_at_ + patience();
  // A reply that broke off or was damaged will not come again; a few stray bytes say nothing about the reply yet.
  const bool echo_begun = !buffer_.empty() && echo_.holds(buffer_);
  const bool reply_was_here =
      waiting.begun || (!echo_begun && waiting.reply_length != 0 && pending >= waiting.reply_length);
  const bool may_be_a_frame = reply_was_here || !buffer_.empty();
  const TimePoint at_least = reply_was_here ? rest : waiting.first_byte_deadline;
  return std::min(may_be_a_frame ? std::max(at_least, rest) : at_least, waiting.last_deadline);
}

/// As receive(), but from \p from on \p cut becomes true, with Silence, as soon as a stop waits.
ReceiveResult Line::receiveUnlessCut(TimePoint deadline, TimePoint from, const GiveWay& give_way, bool& cut)
{
  // In short turns: so a stop needs no way to wake the port. A drive that answers in time is not affected.
  for (TimePoint look = from; give_way.stop_waits && look < deadline; look = clock_.now() + LOOK_PERIOD)
  {
    const ReceiveResult result = receive(look);
    if (result != ReceiveResult::Silence)
    {
      return result;
    }
    if (give_way.stop_waits())
    {
      cut = true;
      return ReceiveResult::Silence;
    }
  }
  return receive(deadline);
}

ReceiveResult Line::receive(TimePoint deadline)
{
  const bool was_empty = buffer_.empty();
  const std::size_t before = buffer_.size();
  const ReceiveResult result = port_.receive(buffer_, deadline);
  if (result == ReceiveResult::Data)
  {
    if (port_.isNetwork() && !gateway_)
    {
      telnet_.receive(buffer_, before);
    }
    behind_reply_ = behind_reply_ && clock_.now() <= last_byte_at_ + gap();
    last_byte_at_ = clock_.now();
    last_use_at_ = std::max(last_use_at_, last_byte_at_);
    ready_at_ = std::max(ready_at_, last_byte_at_ + gap());
    head_at_ = was_empty ? last_byte_at_ : head_at_;
  }
  return result;
}

void Line::giveUp(Waiting& waiting, Reply& reply)
{
  reply.finished_at = clock_.now();
  if (gateway_ && (waiting.request.broadcast || !waiting.request.expects_reply))
  {
    gateway_->givenUp(reply.finished_at);
  }
  if (waiting.request.broadcast || !waiting.request.expects_reply)
  {
    // What the drive may still say is taken by the next settle().
    silent_request_ = waiting.request;
    reply.outcome = Outcome::Ok;
    return;
  }
  waiting.over = true;
  if (consume(waiting, reply))
  {
    return;
  }
  const bool damaged = waiting.foreign || !damaged_.empty();
  reportDamaged();
  reply.cut = waiting.cut;
  counters_.corrupt_replies += damaged && !reply.cut ? 1 : 0;
  counters_.timeouts += damaged || reply.cut ? 0 : 1;
  reply.outcome = damaged ? Outcome::Damaged : Outcome::Timeout;
  reply.error_id = damaged ? ERROR_DAMAGED : ERROR_TIMEOUT;
  if (gateway_)
  {
    gateway_->givenUp(reply.finished_at);
    return;
  }
  bars_.add(waiting.shape, waiting.request.station, { waiting.request_end, reply.ticket }, reply.finished_at);
}

/// The port has said that it is gone.
void Line::noteLoss()
{
  // The last words of the other end may explain it.
  skip(buffer_.size());
  reportDamaged();
  last_loss_ = port_.lastLoss();
  port_.close();
}

void Line::lose(Reply& reply)
{
  if (port_.isOpen())
  {
    noteLoss();
  }
  reply.outcome = Outcome::PortLost;
  reply.error_id = ERROR_PORT_LOST;
  reply.finished_at = clock_.now();
}

}  // namespace wire
}  // namespace inverter_bus

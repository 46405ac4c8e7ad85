// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/wire/line.h"

#include <algorithm>
#include <utility>

namespace inverter_bus
{
namespace wire
{
namespace
{
/// settle() gives up after this long: babble on the line cannot stop a stop.
constexpr std::chrono::milliseconds LONGEST_SETTLING{ 100 };
/// What a reply may exceed its computed length by: characters (noise before it) and time (delivery by the adapter, or the
/// pause that is allowed for if that is longer).
constexpr double REPLY_SLACK_CHARACTERS = 16.0;
constexpr std::chrono::milliseconds REPLY_SLACK{ 30 };
/// Station and function: from here on something is likelier to be a frame than noise.
constexpr std::size_t LIKELY_FRAME = 2;

/// The code of a Modbus exception by which a gateway says that the drive has not answered; 0: it is none.
std::uint8_t gatewayCode(const Parsed& answer, const ExceptionCodes& own)
{
  const bool modbus_exception = answer.pdu.size() == 2 && (answer.pdu[0] & 0x80) != 0;
  return modbus_exception && !own[answer.pdu[1]] ? answer.pdu[1] : std::uint8_t{ 0 };
}

Outcome outcomeOf(const Parsed& answer, std::uint8_t gateway_code)
{
  switch (answer.kind)
  {
    case Parsed::Kind::Reply:
      return Outcome::Ok;
    case Parsed::Kind::NotUnderstood:
      return Outcome::Damaged;
    default:
      return gateway_code != 0 ? Outcome::Timeout : Outcome::Exception;
  }
}
}  // namespace

/// An exchange whose request has been sent.
struct Line::Waiting
{
  explicit Waiting(const Request& asked) : request(asked)
  {
  }

  const Request& request;
  /// What the request is remembered by if it gets lost.
  std::string shape;
  TimePoint sent_at;
  TimePoint request_end;
  /// The first byte must have come by then.
  TimePoint first_byte_deadline;
  /// Everything must have.
  TimePoint last_deadline;
  std::size_t reply_length = 0;
  /// Estimated beginning of the bytes that are in the buffer, once there are any.
  std::optional<TimePoint> first_byte_at;
  /// The awaited reply has begun.
  bool begun = false;
  /// A valid frame came that nobody here had asked for.
  bool foreign = false;
  /// No further bytes will come: the beginning of a frame will not become one.
  bool over = false;
};

Line::Line(Port& port, Protocol& protocol, Clock& clock, LineTiming timing)
  : port_(port), protocol_(protocol), clock_(clock), timing_(timing)
{
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
  last_loss_ = Loss::None;
  proven_ = false;
  // Somebody else's frame may have been under way.
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

bool Line::settle()
{
  return settle(Duration{ 0 });
}

/// \p quiet silence to wait for beyond readyAt().
bool Line::settle(Duration quiet)
{
  if (!port_.isOpen())
  {
    return false;
  }
  const auto quiet_at = [this, quiet] { return std::max(ready_at_, last_use_at_ + quiet); };
  const TimePoint give_up = std::max(clock_.now(), quiet_at()) + LONGEST_SETTLING;
  ReceiveResult result = ReceiveResult::Data;
  while (result == ReceiveResult::Data)
  {
    // The rest of a late reply that an adapter delivers in pieces must not run into the next exchange.
    const bool half_a_frame = buffer_.size() >= LIKELY_FRAME;
    const TimePoint rest = half_a_frame ? last_byte_at_ + patience() : ready_at_;
    result = receive(std::min(std::max(quiet_at(), rest), give_up));
    consumeIdle();
    result = result == ReceiveResult::Data && clock_.now() >= give_up ? ReceiveResult::Silence : result;
  }
  flushIdle();
  ready_at_ = std::min(ready_at_, clock_.now());
  if (result == ReceiveResult::Gone)
  {
    noteLoss();
  }
  return result == ReceiveResult::Silence;
}

bool Line::mayAsk(const Request& request) const
{
  return bars_.barredUntil(protocol_.shape(request)) <= clock_.now();
}

TimePoint Line::mayAskAt(const Request& request) const
{
  return std::max(bars_.barredUntil(protocol_.shape(request)), clock_.now());
}

Reply Line::exchange(const Request& request, Duration turnaround_after)
{
  flushIdle();
  Reply reply;
  if (request.quiet_before > Duration{ 0 } && !settle(request.quiet_before))
  {
    lose(reply);
    return reply;
  }
  silent_request_.reset();
  const std::string shape = protocol_.shape(request);
  const Bytes frame = protocol_.frame(request);
  if (!send(frame, reply))
  {
    lose(reply);
    return reply;
  }
  expectEcho(request, frame);
  Waiting waiting = startWaiting(request, reply.sent_at);
  waiting.shape = shape;
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
  return false;
}

std::string Line::peerWords() const
{
  return "";
}

std::vector<Outstanding> Line::outstanding() const
{
  return {};
}

std::string Line::gatewayQuirk() const
{
  return "";
}

std::string Line::mustReopen() const
{
  return "";
}

void Line::setGatewayTimeout(Duration timeout)
{
  gateway_timeout_ = timeout;
}

std::vector<LateReply> Line::takeLateReplies()
{
  return std::exchange(late_, {});
}

bool Line::send(const Bytes& frame, Reply& reply)
{
  reply.sent_at = clock_.now();
  if (!port_.isOpen() || !port_.send(frame))
  {
    return false;
  }
  reply.ticket = ++counters_.requests;
  observe(FrameEvent::Kind::Request, frame, reply.sent_at);
  return true;
}

/// Has the echo of \p frame taken out where the adapter returns what it sends.
void Line::expectEcho(const Request& request, const Bytes& frame)
{
  const bool reply_may_equal =
      !request.broadcast && protocol_.parse(frame.data(), frame.size(), &request).kind == Parsed::Kind::Reply;
  echo_.expect(frame, reply_may_equal);
}

Line::Waiting Line::startWaiting(const Request& request, TimePoint sent_at)
{
  Waiting waiting(request);
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
    result = receive(waitUntil(waiting));
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

ReceiveResult Line::receive(TimePoint deadline)
{
  const bool was_empty = buffer_.empty();
  const ReceiveResult result = port_.receive(buffer_, deadline);
  if (result == ReceiveResult::Data)
  {
    last_byte_at_ = clock_.now();
    last_use_at_ = std::max(last_use_at_, last_byte_at_);
    ready_at_ = std::max(ready_at_, last_byte_at_ + gap());
    head_at_ = was_empty ? last_byte_at_ : head_at_;
  }
  return result;
}

bool Line::consume(Waiting& waiting, Reply& reply)
{
  stripEcho();
  if (!waiting.first_byte_at && !buffer_.empty())
  {
    waiting.first_byte_at = last_byte_at_ - timing_.characters(static_cast<double>(buffer_.size()));
  }
  waiting.begun = false;
  std::size_t before = 0;
  while (!buffer_.empty() && buffer_.size() != before && (waiting.over || !echo_.holds(buffer_)))
  {
    before = buffer_.size();
    if (consumeHead(waiting, reply))
    {
      return true;
    }
  }
  if (buffer_.empty())
  {
    // It was noise, or somebody else's.
    waiting.first_byte_at.reset();
  }
  return false;
}

bool Line::consumeHead(Waiting& waiting, Reply& reply)
{
  const Parsed parsed = protocol_.parse(buffer_.data(), buffer_.size(), &waiting.request);
  switch (parsed.kind)
  {
    case Parsed::Kind::Incomplete:
      waiting.begun = parsed.own;
      skip(waiting.over ? 1 : 0);
      return false;
    case Parsed::Kind::Garbage:
      skip(parsed.consumed);
      return false;
    case Parsed::Kind::Late:
    case Parsed::Kind::Foreign:
      waiting.foreign |= !noteUnasked(parsed, take(parsed.consumed));
      return false;
    case Parsed::Kind::Reply:
    case Parsed::Kind::Exception:
    case Parsed::Kind::NotUnderstood:
      return answer(waiting, parsed, take(parsed.consumed), reply);
  }
  return false;
}

bool Line::answer(Waiting& waiting, const Parsed& parsed, const Bytes& raw, Reply& reply)
{
  const bool exception = parsed.kind != Parsed::Kind::Reply;
  // An exception repeats neither address nor count: it could as well be the late answer to a lost request of this
  // function. Refused here, for "never repeated" must not come from another request's reply.
  if (exception && bars_.mayBeLate(protocol_.shapeOfReply(parsed), clock_.now()))
  {
    ++counters_.late_replies;
    observe(FrameEvent::Kind::Late, raw, clock_.now());
    return false;
  }
  accept(waiting, parsed, raw, reply);
  return true;
}

void Line::accept(const Waiting& waiting, const Parsed& parsed, const Bytes& raw, Reply& reply)
{
  echo_.answered(damaged_.empty());
  reportDamaged();
  reply.gateway_code = gatewayCode(parsed, waiting.request.own_exceptions);
  reply.outcome = outcomeOf(parsed, reply.gateway_code);
  noteAnswer(reply.outcome, parsed, raw);
  proven_ = true;
  if (parsed.kind == Parsed::Kind::Reply && protocol_.isLoopback(waiting.request) && mayAsk(waiting.request))
  {
    bars_.lift(parsed.station, waiting.sent_at);
  }
  reply.pdu = parsed.pdu;
  reply.error_id = reply.gateway_code != 0 ? ERROR_TIMEOUT : parsed.error_id;
  reply.finished_at = last_byte_at_;
  reply.turnaround = std::max(Duration{ 0 }, *waiting.first_byte_at - waiting.request_end);
}

void Line::noteAnswer(Outcome outcome, const Parsed& parsed, const Bytes& raw)
{
  const bool normal = parsed.kind == Parsed::Kind::Reply;
  observe(normal ? FrameEvent::Kind::Reply : FrameEvent::Kind::Exception, raw, last_byte_at_);
  switch (outcome)
  {
    case Outcome::Damaged:
      ++counters_.corrupt_replies;
      return;
    case Outcome::Timeout:
      ++counters_.timeouts;
      return;
    default:
      ++counters_.replies;
      counters_.exceptions += normal ? 0 : 1;
  }
}

void Line::giveUp(Waiting& waiting, Reply& reply)
{
  reply.finished_at = clock_.now();
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
  ++(damaged ? counters_.corrupt_replies : counters_.timeouts);
  reply.outcome = damaged ? Outcome::Damaged : Outcome::Timeout;
  reply.error_id = damaged ? ERROR_DAMAGED : ERROR_TIMEOUT;
  bars_.add(waiting.shape, waiting.request.station, { waiting.request_end, reply.ticket }, reply.finished_at);
}

/// The port has said that it is gone.
void Line::noteLoss()
{
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

void Line::consumeIdle()
{
  stripEcho();
  std::size_t before = 0;
  while (!buffer_.empty() && buffer_.size() != before && !echo_.holds(buffer_))
  {
    before = buffer_.size();
    consumeIdleHead();
  }
}

void Line::flushIdle()
{
  consumeIdle();
  while (!buffer_.empty())
  {
    // Silence has ended what looked like the beginning of a frame.
    skip(1);
    consumeIdle();
  }
  reportDamaged();
}

void Line::consumeIdleHead()
{
  const Request* const request = silent_request_ ? &*silent_request_ : nullptr;
  const Parsed parsed = protocol_.parse(buffer_.data(), buffer_.size(), request);
  switch (parsed.kind)
  {
    case Parsed::Kind::Incomplete:
      return;
    case Parsed::Kind::Garbage:
      skip(parsed.consumed);
      return;
    case Parsed::Kind::Late:
    case Parsed::Kind::Foreign:
      noteUnasked(parsed, take(parsed.consumed));
      return;
    case Parsed::Kind::Reply:
    case Parsed::Kind::Exception:
    case Parsed::Kind::NotUnderstood:
      noteAnswer(outcomeOf(parsed, gatewayCode(parsed, request->own_exceptions)), parsed, take(parsed.consumed));
      return;
  }
}

void Line::stripEcho()
{
  counters_.echoes += echo_.strip(buffer_, damaged_) ? 1 : 0;
}

/// True if \p parsed is the late reply to a lost request, false if nobody here has asked for it.
bool Line::noteUnasked(const Parsed& parsed, const Bytes& raw)
{
  const auto late = bars_.take(protocol_.shapeOfReply(parsed), clock_.now());
  const bool own = late || parsed.kind == Parsed::Kind::Late;
  observe(own ? FrameEvent::Kind::Late : FrameEvent::Kind::Foreign, raw, last_byte_at_);
  ++(own ? counters_.late_replies : counters_.foreign_frames);
  if (late)
  {
    LateReply reply;
    reply.station = parsed.station;
    reply.gateway_code = gatewayCode(parsed, everyExceptionOfADrive());
    reply.exception = reply.gateway_code == 0 && parsed.error_id != 0;
    if (*late)
    {
      reply.ticket = (*late)->ticket;
    }
    // No longer time-out makes a drive answer that a gateway has given up.
    if (*late && reply.gateway_code == 0)
    {
      reply.delay = head_at_ - (*late)->request_end;
    }
    late_.push_back(reply);
  }
  return own;
}

void Line::observe(FrameEvent::Kind kind, const Bytes& bytes, TimePoint time)
{
  if (observer_)
  {
    observer_({ kind, time, bytes });
  }
}

void Line::reportDamaged()
{
  if (!damaged_.empty())
  {
    observe(FrameEvent::Kind::Damaged, damaged_, last_byte_at_);
    damaged_.clear();
  }
}

void Line::skip(std::size_t count)
{
  const auto end = buffer_.begin() + static_cast<std::ptrdiff_t>(count);
  damaged_.insert(damaged_.end(), buffer_.begin(), end);
  buffer_.erase(buffer_.begin(), end);
}

Bytes Line::take(std::size_t count)
{
  const auto end = buffer_.begin() + static_cast<std::ptrdiff_t>(count);
  Bytes bytes(buffer_.begin(), end);
  buffer_.erase(buffer_.begin(), end);
  head_at_ = last_byte_at_;
  return bytes;
}
}  // namespace wire
}  // namespace inverter_bus

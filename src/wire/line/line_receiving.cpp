// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What a line makes of the bytes that come: answers, late replies, strangers, noise.
#include <algorithm>
#include <utility>

#include "wire/line/line_waiting.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
/// settle() gives up after this long: babble on the line cannot stop a stop.
constexpr std::chrono::milliseconds LONGEST_SETTLING{ 100 };
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

/// \p quiet silence to wait for beyond readyAt().
bool Line::settleFor(Duration quiet, const GiveWay& give_way)
{
  if (!port_.isOpen())
  {
    return false;
  }
  const auto quiet_at = [this, quiet] { return std::max(ready_at_, last_use_at_ + quiet); };
  const TimePoint give_up = std::max(clock_.now(), quiet_at()) + LONGEST_SETTLING;
  ReceiveResult result = ReceiveResult::Data;
  consumeIdle();
  while (result == ReceiveResult::Data)
  {
    // The rest of a late reply that an adapter delivers in pieces must not run into the next exchange.
    const bool half_a_frame = buffer_.size() >= LIKELY_FRAME && !isSurplus();
    const TimePoint rest = half_a_frame ? last_byte_at_ + patience() : ready_at_;
    const TimePoint brief = half_a_frame ? last_byte_at_ + give_way.pause : ready_at_;
    bool cut = false;
    result =
        receiveUnlessCut(std::min(std::max(quiet_at(), rest), give_up), std::max(quiet_at(), brief), give_way, cut);
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

/// Nothing is owed that the bytes in the buffer could begin: they belong to the reply before them (a checksum behind a
/// Modbus TCP frame, the line's noise at the drive's letting go).
bool Line::isSurplus() const
{
  return gateway_ ? !gateway_->owes() : behind_reply_ && !bars_.owes(clock_.now());
}

bool Line::consume(Waiting& waiting, Reply& reply)
{
  counters_.echoes += echo_.strip(buffer_, damaged_) ? 1 : 0;
  if (!waiting.first_byte_at && !buffer_.empty())
  {
    waiting.first_byte_at = last_byte_at_ - timing_.characters(static_cast<double>(buffer_.size()));
    waiting.heard_at = last_byte_at_;
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
    // It was noise, or another master's frame.
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
  if (gateway_ && !gateway_->takes(answerOf(parsed)))
  {
    noteUnasked(parsed, raw);
    return false;
  }
  const bool exception = parsed.kind != Parsed::Kind::Reply;
  // An exception repeats neither address nor count: it could as well be the late answer to a lost request of this
  // function. Refused here, for "never repeated" must not come from another request's reply.
  if (!gateway_ && exception && bars_.mayBeLate(protocol_.shapeOfReply(parsed), clock_.now()))
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
  behind_reply_ = true;
  telnet_.proven();
  words_.forget();
  if (parsed.kind == Parsed::Kind::Reply && protocol_.isLoopback(waiting.request) && mayAsk(waiting.request))
  {
    bars_.lift(parsed.station, waiting.sent_at);
  }
  reply.pdu = parsed.pdu;
  reply.error_id = reply.gateway_code != 0 ? ERROR_TIMEOUT : parsed.error_id;
  reply.finished_at = last_byte_at_;
  reply.turnaround = std::max(Duration{ 0 }, *waiting.first_byte_at - waiting.request_end);
  reply.heard_after = std::max(Duration{ 0 }, Duration(waiting.heard_at - waiting.request_end));
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

void Line::consumeIdle()
{
  counters_.echoes += echo_.strip(buffer_, damaged_) ? 1 : 0;
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
    {
      if (gateway_)
      {
        gateway_->takeLate(answerOf(parsed));
      }
      // A protocol reports no reply where nothing was asked.
      const ExceptionCodes own = request != nullptr ? request->own_exceptions : everyExceptionOfADrive();
      noteAnswer(outcomeOf(parsed, gatewayCode(parsed, own)), parsed, take(parsed.consumed));
      return;
    }
  }
}

GatewayRecord::Answer Line::answerOf(const Parsed& parsed) const
{
  GatewayRecord::Answer answer;
  answer.number = parsed.transaction;
  answer.unit = parsed.station;
  answer.shape = protocol_.shapeOfReply(parsed);
  answer.exception = parsed.error_id != 0;
  return answer;
}

/// True if \p parsed is the late reply to a lost request, false if this node has not asked for it.
bool Line::noteUnasked(const Parsed& parsed, const Bytes& raw)
{
  const bool own = (gateway_ ? takeLateFromGateway(parsed) : takeLate(parsed)) || parsed.kind != Parsed::Kind::Foreign;
  observe(own ? FrameEvent::Kind::Late : FrameEvent::Kind::Foreign, raw, last_byte_at_);
  ++(own ? counters_.late_replies : counters_.foreign_frames);
  return own;
}

bool Line::takeLate(const Parsed& parsed)
{
  const auto late = bars_.take(protocol_.shapeOfReply(parsed), clock_.now());
  if (late)
  {
    noteLate(parsed, parsed.station, *late, gatewayCode(parsed, everyExceptionOfADrive()));
  }
  return late.has_value();
}

bool Line::takeLateFromGateway(const Parsed& parsed)
{
  const auto request = gateway_->takeLate(answerOf(parsed));
  if (request && !request->silent)
  {
    const ReplyBars::Lost lost{ request->request_end, request->ticket };
    noteLate(parsed, request->station, lost, gatewayCode(parsed, request->own_exceptions));
  }
  return request.has_value();
}

void Line::noteLate(const Parsed& parsed, std::uint8_t station, const ReplyBars::Late& lost, std::uint8_t gateway_code)
{
  LateReply reply;
  reply.station = station;
  reply.gateway_code = gateway_code;
  reply.exception = gateway_code == 0 && parsed.error_id != 0;
  reply.ticket = lost ? lost->ticket : 0;
  // No longer time-out makes a drive answer that a gateway has given up.
  if (lost && gateway_code == 0)
  {
    reply.delay = head_at_ - lost->request_end;
  }
  late_.push_back(reply);
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
    words_.add(damaged_);
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

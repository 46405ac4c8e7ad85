// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "line_run.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "checks.h"
#include "inverter_bus/wire/line.h"
#include "support/fake_port.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
using wire::Bytes;
using wire::FrameEvent;
using wire::Outcome;
using wire::Parsed;
using wire::Reply;
using wire::Request;

constexpr std::size_t MOST_EXCHANGES = 4;
constexpr std::array<unsigned, 4> BAUD_RATES{ 9600, 19200, 115200, 2400 };
constexpr unsigned BITS_PER_CHARACTER = 11;
/// Characters that an exchange may take with everything around it: request, reply, a gateway's wait for both, gaps.
constexpr double MOST_CHARACTERS = 1200.0;
/// Response time-out, settling and slack, all of them at their longest [s].
constexpr double LONGEST_WAIT = 1.0;
/// A reply that comes by then is in time whatever the request [ms].
constexpr std::uint8_t SURELY_IN_TIME = 50;

/// Some bytes and when they come.
struct Piece
{
  std::uint8_t after_ms;
  std::uint8_t kind;
  Bytes bytes;
};

bool isAnswer(Parsed::Kind kind)
{
  return kind == Parsed::Kind::Reply || kind == Parsed::Kind::Exception || kind == Parsed::Kind::NotUnderstood;
}

Bytes damaged(Bytes frame, const Bytes& how)
{
  if (how.size() >= 2)
  {
    frame[how[0] % frame.size()] ^= how[1];
  }
  return frame;
}

/// Something like the request, or its echo.
Bytes again(const Dialect& dialect, const Request& request, std::size_t number)
{
  Bytes bytes{ request.station };
  bytes.insert(bytes.end(), request.pdu.begin(), request.pdu.end());
  return dialect.seal(bytes, number);
}

Piece takePiece(const Dialect& dialect, const Request& request, std::size_t number, ByteSource& source)
{
  Piece piece;
  piece.after_ms = source.byte();
  piece.kind = source.byte() & 7;
  const Bytes bytes = source.bytes(source.byte());
  switch (piece.kind)
  {
    case 3:
      piece.bytes = dialect.seal(bytes, number);
      break;
    case 4:
      piece.bytes = dialect.reply(request, number, bytes);
      break;
    case 5:
      piece.bytes = again(dialect, request, number);
      break;
    case 6:
      piece.bytes = dialect.refusal(request, number, bytes.empty() ? 0 : bytes[0]);
      break;
    case 7:
      piece.bytes = damaged(dialect.reply(request, number, {}), bytes);
      break;
    default:
      piece.bytes = bytes;
  }
  return piece;
}

/// What parse() says of the bytes at the head, held against the dialect.
void checkParsed(const Dialect& dialect, const Parsed& parsed, const Request* request, std::size_t number,
                 const std::uint8_t* data, std::size_t size)
{
  require(parsed.consumed <= size, "more consumed than there is");
  require((parsed.consumed == 0) == (parsed.kind == Parsed::Kind::Incomplete), "no progress, or progress on a part");
  require(!parsed.own || (parsed.kind == Parsed::Kind::Incomplete && request != nullptr && !request->broadcast),
          "own, but nothing of ours is awaited");
  const Dialect::Answer answer =
      request == nullptr ? Dialect::Answer() : dialect.answerAt(*request, number, data, size);
  require(isAnswer(answer.kind) == isAnswer(parsed.kind), "an answer not seen, or one seen that is none");
  if (isAnswer(answer.kind))
  {
    require(parsed.kind == answer.kind && parsed.consumed == answer.length, "an answer taken for another one");
    require(parsed.error_id == answer.error_id, "a wrong error id");
  }
  if (isAnswer(parsed.kind) || parsed.kind == Parsed::Kind::Foreign || parsed.kind == Parsed::Kind::Late)
  {
    const Bytes frame(data, data + parsed.consumed);
    require(dialect.isFrame(data, parsed.consumed), "a frame that is none");
    require(parsed.pdu == dialect.contentOf(frame), "wrong content");
  }
  for (std::size_t place = 1; parsed.kind == Parsed::Kind::Garbage && request != nullptr && place < parsed.consumed;
       ++place)
  {
    require(!isAnswer(dialect.answerAt(*request, number, data + place, size - place).kind), "an answer thrown away");
  }
}

/// All of \p bytes through parse(), as Line does after silence, and every beginning of them once.
void parseAll(const Dialect& dialect, const wire::Protocol& protocol, const Request* request, std::size_t number,
              const Bytes& bytes)
{
  std::size_t place = 0;
  while (place < bytes.size())
  {
    const Parsed parsed = protocol.parse(bytes.data() + place, bytes.size() - place, request);
    checkParsed(dialect, parsed, request, number, bytes.data() + place, bytes.size() - place);
    protocol.shapeOfReply(parsed);
    place += std::max<std::size_t>(1, parsed.consumed);
  }
  const std::size_t step = 1 + bytes.size() / 8;
  for (std::size_t size = 0; size < bytes.size(); size += step)
  {
    const Bytes beginning(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    checkParsed(dialect, protocol.parse(beginning.data(), size, request), request, number, beginning.data(), size);
  }
}

class Run
{
public:
  Run(const Dialect& dialect, ByteSource& source)
    : dialect_(dialect)
    , source_(source)
    , options_(source.byte())
    , port_(clock_)
    , protocol_(dialect.makeProtocol())
    , parser_(dialect.makeProtocol())
    , timing_(BAUD_RATES[options_ & 3], BITS_PER_CHARACTER)
    , line_(port_, *protocol_, clock_, timing_)
  {
    if ((options_ & 4) != 0)
    {
      port_.echo(timing_.characters(1.0), 3);
    }
    line_.setFrameObserver([this](const FrameEvent& event) { note(event); });
    std::string error;
    line_.open(error);
  }

  void run()
  {
    for (std::size_t i = 0; i < MOST_EXCHANGES && !source_.empty() && line_.isOpen(); ++i)
    {
      exchange();
    }
    drain();
    require(line_.counters().requests == port_.sent().size(), "requests counted wrongly");
  }

private:
  void exchange()
  {
    const std::vector<Request>& requests = dialect_.requests();
    const Request& request = requests[source_.byte() % requests.size()];
    const std::uint8_t before = source_.byte();
    const std::vector<Piece> pieces = takePieces(request);
    if ((before & 2) != 0 && !pieces.empty())
    {
      deliver(pieces[0], clock_.now());
    }
    if ((before & 1) != 0)
    {
      clock_.sleepUntil(line_.mayAskAt(request));
    }
    if ((before & 12) == 12)
    {
      port_.unplug();
    }
    const bool clean = number_ == 1 && pieces.size() == 1 && pieces[0].kind == 4 &&
                       pieces[0].after_ms < SURELY_IN_TIME && before == 0 && (options_ & 4) == 0 &&
                       request.expects_reply;
    check(request, send(request, pieces, (before & 2) != 0 ? 1 : 0), clean);
  }

  std::vector<Piece> takePieces(const Request& request)
  {
    ++number_;
    std::vector<Piece> pieces;
    const int count = source_.byte() & 7;
    Bytes together;
    for (int i = 0; i < count && !source_.empty(); ++i)
    {
      pieces.push_back(takePiece(dialect_, request, number_, source_));
      together.insert(together.end(), pieces.back().bytes.begin(), pieces.back().bytes.end());
    }
    parser_->frame(request);
    parseAll(dialect_, *parser_, &request, number_, together);
    parseAll(dialect_, *parser_, nullptr, number_, together);
    return pieces;
  }

  Reply send(const Request& request, const std::vector<Piece>& pieces, std::size_t first)
  {
    const TimePoint start = clock_.now();
    Reply reply;
    reply.outcome = Outcome::PortLost;
    if (line_.settle())
    {
      countEchoes();
      wire::FakePort::Answers answers;
      for (std::size_t i = first; i < pieces.size(); ++i)
      {
        answers.push_back({ std::chrono::milliseconds(pieces[i].after_ms), pieces[i].bytes });
        delivered_ += pieces[i].bytes.size();
        last_arrival_ = std::max(last_arrival_, clock_.now() + answers.back().after + seconds(1.0));
      }
      port_.answerNext(answers);
      reply = line_.exchange(request, seconds(0.02));
      countEchoes();
    }
    const double limit = LONGEST_WAIT + toSeconds(timing_.characters(MOST_CHARACTERS));
    require(toSeconds(clock_.now() - start) <= limit, "an exchange took too long");
    return reply;
  }

  void deliver(const Piece& piece, TimePoint now)
  {
    port_.deliver(std::chrono::milliseconds(piece.after_ms), piece.bytes);
    delivered_ += piece.bytes.size();
    last_arrival_ = std::max(last_arrival_, now + std::chrono::milliseconds(piece.after_ms));
  }

  void check(const Request& request, const Reply& reply, bool clean)
  {
    require(!clean || reply.outcome == Outcome::Ok, "a good reply in time was not taken");
    const bool silent = request.broadcast || !request.expects_reply;
    if (reply.outcome == Outcome::PortLost)
    {
      require(!line_.isOpen(), "a lost port is still open");
      return;
    }
    if (reply.outcome == Outcome::Ok && !(silent && reply.pdu.empty()))
    {
      require(answered_.size() == 1, "not one answer");
      const auto answer = answerIn(request, answered_[0]);
      require(answer.kind == Parsed::Kind::Reply && reply.pdu == dialect_.contentOf(answered_[0]),
              "a reply that is not the answer to the request");
    }
    if (reply.outcome == Outcome::Exception)
    {
      require(answered_.size() == 1 && answerIn(request, answered_[0]).kind == Parsed::Kind::Exception,
              "an exception that the station did not send");
      require(reply.error_id == answerIn(request, answered_[0]).error_id, "a wrong error id from the line");
    }
    require((reply.error_id != 0) == (reply.outcome != Outcome::Ok), "an error without a number, or a number without");
  }

  Dialect::Answer answerIn(const Request& request, const Bytes& frame) const
  {
    const auto answer = dialect_.answerAt(request, number_, frame.data(), frame.size());
    return answer.length == frame.size() ? answer : Dialect::Answer();
  }

  void note(const FrameEvent& event)
  {
    ++events_;
    if (event.kind == FrameEvent::Kind::Request)
    {
      // What came before answers an earlier one that the drive may answer or not.
      answered_.clear();
      return;
    }
    observed_ += event.bytes.size();
    require(!event.bytes.empty(), "an event of nothing");
    if (event.kind == FrameEvent::Kind::Reply || event.kind == FrameEvent::Kind::Exception)
    {
      answered_.push_back(event.bytes);
    }
  }

  /// The echo of the frame that was sent last has been taken out.
  void countEchoes()
  {
    const std::uint64_t echoes = line_.counters().echoes;
    if (echoes != echoes_)
    {
      echoed_ += port_.sent().back().size();
      echoes_ = echoes;
    }
  }

  /// Every byte that came is in one frame or one report of damage, and in one only.
  void drain()
  {
    while (line_.isOpen() && clock_.now() < last_arrival_)
    {
      clock_.sleepUntil(std::min(last_arrival_, clock_.now() + seconds(0.2)));
      line_.settle();
      countEchoes();
    }
    line_.settle();
    line_.settle();
    countEchoes();
    std::size_t sent = 0;
    for (const Bytes& frame : port_.sent())
    {
      sent += (options_ & 4) != 0 ? frame.size() : 0;
    }
    const std::size_t seen = observed_ + echoed_;
    require(line_.isOpen() ? seen == delivered_ + sent : seen <= delivered_ + sent, "bytes lost or made up");
    require(events_ <= delivered_ + sent + 2 * port_.sent().size(), "more to log than came");
  }

  const Dialect& dialect_;
  ByteSource& source_;
  const std::uint8_t options_;
  wire::VirtualClock clock_;
  wire::FakePort port_;
  std::unique_ptr<wire::Protocol> protocol_;
  /// As many requests framed as by protocol_: for parse() alone.
  std::unique_ptr<wire::Protocol> parser_;
  wire::LineTiming timing_;
  wire::Line line_;
  std::size_t number_ = 0;
  std::size_t delivered_ = 0;
  std::size_t observed_ = 0;
  std::size_t echoed_ = 0;
  std::size_t events_ = 0;
  std::uint64_t echoes_ = 0;
  TimePoint last_arrival_;
  std::vector<Bytes> answered_;
};
}  // namespace

void runLine(const Dialect& dialect, const std::uint8_t* data, std::size_t size)
{
  ByteSource source(data, size);
  Run(dialect, source).run();
}
}  // namespace fuzz
}  // namespace inverter_bus

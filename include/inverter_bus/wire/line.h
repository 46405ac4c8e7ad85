// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_LINE_H
#define INVERTER_BUS_WIRE_LINE_H

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/wire/echo_filter.h"
#include "inverter_bus/wire/gateway_record.h"
#include "inverter_bus/wire/peer_words.h"
#include "inverter_bus/wire/protocol.h"
#include "inverter_bus/wire/reply_bars.h"
#include "inverter_bus/wire/telnet_filter.h"

namespace inverter_bus
{
namespace wire
{
/// How long things take on a serial line. All functions are pure.
class LineTiming
{
public:
  /// A serial port of this machine. The longest pause inside a reply is 25 ms (16 ms of a USB adapter's latency timer
  /// and some reserve), at low rates 18 characters: a 16550A whose FIFO reports up to 14 bytes at a time reports the rest
  /// after a silence of 4.
  /// \param baud_rate bits per second, > 0
  /// \param bits_per_character start, data, parity and stop bits: 9 to 12
  LineTiming(unsigned baud_rate, unsigned bits_per_character);
  /// \param baud_rate behind a gateway: that of the line
  /// \param pause longest that the way from the line to this program can put into a reply
  LineTiming(unsigned baud_rate, unsigned bits_per_character, Duration pause);

  /// Time of \p count characters on the wire.
  Duration characters(double count) const;
  /// Silence before a request: \p gap_characters; above 19200 baud a character counts as 0.5 ms, which makes the 1.75
  /// ms that Modbus over serial line V1.02, section 2.5.1.1 asks for in place of 3.5 characters.
  Duration gap(double gap_characters) const;
  /// Silence after which the rest of a frame that has begun will not come any more: the longest pause, and no less than
  /// the gap.
  Duration patience(double gap_characters) const;

  /// The longest pause inside a reply that a drive and a UART make: 5 ms, or the 18 characters after which the FIFO of a
  /// 16550A reports the next bytes if they are longer. Adapters and networks add theirs.
  Duration briefPause() const;

private:
  double character_s_;
  bool fast_;
  Duration pause_;
};

/// What ends a wait for a reply early: a stop (contract, 8.4).
struct GiveWay
{
  /// True: a stop waits for the line. Asked in the bus thread, again and again while nothing comes; it must be quick.
  /// Empty: every wait takes its full time.
  std::function<bool()> stop_waits;
  /// Silence after the request's last byte within which the reply is waited for all the same.
  Duration silence{ 0 };
  /// The same inside a reply, after the last byte that came.
  Duration pause{ 0 };
};

/// A frame that passed the line, for the flight recorder.
struct FrameEvent
{
  enum class Kind
  {
    Request,
    Reply,
    Exception,
    /// Bytes that were no valid frame.
    Damaged,
    /// The answer to an earlier request that had timed out.
    Late,
    /// A valid frame that this node did not ask for.
    Foreign
  };
  Kind kind;
  TimePoint time;
  Bytes bytes;
};

/// Counters of one line since start (uint64: never wrap in practice).
struct LineCounters
{
  std::uint64_t requests = 0;
  std::uint64_t replies = 0;          ///< valid replies, exceptions included
  std::uint64_t timeouts = 0;         ///< a gateway's exceptions 0AH and 0BH included
  std::uint64_t corrupt_replies = 0;  ///< damaged in either direction
  std::uint64_t exceptions = 0;
  std::uint64_t late_replies = 0;
  std::uint64_t foreign_frames = 0;  ///< frames that this node did not ask for: a second master
  std::uint64_t echoes = 0;          ///< exchanges whose local echo was removed
};

/// The answer to a request that had been given up.
struct LateReply
{
  /// That was asked; what a gateway makes of it in the reply does not count.
  std::uint8_t station = 0;
  /// From the end of the request on the wire to the first byte of its late reply: /diagnostics says which
  /// response_timeout would have caught it. Absent where that says nothing: several lost requests could have got this
  /// reply, or no longer time-out makes a drive answer that a gateway has given up.
  std::optional<Duration> delay;
  /// Reply::ticket of the request; 0 where several could have got this reply.
  std::uint64_t ticket = 0;
  /// The drive refuses (an exception of its own).
  bool exception = false;
  /// The exception code by which a gateway says that the drive has not answered; 0: the drive did.
  std::uint8_t gateway_code = 0;
};

/// One request at a time over one port: gap, transmission, waiting, checking, cleaning up after a lost reply. The only
/// user of the Port, called by the bus thread only. It decides nothing: no retries, no priorities.
///
/// After a time-out or a damaged reply, the shape of that request is barred for one second (contract, rule 3.9),
/// because most protocols have no transaction number: a reply that comes late would be taken for the answer to the next
/// request of the same shape. The bar falls when the late reply has come, or when a loop-back (08H) of that station
/// with a fresh number was answered after it. Behind a gateway GatewayRecord decides in its place.
class Line
{
public:
  /// Called for every frame, in the bus thread; must be quick.
  using FrameObserver = std::function<void(const FrameEvent&)>;

  Line(Port& port, Protocol& protocol, util::Clock& clock, LineTiming timing);

  void setFrameObserver(FrameObserver observer);

  /// Opens the port; forgets all bars, the echo finding and what was in the buffers. The first exchange after it must
  /// be a read (see EchoFilter); it need not be answered.
  /// May be Pending (see Port): nothing is forgotten before it is Opened.
  OpenResult open(std::string& error);
  void close();
  /// As close(), but what was sent and has not arrived yet is thrown away (TCP: RST).
  void abandon();
  bool isOpen() const;

  /// Earliest time at which the next request may start: gap after the last byte in either direction, turnaround after a
  /// broadcast.
  TimePoint readyAt() const;

  /// Sleeps until readyAt() and takes what arrived meanwhile (late replies, frames of a second master, noise),
  /// extending the wait until the line has been silent for a gap; at most 100 ms, so that babble cannot stop a stop.
  /// The rest of a frame that has begun is waited for with patience(), while a stop waits with \p give_way.pause.
  /// Returns false when the port is gone (it is closed then); after true, readyAt() has passed.
  bool settle(const GiveWay& give_way = GiveWay());

  /// True if a late reply to an earlier request could not be taken for the answer to \p request.
  bool mayAsk(const Request& request) const;
  /// Earliest time from which mayAsk() is true without further traffic.
  TimePoint mayAskAt(const Request& request) const;
  /// The same for a decision made at \p now, whatever the clock shows meanwhile.
  TimePoint mayAskAt(const Request& request, TimePoint now) const;

  /// Sends, after the silence that Request::quiet_before asks for, and waits for the answer; closes the port if it is
  /// lost. Call settle() before. Does not consult mayAsk(): a stop is exempt from it. \p turnaround_after silence to
  /// keep after a broadcast. \p give_way what ends the wait early (Reply::cut); the shape of the request is barred as
  /// after a time-out. Not where a gateway has the request (contract, 8.8).
  Reply exchange(const Request& request, Duration turnaround_after = Duration{ 0 },
                 const GiveWay& give_way = GiveWay());

  /// Time that an answered exchange occupies the line: gap, request, gap + reply delay, reply.
  Duration cost(const Request& request, Duration drive_delay) const;
  /// Time that an unanswered one does.
  Duration costUnanswered(const Request& request) const;

  const LineCounters& counters() const;
  /// Of the open port, see Port.
  std::optional<AdapterLatency> adapterLatency() const;

  /// Longest pause inside a reply that is waited out.
  Duration patience() const;

  const LineTiming& timing() const;
  bool echoFound() const;
  /// Late replies since the last call, refusals and a gateway's exceptions included.
  std::vector<LateReply> takeLateReplies();

  // --- the connection and its other end (contract, 8.8 to 8.11) -----------------------------------------------------
  /// How the port got lost since it was opened last; None while it is open or if close() or abandon() ended it.
  Loss lastLoss() const;
  /// A valid reply came since it was opened.
  bool provenSinceOpen() const;
  /// The other end of an `rtu+tcp://` connection has begun to speak telnet before its first valid reply: FFH is doubled
  /// in what is sent from then on, and undoubled in what is received.
  bool telnetFound() const;
  /// Text that the other end has sent since it was opened or since its last valid reply, fit for a message; empty if
  /// what came is no text. A server that closes says why that way ("Port already in use"); one that goes on has only greeted.
  /// Kept until the port is opened again.
  std::string peerWords() const;
  /// Modbus TCP: requests of this connection that have not been answered yet, oldest first. Empty in other protocols.
  std::vector<Outstanding> outstanding() const;
  /// Modbus TCP: the gateway has shown on this connection that it keeps transaction numbers and units.
  bool gatewayTrusted() const;
  /// Modbus TCP: how the gateway visibly changes transaction numbers or units ("its replies carry transaction number 0 ..."),
  /// as seen since the start; empty as long as it does not. Report it once.
  std::string gatewayQuirk() const;
  /// Modbus TCP: why the connection must be reopened before the next request (by abandon()), since replies to come
  /// could not be told apart; empty if it need not.
  std::string mustReopen() const;
  /// Time after which a gateway has given up a request that it left unanswered (`gateway_timeout`, default 3 s).
  void setGatewayTimeout(Duration timeout);

private:
  struct Waiting;
  bool settleFor(Duration quiet, const GiveWay& give_way);
  bool send(const Bytes& frame, Reply& reply);
  Waiting startWaiting(const Request& request, TimePoint sent_at, const GiveWay& give_way);
  void waitForReply(Waiting& waiting, Reply& reply);
  TimePoint waitUntil(const Waiting& waiting) const;
  ReceiveResult receive(TimePoint deadline);
  ReceiveResult receiveUnlessCut(TimePoint deadline, TimePoint from, const GiveWay& give_way, bool& cut);
  bool consume(Waiting& waiting, Reply& reply);
  bool consumeHead(Waiting& waiting, Reply& reply);
  bool answer(Waiting& waiting, const Parsed& parsed, const Bytes& raw, Reply& reply);
  void accept(const Waiting& waiting, const Parsed& parsed, const Bytes& raw, Reply& reply);
  void noteAnswer(Outcome outcome, const Parsed& parsed, const Bytes& raw);
  void expectEcho(const Request& request, const Bytes& frame);
  void giveUp(Waiting& waiting, Reply& reply);
  void noteLoss();
  void lose(Reply& reply);
  void consumeIdle();
  void flushIdle();
  void consumeIdleHead();
  bool noteUnasked(const Parsed& parsed, const Bytes& raw);
  bool takeLate(const Parsed& parsed);
  bool takeLateFromGateway(const Parsed& parsed);
  void noteLate(const Parsed& parsed, std::uint8_t station, const ReplyBars::Late& lost, std::uint8_t gateway_code);
  void noteAsked(const Waiting& waiting, const Reply& reply);
  GatewayRecord::Answer answerOf(const Parsed& parsed) const;
  bool isSurplus() const;
  void observe(FrameEvent::Kind kind, const Bytes& bytes, TimePoint time);
  void reportDamaged();
  void skip(std::size_t count);
  Bytes take(std::size_t count);
  Duration gap() const;
  Duration gatewayGap() const;
  Duration heldBack(const Request& request) const;
  Duration timeToSend(const Request& request) const;

  Port& port_;
  Protocol& protocol_;
  util::Clock& clock_;
  LineTiming timing_;
  FrameObserver observer_;
  LineCounters counters_;
  Bytes buffer_;
  /// Bytes since the last report that belonged to no valid frame.
  Bytes damaged_;
  TimePoint ready_at_;
  TimePoint last_byte_at_;
  /// When the line was last in use, in either direction.
  TimePoint last_use_at_;
  /// When the head of the buffer arrived.
  TimePoint head_at_;
  ReplyBars bars_;
  EchoFilter echo_;
  std::vector<LateReply> late_;
  /// Modbus TCP: in place of bars_.
  std::optional<GatewayRecord> gateway_;
  TelnetFilter telnet_;
  PeerWords words_;
  Loss last_loss_ = Loss::None;
  /// A valid reply came since the port was opened.
  bool proven_ = false;
  /// Nothing but bytes directly behind it has come since the last valid reply.
  bool behind_reply_ = false;
  /// The last request, if it is one that the drive may or may not answer.
  std::optional<Request> silent_request_;
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_LINE_H

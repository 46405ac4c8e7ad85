// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_GATEWAY_RECORD_H
#define INVERTER_BUS_WIRE_GATEWAY_RECORD_H

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace wire
{
/// What a gateway makes of the transaction number that it should repeat. Bits, for sets of them.
enum class NumberHabit : unsigned
{
  /// None of these: the reply to another request.
  None = 0,
  Same = 1,
  Zero = 2,
  PlusOne = 4,
  /// Its two bytes exchanged.
  Swapped = 8
};

/// What a gateway makes of the unit that it should repeat. Bits, for sets of them.
enum class UnitHabit : unsigned
{
  None = 0,
  Same = 1,
  Zero = 2,
  One = 4,
  /// 255: "not used" (Modbus messaging on TCP/IP implementation guide V1.0b, section 4.4.2.3).
  Last = 8
};

NumberHabit numberHabit(std::uint16_t asked, std::uint16_t replied);
UnitHabit unitHabit(std::uint8_t asked, std::uint8_t replied);

/// A request that was sent and has not been answered yet: it may still be in the gateway.
struct Outstanding
{
  /// Reply::ticket.
  std::uint64_t ticket = 0;
  std::uint8_t station = 0;
  TimePoint sent_at;
};

/// What a Modbus TCP gateway owes on its connection, and how far its transaction numbers and units can be trusted
/// (contract, 8.8): whose answer is this frame?
///
/// Three replies that bore the right number and unit while nothing else was owed make both trusted: from then on the
/// number tells. Until then, and for good where a gateway visibly does not keep them, replies are told apart by their
/// shape alone (function and all that is repeated of the request), so that no two requests of one shape may be owed at
/// once. Pure: time goes in.
class GatewayRecord
{
public:
  /// A request, as it was sent.
  struct Asked
  {
    std::uint64_t ticket = 0;
    std::uint16_t number = 0;
    std::uint8_t station = 0;
    /// Protocol::shape().
    std::string shape;
    TimePoint sent_at;
    TimePoint request_end;
    /// No drive may answer it, but a gateway may: a broadcast (to unit 0), or one that the drive executes in silence.
    bool silent = false;
    ExceptionCodes own_exceptions = everyExceptionOfADrive();
  };

  /// A valid frame that came.
  struct Answer
  {
    std::uint16_t number = 0;
    std::uint8_t unit = 0;
    /// Protocol::shapeOfReply(): only the function for an exception.
    std::string shape;
    bool exception = false;
  };

  /// A new connection: nothing is owed on it and nothing known of it.
  void opened();
  /// Time after which a gateway has given up a request.
  void setTimeout(Duration timeout);

  /// When a request of \p shape may be sent (but for a stop, which is exempt); \p now: at once.
  TimePoint mayAskAt(const std::string& shape, TimePoint now) const;
  /// \p request is on its way; the only one that is waited for.
  void asked(const Asked& request, TimePoint now);
  /// True if \p answer, which fits the request on its way but for number and unit, is its answer: the exchange is over.
  /// False: it answers, or could answer, an earlier one.
  bool takes(const Answer& answer);
  /// The request on its way is not waited for any longer.
  void givenUp(TimePoint now);
  /// The owed request that \p answer, which is not waited for, belongs to; it is owed no longer. Nothing if there is none;
  /// without a ticket if several could have got it.
  std::optional<Asked> takeLate(const Answer& answer);

  /// Oldest first.
  std::vector<Outstanding> outstanding() const;
  /// True if a request is owed an answer, or may get one.
  bool owes() const;
  bool trusted() const;
  /// What was seen since the start that a gateway should not do, in words; empty: nothing.
  std::string quirk() const;
  /// Why the connection must be given up before anything else is asked; empty if it need not.
  std::string mustReopen(TimePoint now) const;

private:
  /// What an answer could also belong to, by what was owed when the request was sent.
  struct Clash
  {
    bool normal = false;
    bool exception = false;
    bool with(const Answer& answer) const;
  };

  static void add(Clash& clash, const Asked& owed, const Asked& current);
  NumberHabit acceptableNumber(const Answer& answer) const;
  bool numberWasUsed(std::uint16_t number) const;
  bool clashes(const Answer& answer, bool exact) const;
  void answered(const Answer& answer, bool exact);
  void noteQuirk(NumberHabit number, UnitHabit unit);
  std::vector<std::deque<Asked>::iterator> findOwed(const Answer& answer);
  void forgetOld(TimePoint now);

  Duration timeout_{ std::chrono::seconds(3) };
  std::deque<Asked> owed_;
  Asked current_;
  /// With any owed request, with a broadcast, with the request before.
  Clash any_;
  Clash broadcast_;
  Clash previous_;
  std::uint8_t previous_station_ = 0;
  /// Requests on this connection.
  std::size_t asked_ = 0;
  unsigned exact_replies_ = 0;
  bool trusted_ = false;
  /// On this connection numbers or units were visibly wrong.
  bool quirky_ = false;
  /// A reply came that could belong to two requests.
  bool mixed_ = false;
  /// NumberHabit, of all answers on this connection whose request was certain.
  unsigned habits_ = 0;
  /// NumberHabit and UnitHabit that should not occur, since the start.
  unsigned wrong_numbers_ = 0;
  unsigned wrong_units_ = 0;
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_GATEWAY_RECORD_H

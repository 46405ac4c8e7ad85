// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <random>

#include "support/line_fixture.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using std::chrono::microseconds;
using std::chrono::milliseconds;

/// A Modbus TCP gateway at its worst: one that keeps numbers and units or one of those that do not, with replies late by up
/// to some seconds, always one request behind, lost, doubled, torn, refused with a wrong length, and with answers to
/// broadcasts. It answers in the order in which it was asked and puts the number of the request into the reply, so that a
/// reply taken for another request's answer shows.
class GatewayChaos : public LineFixture, public testing::WithParamInterface<unsigned>
{
protected:
  GatewayChaos() : LineFixture(makeModbusTcp(), LineTiming(19200, 10, milliseconds(100)))
  {
    constexpr int UNITS[] = { -1, 0, 1, 255 };
    number_habit_ = GetParam() % 4;
    unit_ = UNITS[GetParam() / 4 % 4];
    // Calm stretches and bad ones.
    lost_ = chance(0.5) ? 0.02 : 0.2;
    late_ = chance(0.5) ? 0.02 : 0.2;
  }

  bool chance(double probability)
  {
    return std::bernoulli_distribution(probability)(random_);
  }

  int pick(int low, int high)
  {
    return std::uniform_int_distribution<int>(low, high)(random_);
  }

  /// The reply with \p body as the gateway frames it, to the request that bears \p number.
  Bytes framed(unsigned number, Bytes body)
  {
    const unsigned changed = number_habit_ == 0   ? number
                             : number_habit_ == 1 ? 0
                             : number_habit_ == 2 ? number + 1
                                                  : (number >> 8U | number << 8U);
    body[0] = unit_ < 0 ? body[0] : static_cast<std::uint8_t>(unit_);
    const bool off_by_one = (body[1] & 0x80) != 0 && chance(0.3);
    const std::size_t length = body.size() + (off_by_one ? (chance(0.5) ? 1 : -1) : 0);
    return Bytes{ static_cast<std::uint8_t>(changed >> 8U), static_cast<std::uint8_t>(changed), 0, 0, 0,
                  static_cast<std::uint8_t>(length) } +
           body;
  }

  /// Lays down what the gateway sends for the next request, whose answer is \p body.
  void layDown(const Bytes& body)
  {
    const Bytes frame = framed(static_cast<unsigned>(line_.counters().requests % 0xFFFF) + 1, body);
    if (chance(lost_))
    {
      port_.answerNext({});
      return;
    }
    FakePort::Answers answers;
    const Duration delay =
        chance(late_) ? milliseconds(pick(100, chance(0.2) ? 5000 : 600)) : milliseconds(pick(20, 100));
    last_reply_ = std::max(last_reply_ + microseconds(1), clock_.now() + delay);
    const std::ptrdiff_t torn = chance(0.2) ? pick(1, static_cast<int>(frame.size()) - 1) : 0;
    answers.push_back({ last_reply_ - clock_.now(), Bytes(frame.begin(), frame.begin() + torn) });
    last_reply_ += milliseconds(torn != 0 ? pick(0, 90) : 0);
    Bytes rest(frame.begin() + torn, frame.end());
    // A copy, a checksum.
    rest = chance(0.05) ? rest + frame : chance(0.05) ? rest + hex("12 34") : rest;
    answers.push_back({ last_reply_ - clock_.now(), rest });
    port_.answerNext(answers);
  }

  void reopen()
  {
    port_.cutOff();
    last_reply_ = clock_.now();
    std::string error;
    line_.abandon();
    ASSERT_EQ(OpenResult::Opened, line_.open(error));
    ++reopened_;
  }

  void broadcast()
  {
    const Bytes body = hex("00 06 00 01 00 00");
    layDown(body);
    line_.exchange(requestOf(body + hex("00 00")), milliseconds(20));
  }

  std::mt19937 random_{ GetParam() };
  unsigned number_habit_ = 0;
  int unit_ = -1;
  double lost_ = 0.0;
  double late_ = 0.0;
  TimePoint last_reply_;
  unsigned reopened_ = 0;
};

TEST_P(GatewayChaos, aReplyIsNeverTakenForTheAnswerToAnotherRequest)
{
  unsigned answered = 0;
  for (unsigned ordinal = 1; ordinal <= 400; ++ordinal)
  {
    if (!line_.mustReopen().empty())
    {
      reopen();
    }
    ASSERT_TRUE(line_.settle());
    if (chance(0.02))
    {
      broadcast();
      continue;
    }
    const std::uint8_t station = chance(0.5) ? 1 : 5;
    const std::uint8_t count = chance(0.7) ? 1 : 2;
    Request request;
    request.station = station;
    request.pdu = { 3, 0, 0, 0, count };
    // Who is in a hurry does not ask whether he may.
    if (!line_.mayAsk(request) && !chance(0.1))
    {
      clock_.advance(milliseconds(pick(1, 400)));
      continue;
    }
    Bytes body{ station, 3, static_cast<std::uint8_t>(2 * count) };
    for (int i = 0; i < count; ++i)
    {
      body.push_back(static_cast<std::uint8_t>(ordinal >> 8U));
      body.push_back(static_cast<std::uint8_t>(ordinal));
    }
    const bool refused = chance(0.05);
    layDown(refused ? Bytes{ station, 0x83, static_cast<std::uint8_t>(1 + ordinal % 3) } : body);
    const Reply reply = line_.exchange(request);
    if (reply.outcome == Outcome::Ok)
    {
      ASSERT_EQ(Bytes(body.begin() + 1, body.end()), reply.pdu) << "request " << ordinal;
      ASSERT_FALSE(refused);
      ++answered;
    }
    else if (reply.outcome == Outcome::Exception)
    {
      ASSERT_TRUE(refused) << "request " << ordinal;
      ASSERT_EQ(1 + ordinal % 3, reply.pdu[1]);
    }
  }
  EXPECT_GT(answered, 10U);
}

INSTANTIATE_TEST_SUITE_P(seeds, GatewayChaos, testing::Range(0U, 320U));
}  // namespace
}  // namespace wire
}  // namespace inverter_bus

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

/// A drive and a cable at their worst: replies late by up to a second, lost, damaged, torn, with noise, with an echo,
/// with a second master. The drive answers in the order in which it was asked, and puts the number of the request into
/// the reply, so that a reply taken for another request's answer shows.
class LineChaos : public LineFixture, public testing::WithParamInterface<unsigned>
{
protected:
  bool chance(double probability)
  {
    return std::bernoulli_distribution(probability)(random_);
  }

  int pick(int low, int high)
  {
    return std::uniform_int_distribution<int>(low, high)(random_);
  }

  Bytes noise()
  {
    Bytes bytes;
    for (int count = pick(1, 12); count > 0; --count)
    {
      bytes.push_back(chance(0.3) ? std::uint8_t{ 1 } : static_cast<std::uint8_t>(pick(0, 255)));
    }
    return bytes;
  }

  static std::string twoBytes(unsigned value)
  {
    std::ostringstream stream;
    stream << std::hex << " " << (value >> 8 & 0xFF) << " " << (value & 0xFF);
    return stream.str();
  }

  /// Lays down what the line brings after the request that is answered by \p reply.
  void layDown(const Bytes& reply)
  {
    FakePort::Answers answers;
    if (chance(0.1))
    {
      answers.push_back({ milliseconds(pick(5, 150)), noise() });
    }
    if (chance(0.05))
    {
      answers.push_back({ milliseconds(pick(5, 150)), withCrc("02 03 02 00 00") });
    }
    if (!chance(0.1))
    {
      addReply(answers, reply);
    }
    port_.answerNext(answers);
  }

  void addReply(FakePort::Answers& answers, Bytes reply)
  {
    if (chance(0.05))
    {
      reply[static_cast<std::size_t>(pick(0, static_cast<int>(reply.size()) - 1))] ^= 0x10;
    }
    const Duration delay = chance(0.8) ? milliseconds(pick(9, 100)) : milliseconds(pick(100, 1000));
    last_reply_ = std::max(last_reply_ + microseconds(1), clock_.now() + delay);
    const Duration after = last_reply_ - clock_.now();
    const std::ptrdiff_t torn = chance(0.2) ? pick(1, static_cast<int>(reply.size()) - 1) : 0;
    answers.push_back({ after, Bytes(reply.begin(), reply.begin() + torn) });
    last_reply_ += milliseconds(torn != 0 ? pick(0, 16) : 0);
    answers.push_back({ last_reply_ - clock_.now(), Bytes(reply.begin() + torn, reply.end()) });
  }

  std::mt19937 random_{ GetParam() };
  TimePoint last_reply_;
};

TEST_P(LineChaos, aReplyIsNeverTakenForTheAnswerToAnotherRequest)
{
  if (chance(0.3))
  {
    port_.echo(timing_.characters(1), static_cast<std::size_t>(pick(1, 8)));
  }
  unsigned answered = 0;
  for (unsigned number = 1; number <= 400; ++number)
  {
    const bool loop_back = chance(0.1);
    const std::string text =
        loop_back ? "01 08 00 00" + twoBytes(number) : (chance(0.5) ? "01 03 00 00 00 01" : "01 03 00 00 00 02");
    if (!mayAsk(text))
    {
      clock_.advance(milliseconds(pick(1, 50)));
      continue;
    }
    const std::string number_text = twoBytes(number);
    const std::string reply_text = loop_back            ? text
                                   : text.back() == '1' ? "01 03 02" + number_text
                                                        : "01 03 04" + number_text + number_text;
    ASSERT_TRUE(line_.settle());
    ASSERT_LE(line_.readyAt(), clock_.now());
    layDown(withCrc(reply_text));
    const Reply reply = line_.exchange(requestOf(withCrc(text)));
    ASSERT_LE(reply.finished_at - reply.sent_at, milliseconds(160));
    if (reply.outcome == Outcome::Ok)
    {
      const Bytes expected = hex(reply_text);
      ASSERT_EQ(Bytes(expected.begin() + 1, expected.end()), reply.pdu) << "request " << number;
      ++answered;
    }
  }
  EXPECT_GT(answered, 20u);
  EXPECT_GT(line_.counters().late_replies, 0u);
}

INSTANTIATE_TEST_SUITE_P(seeds, LineChaos, testing::Range(0u, 100u));
}  // namespace
}  // namespace wire
}  // namespace inverter_bus

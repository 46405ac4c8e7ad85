// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Pauses inside a reply (contract, 8.12).
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "support/line_fixture.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
/// A UART with a FIFO: it tells of its bytes when \p trigger of them are there, and 4 characters after the last one.
FakePort::Answers throughFifo(const Bytes& frame, Duration begin, Duration character, std::size_t trigger)
{
  FakePort::Answers answers;
  for (std::size_t first = 0; first < frame.size(); first += trigger)
  {
    const std::size_t last = std::min(first + trigger, frame.size());
    const Duration silence = last - first < trigger ? 4 * character : Duration{ 0 };
    answers.push_back({ begin + static_cast<int>(last) * character + silence,
                        Bytes(frame.begin() + static_cast<std::ptrdiff_t>(first),
                              frame.begin() + static_cast<std::ptrdiff_t>(last)) });
  }
  return answers;
}

struct FifoCase
{
  unsigned baud_rate;
  unsigned bits;
  std::size_t trigger;
};

/// Rates that a drive of ours can be set to, behind a 16550A at its usual trigger level and at its highest. (Below 2400
/// baud Linux's driver has every byte told.)
const FifoCase FIFOS[] = { { 1200, 11, 1 },  { 2400, 10, 8 },  { 2400, 11, 8 },  { 2400, 12, 14 },
                           { 4800, 10, 8 },  { 4800, 11, 8 },  { 4800, 11, 14 }, { 9600, 11, 8 },
                           { 9600, 11, 14 }, { 19200, 10, 8 }, { 19200, 11, 14 } };

class FifoPauses : public testing::TestWithParam<FifoCase>
{
};

TEST_P(FifoPauses, cutNoReplyOfAnyLength)
{
  const FifoCase fifo = GetParam();
  const Duration character = seconds(static_cast<double>(fifo.bits) / fifo.baud_rate);
  for (unsigned registers = 1; registers <= 20; ++registers)
  {
    VirtualClock clock;
    FakePort port(clock);
    const auto protocol = makeModbusRtu();
    Line line(port, *protocol, clock, LineTiming(fifo.baud_rate, fifo.bits));
    std::string error;
    ASSERT_EQ(OpenResult::Opened, line.open(error));
    Request request;
    request.station = 1;
    request.pdu = { 3, 0x10, 0, 0, static_cast<std::uint8_t>(registers) };
    Bytes reply{ 1, 3, static_cast<std::uint8_t>(2 * registers) };
    reply.resize(3 + 2 * registers, 0x55);
    const std::uint16_t crc = modbusCrc(reply.data(), reply.size());
    reply = reply + Bytes{ static_cast<std::uint8_t>(crc & 0xFF), static_cast<std::uint8_t>(crc >> 8) };
    // 8 characters of request and a gap of 3.5.
    port.answerNext(throughFifo(reply, 12 * character, character, fifo.trigger));
    ASSERT_TRUE(line.settle());
    EXPECT_EQ(Outcome::Ok, line.exchange(request).outcome) << reply.size() << " bytes";
    EXPECT_EQ(0U, line.counters().corrupt_replies);
  }
}

INSTANTIATE_TEST_SUITE_P(All, FifoPauses, testing::ValuesIn(FIFOS), [](const auto& info) {
  return std::to_string(info.param.baud_rate) + "Baud" + std::to_string(info.param.bits) + "BitsTrigger" +
         std::to_string(info.param.trigger);
});

class RaisedPause : public LineFixture
{
protected:
  RaisedPause() : LineFixture(makeModbusRtu(), LineTiming(19200, 10, std::chrono::milliseconds(300)))
  {
  }

  /// Half of the reply after \p begin milliseconds, the rest \p pause later.
  Reply askWithPause(double begin, double pause)
  {
    const Bytes reply = withCrc(REPLY);
    port_.answerNext({ { ms(begin), Bytes(reply.begin(), reply.begin() + 5) },
                       { ms(begin + pause), Bytes(reply.begin() + 5, reply.end()) } });
    Request request = requestOf(withCrc(READ));
    request.response_timeout = std::chrono::seconds(1);
    EXPECT_TRUE(line_.settle());
    return line_.exchange(request);
  }
};

TEST_F(RaisedPause, isWaitedOut)
{
  EXPECT_EQ(Outcome::Ok, askWithPause(10, 295).outcome);
}

TEST_F(RaisedPause, isWaitedOutAfterAReplyThatBeganAtTheLastMoment)
{
  EXPECT_EQ(Outcome::Ok, askWithPause(1000, 295).outcome);
}

TEST_F(RaisedPause, endsAReplyThatBrokeOff)
{
  startWatch();
  EXPECT_EQ(Outcome::Damaged, askWithPause(10, 2000).outcome);
  EXPECT_GE(elapsed(), ms(310));
  EXPECT_LE(elapsed(), ms(325));
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus

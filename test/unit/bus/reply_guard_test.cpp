// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Rule 3.9 of the contract: what goes, or goes in its place, when a late reply could be taken for the answer. The line is asked
// only through what is handed in, for the time of the decision.

#include "bus/activities/reply_guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"
#include "support/fake_port.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr std::uint8_t LOOP_BACK = 0x08;

/// A line on which everything but loop-backs is barred until \ref until.
class BarredLine : public LineView
{
public:
  TimePoint mayAskAt(const wire::Request& request, TimePoint now) const override
  {
    return request.pdu.front() == LOOP_BACK ? now : std::max(until, now);
  }
  Duration cost(const wire::Request& /*request*/) const override
  {
    return Duration{ 0 };
  }
  Duration costUnanswered(const wire::Request& /*request*/) const override
  {
    return Duration{ 0 };
  }

  TimePoint until;
};

class Guard : public testing::Test
{
protected:
  static Configuration oneMx2()
  {
    Configuration configuration;
    configuration.bus.inverters.push_back(inverterConfig());
    configuration.drives.push_back(shipped("omron_mx2"));
    return configuration;
  }

  InFlight exchange(Pick::What what, const wire::Request& request) const
  {
    Pick pick;
    pick.what = what;
    pick.command = what == Pick::What::Velocity ? 7 : 0;
    InFlight current = exchangeFor(pick);
    current.request = request;
    return current;
  }

  wire::Request read() const
  {
    return inverter().drive.read(1, inverter().drive.fastBlocks().front());
  }

  Inverter& inverter() const
  {
    return *bus_.inverters.front();
  }

  const Configuration configuration_ = oneMx2();
  wire::VirtualClock clock_;
  wire::FakePort port_{ clock_ };
  const std::unique_ptr<wire::Protocol> protocol_ = wire::makeModbusRtu();
  const wire::Line line_{ port_, *protocol_, clock_, wire::LineTiming(19200, 10) };
  BusState bus_{ configuration_, line_ };
  ReplyGuard guard_{ bus_ };
  BarredLine view_;
};

TEST_F(Guard, whatNoLateReplyCouldAnswerGoesAsItIs)
{
  view_.until = at(100);
  InFlight current = exchange(Pick::What::Refresh, read());
  EXPECT_TRUE(guard_.makeSafe(at(100), current, view_));
  EXPECT_EQ(current.request.pdu, read().pdu);
  EXPECT_FALSE(current.resync);
}

TEST_F(Guard, aLoopBackGoesInThePlaceOfWhatIsBarred)
{
  view_.until = at(100);
  InFlight current = exchange(Pick::What::Refresh, read());
  EXPECT_TRUE(guard_.makeSafe(at(99), current, view_));
  EXPECT_EQ(current.request.pdu.front(), LOOP_BACK);
  EXPECT_TRUE(current.resync);
}

TEST_F(Guard, withoutALoopBackAVelocityWaitsUntilTheBarEnds)
{
  inverter().loopback.note(wire::Outcome::Exception);
  view_.until = at(100);
  WaitingCommand waiting;
  waiting.id = 7;
  waiting.inverters = { 0 };
  waiting.not_before = at(0);
  bus_.scheduler.push(waiting);
  InFlight current = exchange(Pick::What::Velocity, read());
  EXPECT_FALSE(guard_.makeSafe(at(0), current, view_));
  std::vector<InverterView> views(1);
  views.front().refresh_not_before = at(60000);
  EXPECT_EQ(bus_.scheduler.next(at(99), views).what, Pick::What::Nothing);
  EXPECT_EQ(bus_.scheduler.next(at(100), views).what, Pick::What::Velocity);
}

TEST_F(Guard, withoutALoopBackTheStatusWaitsUntilTheBarEnds)
{
  inverter().loopback.note(wire::Outcome::Exception);
  view_.until = at(100);
  InFlight current = exchange(Pick::What::Refresh, read());
  EXPECT_FALSE(guard_.makeSafe(at(0), current, view_));
  EXPECT_EQ(inverter().pauses.statusNotBefore(), at(100));
}

TEST_F(Guard, aStopsWriteIsExempt)
{
  view_.until = at(100);
  inverter().stop.request(at(0), StopMode::Decelerate);
  InFlight current = exchange(Pick::What::Stop, inverter().stop.next());
  EXPECT_TRUE(guard_.makeSafe(at(0), current, view_));
  EXPECT_EQ(current.request.pdu, inverter().stop.next().pdu);
  EXPECT_FALSE(current.resync);
  EXPECT_TRUE(current.may_be_late);
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// A whole bus behind a Modbus TCP gateway, in virtual time (contract, 8.8 to 8.10, 8.16).

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr std::size_t A = 0;
constexpr std::size_t B = 1;

std::string twoDrives(const std::string& more = "")
{
  return "port: tcp://virtual\n"
         "response_timeout: 0.3\n" +
         more +
         "defaults: {drive: omron_mx2, command_timeout: 5.0, max_velocity: 60.0}\n"
         "scan_list:\n"
         "  - {name: a, node: 1}\n"
         "  - {name: b, node: 2}\n";
}

class BehindAGateway : public ::testing::Test
{
protected:
  void start(const std::string& yaml = twoDrives())
  {
    bus_ = std::make_unique<VirtualBus>(yaml);
  }

  /// \p index runs at 20 Hz, and is commanded on.
  void turn(std::size_t index, const std::string& name)
  {
    bus_->settleIn(20.0);
    bus_->stream(index, 20.0, 0.1, 300.0);
    ASSERT_TRUE(bus_->runUntil(10.0, [&] { return bus_->motor(name, "run_coil") > 0.0; }));
    ASSERT_TRUE(bus_->runUntil(10.0, [&] { return bus_->status(index).monitor.running.value_or(false); }));
  }

  /// \p action as soon as the gateway holds back what it was told to, in the middle of the exchange.
  void onHold(const std::function<void()>& action)
  {
    const auto done = std::make_shared<bool>(false);
    for (double time = 0.0; time < 3.0; time += 0.01)
    {
      bus_->at(time, [this, action, done] {
        if (!*done && bus_->gateway().held() > 0)
        {
          *done = true;
          action();
        }
      });
    }
  }

  /// What /diagnostics shows of the bus.
  std::string busValue(const std::string& name)
  {
    for (const auto& value : bus_->coordinator().report(bus_->now()).values)
    {
      if (value.first == name)
      {
        return value.second;
      }
    }
    return "none";
  }

  /// The gateway keeps the RUN of A (coil 0000 on the wire) for \p time [s] before it carries it out.
  void holdTheRun(double time)
  {
    bus_->gateway().behaviour.hold = { 0x01, 0x05, 0x00, 0x00, 0xFF };
    bus_->gateway().behaviour.hold_time = time;
  }

  /// A is commanded, and its RUN has been in the gateway for a moment.
  void startAHeldRun(double time)
  {
    holdTheRun(time);
    bus_->command(A, 20.0);
    ASSERT_TRUE(bus_->runUntil(20.0, [&] { return bus_->gateway().held() > 0; }));
    bus_->run(0.1);
  }

  bool online(std::size_t index) const
  {
    return bus_->hasStatus(index) && !bus_->status(index).communication_error;
  }

  using Box = VirtualBus::Box;
  std::unique_ptr<VirtualBus> bus_;
};

TEST_F(BehindAGateway, everythingWorks)
{
  start();
  turn(A, "a");
  const auto stop = bus_->wait(bus_->stop(A));
  EXPECT_TRUE(stop.success) << stop.message;
  EXPECT_EQ(bus_->motor("a", "run_coil"), 0.0);
}

/// A gateway may carry it out late: a refresh that repeats RUN is none behind one.
TEST_F(BehindAGateway, aSettledCommandIsRefreshedByReadsAlone)
{
  start(
      "port: tcp://virtual\n"
      "defaults: {command_timeout: 5.0}\n"
      "scan_list:\n"
      "  - {name: a, node: 1, drive: toshiba_vfs15}\n"
      "simulation:\n"
      "  a: {parameters: {F870: 1, F871: 3, F875: 1, F876: 2, F877: 3, F878: 4, F879: 14}}\n");
  bus_->settleIn(20.0);
  bus_->stream(A, 20.0, 0.1, 30.0);
  ASSERT_TRUE(bus_->runUntil(10.0, [&] { return bus_->status(A).monitor.running.value_or(false); }));
  bus_->run(1.0);
  bus_->clearFrames();
  bus_->run(5.0);
  EXPECT_EQ(bus_->count("01 17"), 0U);
  EXPECT_EQ(bus_->count("01 06") + bus_->count("01 10"), 0U);
  EXPECT_GT(bus_->count("01 03 18 75 00 05"), 20U) << "the block";
}

TEST_F(BehindAGateway, aDeadUnitStopsNobodyElse)
{
  for (const double silence : { 0.5, 1.0, 2.2 })
  {
    start();
    bus_->gateway().behaviour.silence = silence;
    turn(A, "a");
    bus_->world("b offline");
    std::size_t longest = 0;
    for (int second = 0; second < 60; ++second)
    {
      bus_->run(1.0);
      longest = std::max(longest, bus_->gateway().deepest());
      ASSERT_EQ(bus_->motor("a", "run_coil"), 1.0) << "after " << second << " s, gateway " << silence;
      ASSERT_TRUE(online(A)) << "after " << second << " s, gateway " << silence;
    }
    EXPECT_FALSE(online(B));
    EXPECT_LE(longest, 2U) << "one request is in the gateway at a time";
    EXPECT_LE(bus_->gateway().blocked(), 0.15 * 60.0 + 7 * silence) << "probes pay for the gateway's block";
  }
}

/// It swallows a request now and then: nothing else is sent for gateway_timeout, which is longer than the 2 s of rule 8.15.
TEST_F(BehindAGateway, oneRequestThatIsSwallowedStopsNobody)
{
  start(twoDrives("gateway_timeout: 3.0\n"));
  turn(A, "a");
  for (int time = 0; time < 10; ++time)
  {
    bus_->gateway().behaviour.swallow = 1;
    for (int tenth = 0; tenth < 100; ++tenth)
    {
      bus_->run(0.1);
      ASSERT_TRUE(online(A)) << time << " " << tenth;
      ASSERT_TRUE(online(B)) << time << " " << tenth;
    }
    ASSERT_EQ(bus_->motor("a", "run_coil"), 1.0) << time;
  }
}

TEST_F(BehindAGateway, aStopGoesAtOnceAndIsConfirmedAfterTheBlock)
{
  start();
  bus_->gateway().behaviour.silence = 2.2;
  turn(A, "a");
  bus_->world("b offline");
  ASSERT_TRUE(bus_->runUntil(30.0, [&] { return bus_->gateway().blocked() > 0.0; }));
  bus_->run(2.2);
  const auto box = bus_->stop(A);
  const TimePoint called = bus_->now();
  ASSERT_TRUE(bus_->runUntil(10.0, [&] { return bus_->motor("a", "run_coil") == 0.0; }));
  EXPECT_LE(toSeconds(bus_->now() - called), 2.2 + 0.5);
  EXPECT_TRUE(bus_->wait(box).success);
  EXPECT_LE(bus_->gateway().deepest(), 3U);
}

TEST_F(BehindAGateway, aSlowGatewayIsNotFlooded)
{
  start();
  turn(A, "a");
  bus_->gateway().behaviour.slow = 0.38;
  bus_->run(60.0);
  EXPECT_LE(bus_->gateway().deepest(), 3U);
}

TEST_F(BehindAGateway, aUnitThatIsRefusedAtOnceTakesNoShareOfTheBus)
{
  start();
  bus_->settleIn(20.0);
  bus_->run(5.0);
  bus_->clearFrames();
  bus_->run(10.0);
  const std::size_t before = bus_->count("01 ");
  bus_->gateway().behaviour.refuse = { { 2, 0x0A } };
  ASSERT_TRUE(bus_->runUntil(10.0, [&] { return bus_->status(B).communication_error; }));
  bus_->clearFrames();
  bus_->run(10.0);
  EXPECT_GE(bus_->count("01 "), before) << "the other one has the bus for itself";
  EXPECT_EQ(bus_->status(B).error_id, wire::ERROR_TIMEOUT);
}

TEST_F(BehindAGateway, aGatewaysOwnWordForNoAnswerMakesTheDriveOffline)
{
  for (const int code : { 0x0B, 0xE0, 0x43 })
  {
    start(twoDrives("gateway_timeout: 3.0\n"));
    bus_->gateway().behaviour.silent_code = code;
    bus_->gateway().behaviour.silence = 0.2;
    turn(B, "b");
    bus_->world("b offline");
    EXPECT_TRUE(bus_->runUntil(10.0, [&] { return bus_->status(B).communication_error; })) << code;
    EXPECT_EQ(bus_->status(B).error_id, wire::ERROR_TIMEOUT) << code;
    EXPECT_FALSE(bus_->status(B).monitor.output_frequency);
  }
}

TEST_F(BehindAGateway, anIdleCloseStopsNobody)
{
  start(twoDrives("interval: 10.0\n"));
  bus_->gateway().behaviour.idle_close = 2.5;
  ASSERT_TRUE(bus_->runUntil(40.0, [&] { return online(A) && online(B); }));
  bus_->run(10.0);
  bus_->stream(A, 25.0, 0.5, 100.0);
  ASSERT_TRUE(bus_->runUntil(20.0, [&] { return bus_->motor("a", "run_coil") > 0.0; }));
  bus_->run(1.0);
  const std::size_t closed = bus_->gateway().closed();
  for (int second = 0; second < 45; ++second)
  {
    bus_->run(1.0);
    ASSERT_EQ(bus_->motor("a", "run_coil"), 1.0) << second;
  }
  EXPECT_GT(bus_->gateway().closed(), closed);
  EXPECT_FALSE(bus_->status(A).locked);
  EXPECT_THAT(bus_->logTexts(), Not(Contains(HasSubstr("gone"))));
}

TEST_F(BehindAGateway, aCloseInPlaceOfTheAnswerOfADeadUnitStopsNobodyElse)
{
  start();
  bus_->gateway().behaviour.close_on_silence = true;
  bus_->gateway().behaviour.silence = 0.2;
  turn(A, "a");
  bus_->world("b offline");
  for (int second = 0; second < 40; ++second)
  {
    bus_->run(1.0);
    ASSERT_EQ(bus_->motor("a", "run_coil"), 1.0) << second;
    ASSERT_TRUE(online(A)) << second;
    ASSERT_LT(toSeconds(bus_->now() - bus_->status(A).stamp), 1.0) << "a closed connection keeps nobody waiting";
  }
  EXPECT_FALSE(online(B));
  EXPECT_FALSE(bus_->status(A).locked);
}

/// It hangs up only when our own time-out has long passed: that is the block which the probes have to pay.
TEST_F(BehindAGateway, aLateCloseInPlaceOfTheAnswerIsPaidByTheProbes)
{
  start();
  bus_->gateway().behaviour.close_on_silence = true;
  bus_->gateway().behaviour.silence = 1.0;
  turn(A, "a");
  bus_->world("b offline");
  ASSERT_TRUE(bus_->runUntil(60.0, [&] { return !online(B); }));
  bus_->run(5.0);
  const double before = bus_->gateway().blocked();
  for (int second = 0; second < 100; ++second)
  {
    bus_->run(1.0);
    ASSERT_EQ(bus_->motor("a", "run_coil"), 1.0) << second;
  }
  EXPECT_LE(bus_->gateway().blocked() - before, 0.05 * 100.0 + 1.0);
  EXPECT_GT(bus_->gateway().blocked() - before, 2.0) << "it is looked for all the same";
}

TEST_F(BehindAGateway, aStopThatClosesEachConnectionStopsNobodyElse)
{
  start();
  bus_->gateway().behaviour.close_on_silence = true;
  bus_->gateway().behaviour.silence = 0.2;
  bus_->settleIn(20.0);
  bus_->stream(A, 20.0, 0.1, 300.0);
  bus_->stream(B, 20.0, 0.1, 2.0);
  ASSERT_TRUE(bus_->runUntil(10.0, [&] { return bus_->motor("b", "run_coil") > 0.0; }));
  ASSERT_TRUE(bus_->runUntil(10.0, [&] { return bus_->status(A).monitor.running.value_or(false); }));
  // Away, and to be stopped before any read of it got lost.
  bus_->world("b offline");
  const auto box = bus_->stop(B);
  for (int tenth = 0; tenth < 400; ++tenth)
  {
    bus_->run(0.1);
    ASSERT_EQ(bus_->motor("a", "run_coil"), 1.0) << tenth;
    ASSERT_TRUE(online(A)) << tenth;
    ASSERT_LT(toSeconds(bus_->now() - bus_->status(A).stamp), 1.5) << tenth;
    ASSERT_TRUE(tenth < 30 || !online(B)) << tenth;
  }
  EXPECT_FALSE(bus_->wait(box, 30.0).success);
  bus_->world("b online");
  EXPECT_TRUE(bus_->runUntil(30.0, [&] { return online(B) && !bus_->status(B).stop_active; }));
  EXPECT_EQ(bus_->motor("b", "run_coil"), 0.0);
}

TEST_F(BehindAGateway, aConnectionThatIsClosedAgainAndAgainIsTriedOnceInTwoSeconds)
{
  for (const bool at_once : { true, false })
  {
    start();
    bus_->gateway().behaviour.close_at_once = at_once;
    bus_->gateway().behaviour.close_at_first_byte = !at_once;
    bus_->gateway().behaviour.words = "Port already in use\r\n";
    bus_->run(20.0);
    EXPECT_LE(bus_->gateway().connections().size(), 11U);
    EXPECT_GE(bus_->gateway().connections().size(), 8U);
    EXPECT_GE(bus_->busStatuses().size(), 18U) << "bus_status goes on at 1 Hz";
    EXPECT_FALSE(bus_->busStatuses().back().connected);
    EXPECT_THAT(bus_->logTexts(), Contains(HasSubstr("another client")));
    EXPECT_THAT(bus_->logTexts(), Contains(HasSubstr("Port already in use")));
    EXPECT_THAT(bus_->logTexts(), Not(Contains(HasSubstr("dmesg"))));
    bus_->gateway().behaviour = VirtualGateway::Behaviour();
    EXPECT_TRUE(bus_->runUntil(10.0, [&] { return online(A) && online(B); }));
  }
}

TEST_F(BehindAGateway, aLostConnectionStopsAndLocks)
{
  start();
  turn(A, "a");
  bus_->gateway().behaviour.gone = true;
  bus_->gateway().hangUp();
  ASSERT_TRUE(bus_->runUntil(2.0, [&] { return bus_->status(A).communication_error; }));
  EXPECT_EQ(bus_->status(A).error_id, wire::ERROR_PORT_LOST);
  EXPECT_TRUE(bus_->status(A).locked);
  bus_->run(3.0);
  bus_->gateway().behaviour.gone = false;
  ASSERT_TRUE(bus_->runUntil(5.0, [&] { return online(A); }));
  EXPECT_EQ(bus_->motor("a", "run_coil"), 0.0) << "stopped first of all";
  bus_->run(5.0);
  EXPECT_EQ(bus_->motor("a", "run_coil"), 0.0) << "the stream that went on starts nothing";
}

TEST_F(BehindAGateway, aMuteConnectionIsOpenedAnew)
{
  start();
  turn(A, "a");
  bus_->gateway().behaviour.mute = true;
  const std::size_t before = bus_->gateway().connections().size();
  ASSERT_TRUE(bus_->runUntil(10.0, [&] { return !online(A); })) << "shown, stopped and locked";
  EXPECT_TRUE(bus_->status(A).locked);
  ASSERT_TRUE(bus_->runUntil(30.0, [&] { return bus_->gateway().connections().size() > before; }));
  EXPECT_GE(bus_->gateway().abandoned(), 1U);
  bus_->gateway().behaviour.mute = false;
  EXPECT_TRUE(bus_->runUntil(70.0, [&] { return online(A) && online(B); }));
  bus_->run(3.0);
  EXPECT_EQ(bus_->motor("a", "run_coil"), 0.0) << "nothing runs again by itself";
}

/// A mute link whose host is away when it is opened anew, and which is lost for good later.
TEST_F(BehindAGateway, aLossAfterARenewalThatFailedIsALoss)
{
  start();
  bus_->settleIn(20.0);
  bus_->gateway().behaviour.mute = true;
  ASSERT_TRUE(bus_->runUntil(30.0, [&] { return bus_->gateway().abandoned() > 0; }));
  bus_->gateway().behaviour.gone = true;
  bus_->run(3.0);
  EXPECT_FALSE(bus_->busStatuses().back().connected);
  bus_->gateway().behaviour = VirtualGateway::Behaviour();
  ASSERT_TRUE(bus_->runUntil(10.0, [&] { return online(A) && online(B); }));
  EXPECT_THAT(bus_->logTexts().back(), Not(HasSubstr("cannot connect")));
  bus_->run(5.0);
  bus_->gateway().behaviour.gone = true;
  bus_->gateway().hangUp();
  EXPECT_TRUE(bus_->runUntil(3.0, [&] { return !online(A) && !online(B); })) << "an old value shown as fresh";
  bus_->run(0.1);
  EXPECT_FALSE(bus_->busStatuses().back().connected);
}

TEST_F(BehindAGateway, aLateRunIsFollowedByAStopThatCounts)
{
  start();
  bus_->settleIn(20.0);
  // The gateway hangs for 1.5 s just as the RUN (coil 0000 on the wire) is its next request, and then carries it out.
  startAHeldRun(1.5);
  const TimePoint called = bus_->now();
  const auto box = bus_->stop(A);
  ASSERT_TRUE(bus_->runUntil(5.0, [&] { return bus_->motor("a", "run_coil") > 0.0; })) << "the old RUN";
  ASSERT_TRUE(bus_->runUntil(5.0, [&] { return bus_->motor("a", "run_coil") == 0.0; }));
  EXPECT_FALSE(box->has_value()) << "what went before the RUN was carried out confirms nothing";
  EXPECT_TRUE(bus_->wait(box).success);
  EXPECT_GT(toSeconds(bus_->now() - called), 1.1) << "our time-out of 0.3 s had passed when it was called";
  bus_->run(10.0);
  EXPECT_EQ(bus_->motor("a", "run_coil"), 0.0);
  EXPECT_FALSE(bus_->status(A).stop_active);
}

TEST_F(BehindAGateway, aZeroAfterALateRunInsistsLikeAStop)
{
  start();
  bus_->settleIn(20.0);
  startAHeldRun(1.5);
  bus_->command(A, 0.0);
  bus_->run(1.0);
  EXPECT_TRUE(bus_->status(A).locked) << "until it is confirmed";
  bus_->run(10.0);
  EXPECT_EQ(bus_->motor("a", "run_coil"), 0.0);
  EXPECT_FALSE(bus_->status(A).stop_active);
}

TEST_F(BehindAGateway, aZeroAfterALateRunLocksAtOnce)
{
  start();
  bus_->settleIn(20.0);
  startAHeldRun(1.5);
  const auto locked = [this] { return bus_->coordinator().report(bus_->now()).inverters[A].status.locked; };
  ASSERT_FALSE(locked());
  bus_->command(A, 0.0);
  EXPECT_TRUE(locked()) << "the RUN may still be carried out";
  // Whoever has sent 0 is neutral; until the stop behind the RUN is confirmed that opens nothing.
  ASSERT_TRUE(bus_->runUntil(10.0, [&] {
    const bool was_locked = locked();
    EXPECT_EQ(bus_->command(A, 20.0) == 0, !was_locked);
    bus_->command(A, 0.0);
    return !was_locked;
  }));
  EXPECT_EQ(bus_->motor("a", "run_coil"), 0.0);
}

/// The RUN-off frame of A (coil 0000 on the wire) that the gateway has not answered is the one stop of A that it may hold.
TEST_F(BehindAGateway, aStopWaitsForTheFrameOfAZeroOfTheSameInverter)
{
  start(twoDrives("gateway_timeout: 2.0\n"));
  bus_->settleIn(20.0);
  bus_->command(A, 20.0);
  ASSERT_TRUE(bus_->runUntil(10.0, [&] { return bus_->status(A).monitor.running.value_or(false); }));
  ASSERT_EQ(bus_->gateway().deepest(), 1U);
  bus_->gateway().behaviour.hold = { 0x01, 0x05, 0x00, 0x00, 0x00 };
  bus_->gateway().behaviour.hold_time = 1.2;
  bus_->command(A, 0.0);
  // While the frame is on its way, and our own time-out has not passed.
  Box box;
  onHold([this, &box] { box = bus_->stop(A); });
  bus_->clearFrames();
  ASSERT_TRUE(bus_->runUntil(3.0, [&] { return box != nullptr; }));
  ASSERT_TRUE(bus_->runUntil(5.0, [&] { return bus_->motor("a", "run_coil") == 0.0; }));
  EXPECT_EQ(bus_->gateway().deepest(), 1U) << "a second stop frame of the same inverter waited behind the first one";
  EXPECT_TRUE(bus_->wait(box).success);
  EXPECT_LE(bus_->count("01 05 00 00 00"), 2U);
}

TEST_F(BehindAGateway, aZeroWaitsForTheFrameOfAStopOfTheSameInverter)
{
  start(twoDrives("gateway_timeout: 2.0\n"));
  bus_->settleIn(20.0);
  bus_->command(A, 20.0);
  ASSERT_TRUE(bus_->runUntil(10.0, [&] { return bus_->status(A).monitor.running.value_or(false); }));
  ASSERT_EQ(bus_->gateway().deepest(), 1U);
  // The gateway is busy with a read of B, so that the 0 goes as a stop: two requests, and no third.
  bus_->gateway().behaviour.hold = { 0x02 };
  bus_->gateway().behaviour.hold_time = 1.2;
  onHold([this] { bus_->at(0.5, [this] { bus_->command(A, 0.0); }); });
  ASSERT_TRUE(bus_->runUntil(3.0, [&] { return bus_->gateway().deepest() == 2U; })) << "the stop of the 0";
  bus_->run(0.35);
  ASSERT_EQ(bus_->motor("a", "run_coil"), 1.0);
  // Taken back by a velocity, and asked for anew.
  EXPECT_EQ(bus_->command(A, 25.0), 0U);
  EXPECT_EQ(bus_->command(A, 0.0), 0U);
  ASSERT_TRUE(bus_->runUntil(5.0, [&] { return bus_->motor("a", "run_coil") == 0.0; }));
  EXPECT_EQ(bus_->gateway().deepest(), 2U);
  ASSERT_TRUE(bus_->runUntil(5.0, [&] { return !bus_->status(A).stop_active; }));
  bus_->run(5.0);
  EXPECT_EQ(bus_->motor("a", "run_coil"), 0.0);
}

TEST_F(BehindAGateway, stopsOfAllAgainAndAgainDoNotPileUpInIt)
{
  start(twoDrives("gateway_timeout: 6.0\n"));
  turn(A, "a");
  bus_->gateway().behaviour.hold = { 0x02 };
  bus_->gateway().behaviour.hold_time = 4.0;
  ASSERT_TRUE(bus_->runUntil(3.0, [&] { return bus_->gateway().held() > 0; }));
  bus_->clearFrames();
  for (int tenth = 0; tenth < 15; ++tenth)
  {
    bus_->stop(std::nullopt);
    bus_->run(0.1);
  }
  EXPECT_LE(bus_->gateway().deepest(), 4U) << "what it holds, one stop of all, and one of each";
  ASSERT_TRUE(bus_->runUntil(5.0, [&] { return bus_->motor("a", "run_coil") == 0.0; }));
  EXPECT_EQ(bus_->count("00 "), 1U);
  EXPECT_TRUE(bus_->runUntil(5.0, [&] { return !bus_->status(A).stop_active && !bus_->status(B).stop_active; }));
  // Kept busy once more: the next one goes again.
  bus_->gateway().behaviour.hold = { 0x02 };
  ASSERT_TRUE(bus_->runUntil(3.0, [&] { return bus_->gateway().held() > 1; }));
  bus_->stop(std::nullopt);
  bus_->run(5.0);
  EXPECT_EQ(bus_->count("00 "), 2U);
}

TEST_F(BehindAGateway, aRunThatIsCarriedOutAfterItsConnectionHasEndedIsStopped)
{
  start();
  bus_->settleIn(20.0);
  startAHeldRun(2.0);
  bus_->gateway().hangUp();
  const auto box = bus_->stop(A);
  bus_->wait(box);
  EXPECT_TRUE(bus_->runUntil(20.0, [&] { return !bus_->status(A).stop_active; }));
  bus_->run(10.0);
  EXPECT_EQ(bus_->motor("a", "run_coil"), 0.0);
}

TEST_F(BehindAGateway, aRunThatWasUnderWayWhenItsConnectionWasLostIsStopped)
{
  for (const bool in_good_order : { false, true })
  {
    start();
    bus_->settleIn(20.0);
    // Another queue of the gateway carries it out 2 s later, when the stop over the next connection is long answered.
    bus_->gateway().behaviour.hold_aside = true;
    holdTheRun(2.0);
    bus_->command(A, 20.0);
    onHold([this, in_good_order] {
      in_good_order ? bus_->gateway().hangUp() : bus_->gateway().cut();
      bus_->stop(A);
    });
    ASSERT_TRUE(bus_->runUntil(5.0, [&] { return bus_->motor("a", "run_coil") > 0.0; })) << "the old RUN";
    EXPECT_TRUE(bus_->status(A).stop_active) << in_good_order;
    EXPECT_TRUE(bus_->runUntil(5.0, [&] { return bus_->motor("a", "run_coil") == 0.0; })) << in_good_order;
    EXPECT_TRUE(bus_->runUntil(5.0, [&] { return !bus_->status(A).stop_active; })) << in_good_order;
    bus_->run(10.0);
    EXPECT_EQ(bus_->motor("a", "run_coil"), 0.0) << in_good_order;
  }
}

/// A converter that was put into telnet mode while a motor ran, and a drive that is back only later.
TEST_F(BehindAGateway, pendingStopsGoOverEachTelnetConnection)
{
  start(
      "port: rtu+tcp://virtual:4001\n"
      "defaults: {drive: omron_mx2, command_timeout: 5.0, max_velocity: 60.0}\n"
      "scan_list:\n"
      "  - {name: a, node: 1}\n"
      "  - {name: b, node: 2}\n");
  bus_->telnet().negotiates = false;
  turn(A, "a");
  bus_->world("a offline");
  bus_->world("bus unplug");
  bus_->telnet().negotiates = true;
  bus_->run(1.0);
  bus_->world("bus plug");
  bus_->run(15.0);
  EXPECT_EQ(bus_->motor("a", "run_coil"), 1.0);
  EXPECT_THAT(bus_->logTexts(), Contains(HasSubstr("set the port to raw")));
  bus_->world("a online");
  const std::size_t before = bus_->telnet().connections().size();
  EXPECT_TRUE(bus_->runUntil(10.0, [&] { return bus_->motor("a", "run_coil") == 0.0; }));
  bus_->run(20.0);
  EXPECT_LE(bus_->telnet().connections().size() - before, 16U) << "one in 2 s";
  EXPECT_FALSE(online(A));
}

TEST_F(BehindAGateway, shutdownOutlastsARunThatIsUnderWay)
{
  start();
  bus_->settleIn(20.0);
  bus_->gateway().behaviour.hold_aside = true;
  holdTheRun(2.7);
  bus_->command(A, 20.0);
  onHold([this] { bus_->gateway().hangUp(); });
  ASSERT_TRUE(bus_->runUntil(5.0, [&] { return bus_->gateway().closed() > 0; }));
  bus_->run(0.1);
  bus_->coordinator().beginShutdown(bus_->now());
  const TimePoint begun = bus_->now();
  EXPECT_TRUE(bus_->runUntil(20.0, [&] { return bus_->coordinator().shutdownDone(bus_->now()); }));
  EXPECT_LE(toSeconds(bus_->now() - begun), 10.0);
  EXPECT_EQ(bus_->coordinator().endShutdown().size(), 0U);
  bus_->pass(5.0);
  EXPECT_EQ(bus_->motor("a", "run_coil"), 0.0);
}

TEST_F(BehindAGateway, thatItIsSilentByNatureIsSaidOnce)
{
  start();
  bus_->gateway().behaviour.silent_code = 0;
  bus_->gateway().behaviour.silence = 0.1;
  turn(A, "a");
  bus_->world("b offline");
  bus_->run(120.0);
  const auto lines = bus_->logTexts();
  EXPECT_EQ(
      std::count_if(lines.begin(), lines.end(),
                    [](const std::string& line) { return line.find("are left unanswered") != std::string::npos; }),
      1);
  EXPECT_TRUE(online(A));
}

TEST_F(BehindAGateway, shutdownSleepsWhileAStopWaitsInTheGateway)
{
  start(twoDrives("gateway_timeout: 0.5\n"));
  bus_->gateway().behaviour.silence = 0.4;
  turn(A, "a");
  bus_->stream(B, 20.0, 0.1, 3.0);
  ASSERT_TRUE(bus_->runUntil(3.0, [&] { return bus_->motor("b", "run_coil") > 0.0; }));
  bus_->world("b offline");
  ASSERT_TRUE(bus_->runUntil(60.0, [&] { return !online(B) && bus_->status(B).stop_active; }));
  bus_->run(10.0);
  // The gateway is silent for longer than the shutdown takes.
  bus_->gateway().behaviour.mute = true;
  bus_->coordinator().beginShutdown(bus_->now());
  const TimePoint begun = bus_->now();
  std::size_t rounds = 0;
  EXPECT_TRUE(bus_->runUntil(20.0, [&] { return ++rounds > 2000 || bus_->coordinator().shutdownDone(bus_->now()); }));
  EXPECT_LT(rounds, 500U);
  EXPECT_LE(toSeconds(bus_->now() - begun), 10.1);
  EXPECT_EQ(bus_->coordinator().endShutdown().size(), 2U) << "both are named";
}

TEST_F(BehindAGateway, nothingIsRepeatedThatAClosedConnectionMayHaveCarriedOut)
{
  start();
  bus_->settleIn(20.0);
  // The gateway takes the write (F002 = 1103, one word), and ends the connection before it answers.
  bus_->gateway().behaviour.hold = { 0x01, 0x10, 0x11, 0x02 };
  bus_->gateway().behaviour.hold_time = 1.0;
  const auto box = bus_->writeParameter(A, "F002", 12.0, false);
  onHold([this] { bus_->gateway().hangUp(); });
  const bus::Answer answer = bus_->wait(box);
  EXPECT_FALSE(answer.success);
  EXPECT_EQ(answer.error_id, wire::ERROR_TIMEOUT);
  bus_->run(3.0);
  EXPECT_EQ(bus_->count("01 10 11 02"), 1U);
}

TEST_F(BehindAGateway, howLongAnOfflineInverterMayNeedToBeBackIsShownAndKept)
{
  for (const double silence : { 0.1, 0.25, 1.0 })
  {
    start();
    bus_->gateway().behaviour.silence = silence;
    bus_->settleIn(20.0);
    EXPECT_EQ(busValue("offline inverter back within"), "60 s") << "gateway_timeout, until it is measured";
    const double within = std::max(3.0, silence / 0.05);
    bus_->world("b offline");
    ASSERT_TRUE(bus_->runUntil(60.0, [&] { return !online(B); }));
    bus_->run(7.0 + within);
    EXPECT_NEAR(std::stod(busValue("offline inverter back within")), within, 0.15 * within) << silence;
    bus_->world("b online");
    EXPECT_TRUE(bus_->runUntil(within * 1.2 + 0.5, [&] { return online(B); })) << silence;
  }
}

/// A has a communication time-out of 0.8 s (which it only shows), and a silent station keeps the gateway for 1.5 s.
class BesideAShortTimeOut : public BehindAGateway
{
protected:
  void SetUp() override
  {
    start(twoDrives("gateway_timeout: 2.0\n") + "simulation:\n  a: {parameters: {C077: 0.8, C076: 2}}\n");
    bus_->gateway().behaviour.silence = 1.5;
  }

  std::size_t warnings() const
  {
    const auto& log = bus_->log();
    return static_cast<std::size_t>(std::count_if(log.begin(), log.end(), [](const bus::Finding& line) {
      return line.level == bus::Level::Warn && line.text.find("each try of its stop") != std::string::npos;
    }));
  }

  void loseB()
  {
    bus_->world("b offline");
    ASSERT_TRUE(bus_->runUntil(60.0, [&] { return !online(B); }));
  }
};

TEST_F(BesideAShortTimeOut, nobodyIsProbedWhileItRuns)
{
  turn(A, "a");
  loseB();
  bus_->run(10.0);
  const double before = bus_->gateway().blocked();
  bus_->run(60.0);
  EXPECT_EQ(bus_->gateway().blocked(), before);
  EXPECT_EQ(warnings(), 0U) << "no stop is pending";
  EXPECT_THAT(busValue("offline inverter back within"), HasSubstr("not while a runs"));
  bus_->wait(bus_->stop(A));
  bus_->run(60.0);
  EXPECT_GT(bus_->gateway().blocked(), before) << "at rest nothing is risked";
}

TEST_F(BesideAShortTimeOut, theStopOfAnOfflineInverterGoesAndIsWarnedOfOnce)
{
  bus_->settleIn(20.0);
  bus_->stream(B, 20.0, 0.1, 300.0);
  ASSERT_TRUE(bus_->runUntil(10.0, [&] { return bus_->motor("b", "run_coil") > 0.0; }));
  turn(A, "a");
  loseB();
  EXPECT_TRUE(bus_->status(B).stop_active) << "it may run";
  bus_->clearFrames();
  bus_->run(120.0);
  EXPECT_GE(bus_->count("02 05 00 00 00"), 3U) << "at the paid rate";
  EXPECT_LE(bus_->count("02 05 00 00 00"), 8U);
  EXPECT_EQ(warnings(), 1U);
  EXPECT_THAT(bus_->logTexts(),
              Contains(AllOf(HasSubstr("b: offline, but it may run"), HasSubstr("blocks the gateway for 1.5"),
                             HasSubstr("time-out of a, which is running"), HasSubstr("800 ms"))));
  bus_->world("b online");
  ASSERT_TRUE(bus_->runUntil(60.0, [&] { return online(B) && !bus_->status(B).stop_active; }));
  EXPECT_EQ(bus_->motor("b", "run_coil"), 0.0);
  // Started and away again: that is another stop.
  bus_->command(B, 0.0);
  ASSERT_TRUE(bus_->runUntil(10.0, [&] { return bus_->motor("b", "run_coil") > 0.0; }));
  loseB();
  bus_->run(60.0);
  EXPECT_EQ(warnings(), 2U);
}

TEST_F(BehindAGateway, stopLatencyEndsAtTheAnswer)
{
  start();
  turn(A, "a");
  bus_->gateway().behaviour.silence = 1.0;
  bus_->world("b offline");
  ASSERT_TRUE(bus_->runUntil(30.0, [&] { return bus_->gateway().blocked() > 0.0; }));
  bus_->run(0.1);
  ASSERT_TRUE(bus_->runUntil(60.0, [&] { return bus_->gateway().busy(); })) << "it waits for b";
  bus_->wait(bus_->stop(A));
  bus_->run(2.0);
  EXPECT_GT(bus_->busStatuses().back().stop_latency_max, 0.3);
}

TEST_F(BehindAGateway, theBlockIsNamedWithTheSettingToShorten)
{
  start();
  bus_->gateway().behaviour.silence = 1.0;
  bus_->settleIn(20.0);
  bus_->world("b offline");
  ASSERT_TRUE(bus_->runUntil(60.0, [&] { return !online(B); }));
  bus_->run(10.0);
  std::string text;
  for (const bus::Finding& finding : bus_->coordinator().report(bus_->now()).findings)
  {
    text += finding.text + "\n";
  }
  EXPECT_THAT(text, HasSubstr("blocks the gateway for 1"));
  EXPECT_THAT(text, HasSubstr("response_timeout"));
  EXPECT_THAT(bus_->diagnostics(A), Not(HasSubstr("would have caught it"))) << "it waited behind another request";
}
}  // namespace
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The rules of section 3 of the contract that the scheduler alone can keep, in virtual time.

#include "bus/rules/scheduler.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::Ge;
using testing::Gt;
using testing::IsEmpty;
using testing::Le;
using testing::Lt;
using testing::Not;
using testing::SizeIs;

using Names = std::vector<std::string>;

Scheduler::Settings settings(std::size_t inverters, Duration interval, unsigned idle_divisor)
{
  Scheduler::Settings settings;
  settings.inverters = inverters;
  settings.interval = interval;
  settings.idle_divisor = idle_divisor;
  return settings;
}

/// A bus whose drives answer in 10 ms; a dead one costs 110 ms. Exchanges are named by kind and inverter (commands by
/// their number): S stop, C command, R refresh, P probe, B background.
class VirtualLine
{
public:
  explicit VirtualLine(std::size_t inverters, Duration interval = Duration{ 0 }, unsigned idle_divisor = 1)
    : scheduler(settings(inverters, interval, idle_divisor)), views(inverters), reads_done_(inverters, 0)
  {
  }

  Pick next()
  {
    return scheduler.next(now, views);
  }

  /// Waits until something is due, at most ten minutes, and does it.
  std::string exchange()
  {
    const TimePoint give_up = now + std::chrono::minutes(10);
    Pick pick = next();
    while (pick.what == Pick::What::Nothing && now < give_up)
    {
      EXPECT_GT(pick.wake, now) << "a wake-up that does not lie ahead";
      now = std::max(pick.wake, now + Ms(1));
      pick = next();
    }
    finish(pick);
    return name(pick);
  }

  Names exchanges(int count)
  {
    Names names;
    for (int done = 0; done < count; ++done)
    {
      names.push_back(exchange());
    }
    return names;
  }

  /// Exchanges until \p end.
  Names exchangesUntil(TimePoint end)
  {
    Names names;
    while (now < end)
    {
      names.push_back(exchange());
    }
    return names;
  }

  void finish(const Pick& pick)
  {
    const TimePoint start = now;
    const bool answered = dead.count(pick.inverter) == 0;
    now += answered ? Ms(10) : Ms(110);
    probe_time += pick.probe ? now - start : Duration{ 0 };
    const bool more = answered && moreOf(pick);
    scheduler.done(pick, start, now, more, answered);
    follow(pick, answered);
  }

  void push(CommandId id, CommandKind kind, std::vector<std::size_t> inverters, int frames = 1)
  {
    WaitingCommand command;
    command.id = id;
    command.kind = kind;
    command.inverters = std::move(inverters);
    frames_[id] = frames;
    scheduler.push(command);
  }

  /// A command that comes out of another one.
  void setFrames(CommandId id, int frames)
  {
    frames_[id] = frames;
  }

  void pushZero(CommandId id, std::size_t inverter)
  {
    WaitingCommand command;
    command.id = id;
    command.inverters = { inverter };
    command.urgent = true;
    frames_[id] = 1;
    scheduler.push(command);
  }

  void stop(std::size_t inverter)
  {
    views[inverter].stop_pending = true;
    views[inverter].stop_attempts = 0;
    views[inverter].stop_written = false;
  }

  void kill(std::size_t inverter)
  {
    dead.insert(inverter);
    views[inverter].offline = true;
  }

  static std::string name(const Pick& pick)
  {
    const std::map<Pick::What, std::string> letters{
      { Pick::What::Nothing, "-" }, { Pick::What::Stop, "S" },    { Pick::What::Velocity, "C" },
      { Pick::What::Service, "C" }, { Pick::What::Refresh, "R" }, { Pick::What::Connect, "N" },
      { Pick::What::Probe, "P" },   { Pick::What::Setting, "B" },
    };
    return letters.at(pick.what) +
           std::to_string(pick.isCommand() ? pick.command : static_cast<CommandId>(pick.inverter));
  }

  Scheduler scheduler;
  std::vector<InverterView> views;
  TimePoint now = at(0);
  std::set<std::size_t> dead;
  /// Inverters whose RUN stays on whatever is written.
  std::set<std::size_t> stubborn;
  /// Time after an answer at which the next frame must go.
  std::map<std::size_t, Duration> serve_within;
  int reads_per_refresh = 1;
  Duration probe_time{ 0 };

private:
  bool moreOf(const Pick& pick)
  {
    if (pick.isCommand())
    {
      return --frames_.at(pick.command) > 0;
    }
    if (pick.inTurnOfRefresh())
    {
      reads_done_[pick.inverter] = (reads_done_[pick.inverter] + 1) % reads_per_refresh;
      return reads_done_[pick.inverter] != 0;
    }
    return false;
  }

  void follow(const Pick& pick, bool answered)
  {
    InverterView& view = views[pick.inverter];
    if (answered && serve_within.count(pick.inverter) != 0)
    {
      view.serve_by = now + serve_within.at(pick.inverter);
    }
    if (pick.what == Pick::What::Stop)
    {
      const bool failed = !answered || (view.stop_written && stubborn.count(pick.inverter) != 0);
      view.stop_attempts += failed ? 1 : 0;
      view.stop_pending = failed || !view.stop_written;
      view.stop_written = !failed && !view.stop_written;
    }
  }

  std::map<CommandId, int> frames_;
  std::vector<int> reads_done_;
};

Names only(char kind, const Names& names)
{
  Names found;
  std::copy_if(names.begin(), names.end(), std::back_inserter(found),
               [&](const std::string& name) { return name.front() == kind; });
  return found;
}

/// Longest run of exchanges without one of \p kind.
std::size_t longestWithout(char kind, const Names& names)
{
  std::size_t longest = 0;
  std::size_t run = 0;
  for (const std::string& name : names)
  {
    run = name.front() == kind ? 0 : run + 1;
    longest = std::max(longest, run);
  }
  return longest;
}

std::size_t longestRow(char kind, const Names& names)
{
  std::size_t longest = 0;
  std::size_t run = 0;
  for (const std::string& name : names)
  {
    run = name.front() == kind ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

// --- rule 3.1: stop first --------------------------------------------------------------------------------------------

TEST(Scheduler, sendsAStopBeforeEverythingElse)
{
  VirtualLine line(4);
  line.kill(3);
  line.views[1].serve_by = at(0);
  line.views[1].background = true;
  line.push(1, CommandKind::Velocity, { 1 });
  line.pushZero(2, 1);
  line.push(3, CommandKind::ReadParameter, { 0 });
  line.stop(2);
  EXPECT_THAT(line.exchanges(2), ElementsAre("S2", "S2"));
}

TEST(Scheduler, tellsVelocitiesFromServices)
{
  VirtualLine line(2);
  line.push(1, CommandKind::Velocity, { 0 });
  EXPECT_EQ(line.next().what, Pick::What::Velocity);
  line.scheduler.erase(1);
  for (const auto kind :
       { CommandKind::Reset, CommandKind::ReadFaults, CommandKind::ReadParameter, CommandKind::WriteParameter })
  {
    line.push(2, kind, { 1 });
    EXPECT_EQ(line.next().what, Pick::What::Service);
    line.scheduler.erase(2);
  }
}

TEST(Scheduler, whatIsSettledBeforeAStatusGoesInTheTurnOfTheRefresh)
{
  VirtualLine line(3);
  line.reads_per_refresh = 2;
  line.views[1].connect_due = true;
  EXPECT_THAT(line.exchanges(6), ElementsAre("R0", "R0", "N1", "N1", "R2", "R2"));
  EXPECT_EQ(line.scheduler.cycles(), 0U);
  line.views[1].connect_due = false;
  EXPECT_THAT(line.exchanges(4), ElementsAre("R0", "R0", "R1", "R1"));
  EXPECT_EQ(line.scheduler.cycles(), 1U);
}

TEST(Scheduler, whatIsSettledBeforeAStatusHasTheDeadlineOfTheRefresh)
{
  VirtualLine line(3);
  line.views[2].connect_due = true;
  line.views[2].serve_by = at(0);
  const Pick pick = line.next();
  EXPECT_EQ(pick.what, Pick::What::Connect);
  EXPECT_EQ(pick.inverter, 2U);
  EXPECT_TRUE(pick.deadline);
}

TEST(Scheduler, sendsAStopThatArrivesDuringAnExchangeDirectlyAfterIt)
{
  VirtualLine line(3);
  const Pick in_flight = line.next();
  line.stop(2);
  line.push(1, CommandKind::Velocity, { 0 });
  line.finish(in_flight);
  EXPECT_EQ(line.exchange(), "S2");
}

TEST(Scheduler, stopWaitsForNoInterval)
{
  VirtualLine line(1, std::chrono::minutes(5));
  line.exchange();
  ASSERT_EQ(line.next().what, Pick::What::Nothing);
  line.stop(0);
  const TimePoint accepted = line.now;
  EXPECT_EQ(VirtualLine::name(line.next()), "S0");
  EXPECT_EQ(line.now, accepted);
}

TEST(Scheduler, stopWaitsForNoBarAfterALostReply)
{
  VirtualLine line(1);
  line.views[0].refresh_not_before = at(1000);
  ASSERT_EQ(line.next().what, Pick::What::Nothing);
  line.stop(0);
  EXPECT_EQ(VirtualLine::name(line.next()), "S0");
}

TEST(Scheduler, stopOfAnOfflineInverterWaitsForNoBackOff)
{
  VirtualLine line(2);
  line.kill(1);
  while (line.exchange() != "P1")
  {
  }
  line.stop(1);
  EXPECT_EQ(line.exchange(), "S1");
}

TEST(Scheduler, multiFrameCommandGivesWayToAStopBetweenItsFrames)
{
  VirtualLine line(3);
  line.push(1, CommandKind::Velocity, { 0 }, 3);
  ASSERT_EQ(line.exchange(), "C1");
  line.stop(2);
  EXPECT_THAT(line.exchanges(4), ElementsAre("S2", "S2", "C1", "C1"));
}

// --- rule 3.2: other commands wait for the stop ----------------------------------------------------------------------

TEST(Scheduler, commandsBehindAPendingStopWaitForIt)
{
  VirtualLine line(2);
  line.push(1, CommandKind::ReadParameter, { 0 });
  line.stop(0);
  EXPECT_THAT(line.exchanges(3), ElementsAre("S0", "S0", "C1"));
}

TEST(Scheduler, commandsBehindAStopThatInsistsWaitForItToo)
{
  VirtualLine line(2);
  line.dead.insert(0);
  line.push(1, CommandKind::Reset, { 0 });
  line.stop(0);
  EXPECT_THAT(line.exchanges(40), Not(Contains("C1")));
  line.dead.clear();
  EXPECT_THAT(line.exchanges(20), Contains("C1"));
}

TEST(Scheduler, stopOfOneInverterHoldsNoCommandOfAnotherBackWhileItInsists)
{
  VirtualLine line(2);
  line.dead.insert(0);
  line.stop(0);
  line.exchanges(10);
  line.push(1, CommandKind::ReadParameter, { 1 });
  EXPECT_THAT(line.exchanges(2), Contains("C1"));
}

// --- rule 3.3: a stop insists ----------------------------------------------------------------------------------------

TEST(Scheduler, triesAnUnconfirmedStopThreeTimesAtOnce)
{
  VirtualLine line(2);
  line.dead.insert(0);
  line.stop(0);
  EXPECT_THAT(line.exchanges(3), ElementsAre("S0", "S0", "S0"));
}

TEST(Scheduler, letsSomethingElseThroughAfterThreeTriesOfAStop)
{
  VirtualLine line(2);
  line.dead.insert(0);
  line.exchanges(20);
  line.stop(0);
  line.exchanges(3);
  EXPECT_EQ(line.exchange().front(), 'R');
}

TEST(Scheduler, insistsAsEverySecondExchangeAtMost)
{
  VirtualLine line(2);
  line.dead.insert(0);
  line.stop(0);
  line.exchanges(4);
  const Names later = line.exchanges(6);
  EXPECT_EQ(longestRow('S', later), 1U);
  EXPECT_EQ(only('S', later).size(), 3U);
}

TEST(Scheduler, stopThatWasTriedOftenInVainLeavesHalfOfTheTimeToTheOthers)
{
  VirtualLine line(3);
  line.dead.insert(0);
  line.stop(0);
  line.exchanges(20);
  const TimePoint start = line.now;
  const Names names = line.exchangesUntil(start + std::chrono::seconds(60));
  // A try takes 110 ms.
  EXPECT_THAT(only('S', names).size(), AllOf(Ge(150U), Le(273U)));
}

TEST(Scheduler, stopThatIsAnsweredInVainGoesOnAsEverySecondExchange)
{
  VirtualLine line(2);
  line.stubborn.insert(0);
  line.stop(0);
  line.exchanges(40);
  EXPECT_THAT(only('S', line.exchanges(200)).size(), Ge(60U));
}

TEST(Scheduler, neverStopsInsisting)
{
  VirtualLine line(3);
  line.dead.insert(0);
  line.stop(0);
  const Names names = line.exchanges(1000);
  // As long as a try takes, 110 ms, others have theirs of 10 ms, and each of the dead one's own.
  EXPECT_THAT(longestWithout('S', names), Le(12U));
}

TEST(Scheduler, insistsDuringThePauseOfTheInterval)
{
  VirtualLine line(1, std::chrono::minutes(5));
  line.stubborn.insert(0);
  line.exchange();
  line.stop(0);
  const TimePoint accepted = line.now;
  EXPECT_THAT(only('S', line.exchanges(20)).size(), Ge(10U));
  EXPECT_LT(toSeconds(line.now - accepted), 5.0) << "20 exchanges of 10 ms waited for the interval";
}

TEST(Scheduler, insistsWhileEveryRefreshIsBarred)
{
  VirtualLine line(1);
  line.stubborn.insert(0);
  line.stop(0);
  line.views[0].refresh_not_before = at(600000);
  line.exchanges(20);
  EXPECT_LT(toSeconds(line.now - at(0)), 5.0) << "20 exchanges of 10 ms waited for the refresh";
}

TEST(Scheduler, writesAllStopsBeforeItReadsOneBack)
{
  VirtualLine line(3);
  line.stop(0);
  line.stop(1);
  line.stop(2);
  EXPECT_THAT(line.exchanges(6), ElementsAre("S0", "S1", "S2", "S0", "S1", "S2"));
}

TEST(Scheduler, stopsOfSeveralInvertersTakeTurns)
{
  VirtualLine line(4);
  line.dead = { 0, 2 };
  line.stop(0);
  line.stop(1);
  line.stop(2);
  EXPECT_THAT(line.exchanges(8), ElementsAre("S0", "S1", "S2", "S1", "S0", "S2", "S0", "S2"));
}

TEST(Scheduler, deadInverterThatWasTriedNeverDelaysTheStopOfALiveOne)
{
  for (int tried = 1; tried < 12; ++tried)
  {
    VirtualLine line(2);
    line.dead.insert(0);
    line.stop(0);
    line.exchanges(tried);
    line.stop(1);
    EXPECT_THAT(line.exchanges(2), ElementsAre("S1", "S1")) << "after " << tried << " exchanges";
  }
}

TEST(Scheduler, stopsLiveInvertersBeforeOfflineOnes)
{
  VirtualLine line(3);
  line.kill(0);
  line.stop(0);
  line.stop(1);
  line.stop(2);
  EXPECT_THAT(line.exchanges(5), ElementsAre("S1", "S2", "S1", "S2", "S0"));
}

TEST(Scheduler, pendingStopOfAnOfflineInverterIsItsProbe)
{
  VirtualLine line(2);
  line.kill(0);
  line.stop(0);
  const Names names = line.exchangesUntil(at(60000));
  EXPECT_THAT(names, Not(Contains("P0")));
  // One try of 110 ms in 2.2 s is 5 %.
  EXPECT_THAT(only('S', names).size(), AllOf(Ge(26U), Le(28U)));
}

TEST(Scheduler, stopThatIsAProbeIsPaidFromTheProbesShare)
{
  VirtualLine line(1);
  line.kill(0);
  line.stop(0);
  const Pick pick = line.next();
  EXPECT_EQ(pick.what, Pick::What::Stop);
  EXPECT_TRUE(pick.probe);
}

TEST(Scheduler, stopOfALiveInverterIsNotPaidFromTheProbesShare)
{
  VirtualLine line(1);
  line.stop(0);
  EXPECT_FALSE(line.next().probe);
}

// --- rule 3.4: order of commands -------------------------------------------------------------------------------------

TEST(Scheduler, commandsOfOneExchangeGoKindByKindInNodeOrder)
{
  VirtualLine line(3);
  const Pick in_flight = line.next();
  line.push(1, CommandKind::ReadParameter, { 2 });
  line.push(2, CommandKind::Velocity, { 1 });
  line.push(3, CommandKind::ReadParameter, { 0 });
  line.push(4, CommandKind::Velocity, { 2 });
  line.push(5, CommandKind::WriteParameter, { 0 });
  line.push(6, CommandKind::Velocity, { 0 });
  line.push(7, CommandKind::Reset, { 1 });
  line.push(8, CommandKind::ReadFaults, { 1 });
  line.push(9, CommandKind::ReadParameter, { 1 });
  line.finish(in_flight);
  EXPECT_THAT(only('C', line.exchanges(20)), ElementsAre("C6", "C2", "C4", "C7", "C8", "C3", "C9", "C1", "C5"));
}

TEST(Scheduler, commandsOfTheSameKindAndInverterKeepTheirOrder)
{
  VirtualLine line(1);
  line.push(7, CommandKind::ReadParameter, { 0 });
  line.push(3, CommandKind::ReadParameter, { 0 });
  line.push(5, CommandKind::ReadParameter, { 0 });
  EXPECT_THAT(only('C', line.exchanges(8)), ElementsAre("C7", "C3", "C5"));
}

TEST(Scheduler, commandsOfAnEarlierExchangeGoBeforeThoseOfALaterOne)
{
  VirtualLine line(3);
  line.push(1, CommandKind::WriteParameter, { 2 });
  line.push(2, CommandKind::WriteParameter, { 1 });
  const Pick in_flight = line.next();
  line.push(3, CommandKind::Velocity, { 0 });
  line.finish(in_flight);
  EXPECT_THAT(only('C', line.exchanges(6)), ElementsAre("C1", "C3"));
}

TEST(Scheduler, frameOfAServiceThatIsQueuedAnewGoesBehindThoseThatWaited)
{
  VirtualLine line(2);
  line.push(1, CommandKind::ReadFaults, { 0 });
  line.push(2, CommandKind::ReadParameter, { 1 });
  ASSERT_EQ(line.exchange(), "C1");
  line.push(1, CommandKind::ReadFaults, { 0 });
  EXPECT_THAT(only('C', line.exchanges(5)), ElementsAre("C2", "C1"));
}

TEST(Scheduler, commandOfZeroGoesBeforeCommandsThatWaitedLonger)
{
  VirtualLine line(3);
  line.push(1, CommandKind::Velocity, { 0 });
  line.push(2, CommandKind::ReadParameter, { 1 });
  line.exchange();
  line.pushZero(3, 2);
  EXPECT_EQ(line.exchange(), "C3");
}

TEST(Scheduler, waitingVelocityThatBecomesZeroGoesFirst)
{
  VirtualLine line(3);
  line.push(1, CommandKind::Velocity, { 0 });
  line.push(2, CommandKind::Velocity, { 1 });
  line.push(3, CommandKind::Velocity, { 2 });
  line.scheduler.makeUrgent(2, true);
  EXPECT_EQ(line.exchange(), "C3");
}

TEST(Scheduler, zeroThatBecomesAVelocityAgainIsNoMoreUrgent)
{
  VirtualLine line(3);
  line.push(1, CommandKind::Velocity, { 0 });
  line.pushZero(2, 2);
  line.scheduler.makeUrgent(2, false);
  EXPECT_EQ(line.exchange(), "C1");
}

TEST(Scheduler, postponedCommandWaitsForItsTimeAndHoldsNothingBack)
{
  VirtualLine line(2);
  line.push(1, CommandKind::Velocity, { 0 });
  line.push(2, CommandKind::ReadParameter, { 1 });
  line.scheduler.postpone(1, at(500));
  EXPECT_EQ(line.exchange(), "C2");
  const Names early = line.exchangesUntil(at(500));
  EXPECT_THAT(early, AllOf(Not(IsEmpty()), Not(Contains("C1"))));
  EXPECT_EQ(line.exchange(), "C1");
}

// --- rule 3.5: velocity is coalesced ---------------------------------------------------------------------------------

TEST(Scheduler, newerVelocityTakesThePlaceOfTheWaitingOne)
{
  VirtualLine line(2);
  line.push(1, CommandKind::ReadParameter, { 1 });
  line.push(2, CommandKind::Velocity, { 0 });
  line.push(3, CommandKind::WriteParameter, { 1 });
  ASSERT_EQ(line.exchange(), "C2");
  line.push(4, CommandKind::Velocity, { 0 });
  line.exchange();
  line.push(5, CommandKind::Velocity, { 0 });
  EXPECT_THAT(only('C', line.exchanges(8)), ElementsAre("C1", "C3", "C5"));
}

TEST(Scheduler, newerVelocityKeepsThePlaceBeforeCommandsThatCameBetween)
{
  VirtualLine line(3);
  line.push(1, CommandKind::Velocity, { 0 });
  line.push(2, CommandKind::Velocity, { 2 });
  ASSERT_EQ(line.exchange(), "C1");
  line.push(3, CommandKind::Velocity, { 1 });
  line.exchange();
  line.push(4, CommandKind::Velocity, { 2 });
  EXPECT_THAT(only('C', line.exchanges(6)), ElementsAre("C4", "C3"));
}

TEST(Scheduler, atMostOneVelocityWaitsPerInverter)
{
  VirtualLine line(1);
  for (CommandId id = 1; id <= 100; ++id)
  {
    line.push(id, CommandKind::Velocity, { 0 });
  }
  EXPECT_THAT(only('C', line.exchanges(20)), ElementsAre("C100"));
}

TEST(Scheduler, groupTakesTheEarliestPlaceOfItsMembers)
{
  VirtualLine line(4);
  line.push(1, CommandKind::Velocity, { 3 });
  line.push(2, CommandKind::Velocity, { 2 });
  ASSERT_EQ(line.exchange(), "C2");
  line.push(3, CommandKind::Velocity, { 0 });
  line.exchange();
  line.push(4, CommandKind::Velocity, { 1, 3 }, 2);
  EXPECT_THAT(only('C', line.exchanges(6)), ElementsAre("C4", "C4", "C3"));
}

TEST(Scheduler, newerVelocityTakesItsInverterOutOfAWaitingGroup)
{
  VirtualLine line(3);
  line.push(1, CommandKind::Velocity, { 0, 1, 2 });
  line.push(2, CommandKind::Velocity, { 1 });
  EXPECT_THAT(line.scheduler.members(1), ElementsAre(0U, 2U));
  EXPECT_THAT(line.scheduler.members(2), ElementsAre(1U));
}

TEST(Scheduler, erasedVelocityWaitsNoMore)
{
  VirtualLine line(2);
  line.push(1, CommandKind::Velocity, { 0 });
  ASSERT_TRUE(line.scheduler.velocityWaits(0));
  ASSERT_FALSE(line.scheduler.velocityWaits(1));
  line.scheduler.eraseVelocity(0);
  EXPECT_FALSE(line.scheduler.velocityWaits(0));
  EXPECT_THAT(line.exchanges(10), Each(testing::StartsWith("R")));
}

TEST(Scheduler, erasingAVelocityLeavesTheServicesOfItsInverter)
{
  VirtualLine line(1);
  line.push(1, CommandKind::Velocity, { 0 });
  line.push(2, CommandKind::ReadParameter, { 0 });
  line.scheduler.eraseVelocity(0);
  EXPECT_THAT(only('C', line.exchanges(5)), ElementsAre("C2"));
}

// --- rule 3.6: commands and refreshes --------------------------------------------------------------------------------

TEST(Scheduler, loneCommandWaitsForNothingButTheExchangeInFlight)
{
  VirtualLine line(3);
  line.reads_per_refresh = 2;
  for (int before = 0; before < 8; ++before)
  {
    line.exchanges(before);
    const Pick in_flight = line.next();
    line.push(static_cast<CommandId>(before + 1), CommandKind::Velocity, { 2 });
    line.finish(in_flight);
    EXPECT_EQ(line.exchange(), "C" + std::to_string(before + 1));
  }
}

TEST(Scheduler, commandsAndRefreshesAlternateWhileSeveralWait)
{
  VirtualLine line(2);
  for (CommandId id = 1; id <= 4; ++id)
  {
    line.push(id, CommandKind::ReadParameter, { 0 });
  }
  // The last one is alone: it waits for the exchange in flight only.
  EXPECT_THAT(line.exchanges(7), ElementsAre("C1", "R0", "C2", "R1", "C3", "C4", "R0"));
}

TEST(Scheduler, groupCountsAsOneCommand)
{
  VirtualLine line(3);
  line.push(1, CommandKind::Velocity, { 0, 1, 2 }, 6);
  line.push(2, CommandKind::ReadParameter, { 0 });
  line.push(3, CommandKind::ReadParameter, { 1 });
  EXPECT_THAT(line.exchanges(9), ElementsAre("C1", "C1", "C1", "C1", "C1", "C1", "R0", "C2", "C3"));
}

TEST(Scheduler, refreshesGoOnWhileLoneCommandsFollowEachOther)
{
  VirtualLine line(2);
  Names names;
  for (CommandId id = 1; id <= 200; ++id)
  {
    line.push(id, CommandKind::Velocity, { 0 });
    names.push_back(line.exchange());
  }
  EXPECT_THAT(longestWithout('R', names), Le(4U));
}

TEST(Scheduler, framesOfAUnitStayTogetherButForOthersThatWait)
{
  VirtualLine line(3);
  line.views[2].background = true;
  line.push(1, CommandKind::Velocity, { 0 }, 3);
  line.push(2, CommandKind::Velocity, { 1 }, 3);
  line.push(3, CommandKind::ReadParameter, { 1 });
  // Neither 0 nor 1 goes on while the other one waits (rule 8.1); no refresh and no long job comes between.
  const Names names = line.exchanges(5);
  EXPECT_THAT(names, ElementsAre("C1", "C2", "C1", "C2", "C1"));
}

TEST(Scheduler, unitThatWasCutShortGoesOnNoMore)
{
  VirtualLine line(2);
  line.push(1, CommandKind::Velocity, { 0 }, 3);
  ASSERT_EQ(line.exchange(), "C1");
  line.scheduler.eraseVelocity(0);
  EXPECT_THAT(line.exchanges(6), Not(Contains("C1")));
}

TEST(Scheduler, newCommandOfAnotherInverterIsPutBetweenTheFramesOfAUnit)
{
  VirtualLine line(2);
  line.push(1, CommandKind::Velocity, { 0 }, 3);
  ASSERT_EQ(line.exchange(), "C1");
  line.push(2, CommandKind::Velocity, { 1 }, 1);
  EXPECT_THAT(line.exchanges(2), ElementsAre("C2", "C1"));
  EXPECT_THAT(line.exchanges(2), Contains("C1"));
}

TEST(Scheduler, newCommandOfTheSameInverterWaitsForItsUnit)
{
  VirtualLine line(2);
  line.push(1, CommandKind::Velocity, { 0 }, 3);
  ASSERT_EQ(line.exchange(), "C1");
  line.push(2, CommandKind::ReadParameter, { 0 });
  EXPECT_THAT(line.exchanges(2), Each("C1"));
}

TEST(Scheduler, refreshGoesRoundRobinInNodeOrder)
{
  VirtualLine line(3);
  EXPECT_THAT(line.exchanges(7), ElementsAre("R0", "R1", "R2", "R0", "R1", "R2", "R0"));
}

TEST(Scheduler, refreshOfSeveralReadsIsFinishedBeforeTheNextInverter)
{
  VirtualLine line(2);
  line.reads_per_refresh = 2;
  EXPECT_THAT(line.exchanges(5), ElementsAre("R0", "R0", "R1", "R1", "R0"));
}

TEST(Scheduler, roundRobinSkipsOfflineInvertersAndThoseThatMayNotBeAsked)
{
  VirtualLine line(4);
  line.kill(1);
  line.views[2].refresh_not_before = at(1000);
  EXPECT_THAT(only('R', line.exchanges(5)), ElementsAre("R0", "R3", "R0", "R3"));
  line.exchangesUntil(at(1000));
  EXPECT_THAT(line.exchanges(5), Contains("R2"));
}

TEST(Scheduler, countsCyclesAndMeasuresThem)
{
  VirtualLine line(3, Ms(500));
  line.exchanges(6);
  line.next();
  EXPECT_EQ(line.scheduler.cycles(), 2U);
  EXPECT_EQ(line.scheduler.cycleTime(), Ms(30));
  EXPECT_EQ(line.scheduler.exchanges(), 6U);
}

// --- interval and idle_divisor ---------------------------------------------------------------------------------------

TEST(Scheduler, intervalIsAPauseAfterEachCycle)
{
  VirtualLine line(2, Ms(400));
  line.exchanges(2);
  const TimePoint end_of_cycle = line.now;
  EXPECT_EQ(line.exchange(), "R0");
  EXPECT_EQ(line.now, end_of_cycle + Ms(400) + Ms(10));
}

TEST(Scheduler, intervalNeverDelaysACommand)
{
  VirtualLine line(1, std::chrono::minutes(5));
  line.exchange();
  for (CommandId id = 1; id <= 10; ++id)
  {
    ASSERT_EQ(line.next().what, Pick::What::Nothing);
    line.push(id, CommandKind::Velocity, { 0 });
    EXPECT_TRUE(line.next().isCommand());
    line.finish(line.next());
    line.now += Ms(100);
  }
}

TEST(Scheduler, severalCommandsInThePauseGoWithoutARefreshBetween)
{
  VirtualLine line(1, std::chrono::minutes(5));
  line.exchange();
  const TimePoint start = line.now;
  line.push(1, CommandKind::Velocity, { 0 });
  line.push(2, CommandKind::ReadParameter, { 0 });
  line.push(3, CommandKind::ReadParameter, { 0 });
  EXPECT_THAT(line.exchanges(3), ElementsAre("C1", "C2", "C3"));
  EXPECT_EQ(line.now, start + Ms(30));
}

TEST(Scheduler, invertersAtRestAreRefreshedInEveryNthCycleOnly)
{
  VirtualLine line(3, Duration{ 0 }, 3);
  line.views[1].at_rest = true;
  line.views[2].at_rest = true;
  EXPECT_THAT(line.exchanges(10), ElementsAre("R0", "R1", "R2", "R0", "R0", "R0", "R1", "R2", "R0", "R0"));
}

TEST(Scheduler, runningInverterIsRefreshedInEveryCycleWhateverTheDivisor)
{
  VirtualLine line(5, Duration{ 0 }, 100);
  for (std::size_t index = 1; index < 5; ++index)
  {
    line.views[index].at_rest = true;
  }
  const Names names = line.exchanges(500);
  EXPECT_THAT(only('R', names).size(), 500U);
  EXPECT_GE(std::count(names.begin(), names.end(), "R0"), 475);
  EXPECT_GE(std::count(names.begin(), names.end(), "R4"), 4);
}

TEST(Scheduler, divisorLeavesNoHoleWhenAllInvertersAreAtRest)
{
  VirtualLine line(2, Duration{ 0 }, 4);
  line.views[0].at_rest = true;
  line.views[1].at_rest = true;
  EXPECT_THAT(line.exchanges(4), ElementsAre("R0", "R1", "R0", "R1"));
  EXPECT_EQ(line.now, at(40));
}

// --- rule 3.7: offline inverters -------------------------------------------------------------------------------------

class ProbeShare : public testing::TestWithParam<std::size_t>
{
};

TEST_P(ProbeShare, probesTakeAtMostFivePercentOfTheBusTime)
{
  VirtualLine line(GetParam() + 1);
  for (std::size_t index = 1; index <= GetParam(); ++index)
  {
    line.kill(index);
  }
  line.exchangesUntil(at(600000));
  // 30 s of 600, and the one probe that may have begun before the end.
  EXPECT_THAT(line.probe_time, AllOf(Gt(std::chrono::seconds(25)), Le(std::chrono::seconds(30) + Ms(110))));
}

TEST_P(ProbeShare, probesTakeTurns)
{
  VirtualLine line(GetParam() + 1);
  for (std::size_t index = 1; index <= GetParam(); ++index)
  {
    line.kill(index);
  }
  const Names probes = only('P', line.exchangesUntil(at(600000)));
  ASSERT_GT(probes.size(), GetParam());
  for (std::size_t index = 0; index < probes.size(); ++index)
  {
    ASSERT_EQ(probes[index], "P" + std::to_string(1 + index % GetParam()));
  }
}

TEST_P(ProbeShare, nothingElseGetsSlowerByMoreThanTheProbesShare)
{
  VirtualLine line(GetParam() + 2);
  for (std::size_t index = 2; index < GetParam() + 2; ++index)
  {
    line.kill(index);
  }
  const Names names = line.exchangesUntil(at(600000));
  // 60,000 refreshes of 10 ms fit into the time without probes.
  EXPECT_THAT(only('R', names).size(), Ge(56900U));
}

TEST_P(ProbeShare, backOffNeverTouchesLiveInverters)
{
  VirtualLine line(GetParam() + 2);
  for (std::size_t index = 2; index < GetParam() + 2; ++index)
  {
    line.kill(index);
  }
  const Names names = line.exchangesUntil(at(100000));
  EXPECT_THAT(names, AllOf(Not(Contains("P0")), Not(Contains("P1"))));
  EXPECT_EQ(longestRow('P', names), 1U);
  const Names refreshes = only('R', names);
  for (std::size_t index = 0; index < refreshes.size(); ++index)
  {
    ASSERT_EQ(refreshes[index], index % 2 == 0 ? "R0" : "R1");
  }
}

INSTANTIATE_TEST_SUITE_P(Scheduler, ProbeShare, testing::Values(1U, 5U, 30U));

TEST(Scheduler, loneDeadInverterIsAskedOftenEnoughToBeBackWithinThreeSeconds)
{
  VirtualLine line(2);
  line.kill(1);
  TimePoint last = line.now;
  while (line.now < at(100000))
  {
    if (line.exchange() == "P1")
    {
      EXPECT_LE(line.now - last, std::chrono::seconds(3));
      last = line.now;
    }
  }
}

TEST(Scheduler, deadInverterIsStillAskedWithinThreeSecondsWhileCommandsFloodTheBus)
{
  VirtualLine line(3);
  line.kill(2);
  CommandId id = 0;
  TimePoint last = line.now;
  Duration longest{ 0 };
  while (line.now < at(30000))
  {
    line.push(++id, CommandKind::Velocity, { 0 });
    line.push(++id, CommandKind::Velocity, { 1 });
    last = line.exchange() == "P2" ? line.now : last;
    longest = std::max(longest, line.now - last);
  }
  EXPECT_LE(toSeconds(longest), 3.0);
}

TEST(Scheduler, pendingStopOfAnOfflineInverterIsTriedAgainWhileCommandsFloodTheBus)
{
  VirtualLine line(3);
  line.kill(2);
  line.stop(2);
  Names names;
  for (CommandId id = 1; line.now < at(30000); id += 2)
  {
    line.push(id, CommandKind::Velocity, { 0 });
    line.push(id + 1, CommandKind::Velocity, { 1 });
    names.push_back(line.exchange());
  }
  EXPECT_THAT(only('S', names).size(), Ge(10U));
}

TEST(Scheduler, probeThatIsAnsweredCostsNothingOfTheShare)
{
  VirtualLine line(2);
  line.views[0].offline = true;
  line.kill(1);
  ASSERT_EQ(line.exchange(), "P0");
  EXPECT_EQ(VirtualLine::name(line.next()), "P1");
}

TEST(Scheduler, probeWaitsForALoneCommand)
{
  VirtualLine line(2);
  line.kill(1);
  line.push(1, CommandKind::Velocity, { 0 });
  EXPECT_EQ(line.exchange(), "C1");
}

TEST(Scheduler, restartedCycleProbesAndRefreshesAtOnce)
{
  VirtualLine line(2, std::chrono::minutes(5));
  line.kill(1);
  line.exchanges(2);
  ASSERT_EQ(line.next().what, Pick::What::Nothing);
  line.scheduler.restartCycle(line.now);
  const TimePoint opened = line.now;
  EXPECT_THAT(line.exchanges(2), testing::UnorderedElementsAre("R0", "P1"));
  EXPECT_LE(line.now, opened + Ms(120));
}

// --- rule 8.1: nobody goes on while another one waits ------------------------------------------------------------------

TEST(Scheduler, membersOfAGroupTakeTurnsInNodeOrder)
{
  VirtualLine line(4);
  line.push(1, CommandKind::Velocity, { 0, 2, 3 }, 6);
  std::vector<std::size_t> members;
  for (int frame = 0; frame < 6; ++frame)
  {
    const Pick pick = line.next();
    ASSERT_EQ(pick.command, 1U);
    members.push_back(pick.inverter);
    line.finish(pick);
  }
  EXPECT_THAT(members, ElementsAre(0U, 2U, 3U, 0U, 2U, 3U));
}

TEST(Scheduler, memberThatIsSplitOffHoldsTheOthersOfItsGroupUpNoMore)
{
  VirtualLine line(4);
  line.push(1, CommandKind::Velocity, { 0, 2, 3 }, 5);
  ASSERT_EQ(line.exchange(), "C1");
  line.push(2, CommandKind::Velocity, { 1 }, 1);
  line.setFrames(9, 1);
  line.scheduler.splitOff(1, 0, 9, at(500), false);
  EXPECT_THAT(line.scheduler.members(1), ElementsAre(2U, 3U));
  EXPECT_THAT(line.scheduler.members(9), ElementsAre(0U));
  EXPECT_THAT(only('C', line.exchangesUntil(at(500))), ElementsAre("C1", "C1", "C1", "C1", "C2"));
  EXPECT_EQ(line.exchange(), "C9");
}

TEST(Scheduler, onlyMemberOfAVelocityThatIsSplitOffKeepsItsNumber)
{
  VirtualLine line(2);
  line.push(1, CommandKind::Velocity, { 0 });
  line.scheduler.splitOff(1, 0, 9, at(50), false);
  EXPECT_THAT(line.scheduler.members(1), ElementsAre(0U));
  EXPECT_THAT(line.scheduler.members(9), IsEmpty());
  EXPECT_THAT(only('C', line.exchangesUntil(at(50))), IsEmpty());
  EXPECT_EQ(line.exchange(), "C1");
}

TEST(Scheduler, deadlineOfAnotherInverterComesBetweenTheFramesOfAUnit)
{
  VirtualLine line(2);
  line.push(1, CommandKind::Velocity, { 0 }, 3);
  ASSERT_EQ(line.exchange(), "C1");
  line.views[1].serve_by = at(0);
  EXPECT_EQ(line.exchange(), "R1");
}

TEST(Scheduler, deadlinesThatCannotBeMetLetAUnitGoOnInTurns)
{
  VirtualLine line(3);
  line.serve_within = { { 1, Duration{ 0 } }, { 2, Duration{ 0 } } };
  line.push(1, CommandKind::Velocity, { 0 }, 3);
  ASSERT_EQ(line.exchange(), "C1");
  line.views[1].serve_by = line.views[2].serve_by = at(0);
  EXPECT_THAT(only('C', line.exchanges(4)), ElementsAre("C1", "C1"));
}

TEST(Scheduler, whoIsLostLetsEverybodyElseGoBeforeItsRepeat)
{
  for (const bool command_waits : { false, true })
  {
    VirtualLine line(3);
    line.push(1, CommandKind::Velocity, { 0 }, 5);
    const Pick lost = line.next();
    ASSERT_EQ(VirtualLine::name(lost), "C1");
    line.scheduler.done(lost, at(0), at(110), true, false);
    line.now = at(110);
    if (command_waits)
    {
      line.push(2, CommandKind::ReadParameter, { 1 });
    }
    EXPECT_EQ(line.exchange(), command_waits ? "C2" : "R1");
    EXPECT_THAT(line.exchanges(2), Contains("C1"));
  }
}

TEST(Scheduler, repeatGoesAtOnceWhereNobodyElseHasAnythingToSend)
{
  VirtualLine line(2, std::chrono::minutes(5));
  line.exchanges(2);
  line.push(1, CommandKind::Velocity, { 0 }, 2);
  const Pick lost = line.next();
  const TimePoint start = line.now;
  line.now += Ms(110);
  line.scheduler.done(lost, start, line.now, true, false);
  EXPECT_EQ(VirtualLine::name(line.next()), "C1");
}

TEST(Scheduler, lostReadIsRepeatedAfterTheNextInverter)
{
  VirtualLine line(3);
  const Pick lost = line.next();
  line.now = at(110);
  line.scheduler.done(lost, at(0), at(110), true, false);
  EXPECT_THAT(line.exchanges(4), ElementsAre("R1", "R0", "R2", "R0"));
}

TEST(Scheduler, lostReadOfTheLastInverterIsRepeatedInThePauseOfTheInterval)
{
  VirtualLine line(2, std::chrono::minutes(5));
  line.exchange();
  const Pick lost = line.next();
  ASSERT_EQ(VirtualLine::name(lost), "R1");
  line.now = at(120);
  line.scheduler.done(lost, at(10), at(120), true, false);
  EXPECT_EQ(VirtualLine::name(line.next()), "R1");
  EXPECT_EQ(line.now, at(120));
}

TEST(Scheduler, readThatIsWantedSoonWaitsForNoInterval)
{
  VirtualLine line(2, std::chrono::minutes(5));
  line.exchanges(2);
  ASSERT_EQ(line.next().what, Pick::What::Nothing);
  line.scheduler.readSoon(1);
  line.scheduler.readSoon(1);
  line.stop(0);
  EXPECT_THAT(line.exchanges(3), ElementsAre("S0", "S0", "R1"));
  EXPECT_EQ(line.next().what, Pick::What::Nothing);
}

TEST(Scheduler, readThatIsWantedSoonGoesBeforeDeadlines)
{
  VirtualLine line(3);
  line.serve_within = { { 0, Duration{ 0 } }, { 1, Duration{ 0 } } };
  line.views[0].serve_by = line.views[1].serve_by = at(0);
  line.exchanges(5);
  line.scheduler.readSoon(2);
  EXPECT_EQ(line.exchange(), "R2");
}

TEST(Scheduler, deadlinesThatCannotBeMetStarveNobodyWhileAStopInsists)
{
  VirtualLine line(4);
  line.dead.insert(3);
  line.stop(3);
  line.serve_within = { { 0, Duration{ 0 } }, { 1, Duration{ 0 } } };
  line.views[0].serve_by = line.views[1].serve_by = at(0);
  EXPECT_THAT(line.exchanges(30), Contains("R2"));
}

TEST(Scheduler, loneInverterRepeatsItsLostReadAtOnce)
{
  VirtualLine line(1);
  const Pick lost = line.next();
  line.now = at(110);
  line.scheduler.done(lost, at(0), at(110), true, false);
  EXPECT_EQ(VirtualLine::name(line.next()), "R0");
}

/// A stream of velocities for a dead inverter and one for a live one: nobody waits for more than one lost exchange.
TEST(Scheduler, deadInverterNeverHasTwoExchangesInARow)
{
  VirtualLine line(3);
  line.dead = { 1 };
  Names order;
  std::size_t in_a_row = 0;
  std::size_t most = 0;
  for (CommandId id = 1; id < 900; id += 2)
  {
    line.push(id, CommandKind::Velocity, { 1 }, 9);
    line.push(id + 1, CommandKind::Velocity, { 2 }, 2);
    const Pick pick = line.next();
    in_a_row = pick.inverter == 1 ? in_a_row + 1 : 0;
    most = std::max(most, in_a_row);
    order.push_back(VirtualLine::name(pick));
    line.finish(pick);
  }
  EXPECT_EQ(most, 1U);
  EXPECT_THAT(order, Contains("R0"));
  EXPECT_THAT(order, Contains("R2"));
}

TEST(Scheduler, longJobOfWhoHadTheLastExchangeWaitsForAnothersCommand)
{
  VirtualLine line(2);
  line.exchanges(7);
  line.views[0].background = true;
  line.push(1, CommandKind::ReadParameter, { 0 });
  line.push(2, CommandKind::ReadParameter, { 1 });
  Names names = line.exchanges(8);
  for (std::size_t index = 1; index < names.size(); ++index)
  {
    EXPECT_FALSE(names[index] == "B0" && names[index - 1] == "C1") << index;
  }
  EXPECT_THAT(names, Contains("B0"));
}

TEST(Scheduler, halvesOfRefreshesThatDeadlinesBeganTakeTurns)
{
  VirtualLine line(2, std::chrono::minutes(5));
  line.reads_per_refresh = 2;
  line.exchanges(4);
  line.serve_within = { { 0, Ms(700) }, { 1, Ms(700) } };
  line.views[0].serve_by = line.views[1].serve_by = line.now;
  EXPECT_THAT(line.exchanges(4), ElementsAre("R0", "R1", "R0", "R1"));
}

// --- rules 3.12 and 3.14 ---------------------------------------------------------------------------------------------

TEST(Scheduler, driveWhoseOwnTimeOutIsNearGoesBeforeCommands)
{
  VirtualLine line(3);
  line.push(1, CommandKind::Velocity, { 0 });
  line.views[2].serve_by = at(0);
  EXPECT_EQ(line.exchange(), "R2");
}

TEST(Scheduler, driveWhoseTimeOutIsNearestGoesFirst)
{
  VirtualLine line(3);
  line.views[0].serve_by = at(900);
  line.views[1].serve_by = at(800);
  line.views[2].serve_by = at(700);
  line.now = at(1000);
  EXPECT_EQ(VirtualLine::name(line.next()), "R2");
}

TEST(Scheduler, readBackOfAFloodOfStopsLetsARefreshThrough)
{
  VirtualLine line(2);
  line.views[0].stop_pending = true;
  int others = 0;
  for (int exchange = 0; exchange < 40; ++exchange)
  {
    // Written, read back, and asked for again at once.
    line.views[0].stop_written = exchange % 2 == 1;
    const Pick pick = line.next();
    const bool other = pick.what != Pick::What::Stop;
    EXPECT_FALSE(other && !line.views[0].stop_written) << "a stop's write waits for nothing";
    others += other ? 1 : 0;
    line.scheduler.done(pick, line.now, line.now + Ms(10), false, true);
    line.now += Ms(10);
  }
  EXPECT_GE(others, 3);
}

TEST(Scheduler, driveThatIsSilentWhenItsTimeHasComeLetsTheOthersGoFirst)
{
  VirtualLine line(3);
  line.views[0].serve_by = at(100);
  line.views[2].serve_by = at(900);
  line.dead = { 0 };
  line.now = at(1000);
  EXPECT_EQ(line.exchange(), "R0");
  EXPECT_EQ(line.exchange(), "R2") << "0 is over its time by far, and was tried a moment ago";
}

TEST(Scheduler, drivesThatAreSilentWhenTheirTimeHasComeTakeTurns)
{
  VirtualLine line(3);
  line.views[0].serve_by = at(100);
  line.views[1].serve_by = at(900);
  line.views[2].serve_by = at(905);
  line.dead = { 0, 1, 2 };
  line.now = at(1000);
  // The time of one that never answers never moves: it must not be the first one for ever.
  EXPECT_THAT(line.exchanges(6), ElementsAre("R0", "R1", "R2", "R0", "R1", "R2"));
}

TEST(Scheduler, repeatOfALostReadGivesWayToADriveWhoseTimeHasCome)
{
  VirtualLine line(3);
  line.views[0].serve_by = at(900);
  line.views[2].serve_by = at(1050);
  line.now = at(1000);
  const Pick lost = line.next();
  ASSERT_EQ(VirtualLine::name(lost), "R0");
  line.now = at(1110);
  line.scheduler.done(lost, at(1000), at(1110), true, false);
  EXPECT_EQ(VirtualLine::name(line.next()), "R2");
}

TEST(Scheduler, driveIsNotServedBeforeItsTurnWhileItsTimeOutIsFar)
{
  VirtualLine line(3);
  line.views[2].serve_by = at(1000);
  EXPECT_THAT(line.exchanges(2), ElementsAre("R0", "R1"));
}

TEST(Scheduler, deadlineCutsThePauseOfTheInterval)
{
  VirtualLine line(1, std::chrono::minutes(5));
  line.serve_within[0] = Ms(700);
  line.exchange();
  const TimePoint served = line.now;
  ASSERT_FALSE(line.scheduler.pauseWasCut());
  EXPECT_EQ(line.exchange(), "R0");
  EXPECT_EQ(line.now, served + Ms(700) + Ms(10));
  EXPECT_TRUE(line.scheduler.pauseWasCut());
}

TEST(Scheduler, pauseThatNoDeadlineNeedsIsNotReportedAsCut)
{
  VirtualLine line(1, Ms(200));
  line.serve_within[0] = Ms(700);
  line.exchanges(20);
  EXPECT_FALSE(line.scheduler.pauseWasCut());
}

TEST(Scheduler, everyDriveIsServedInTimeUnderAFloodOfCommands)
{
  VirtualLine line(10);
  for (std::size_t index = 0; index < 10; ++index)
  {
    line.serve_within[index] = Ms(500);
    line.views[index].serve_by = at(500);
  }
  for (CommandId id = 1; line.now < at(60000); id += 3)
  {
    line.push(id, CommandKind::Velocity, { 0, 1, 2, 3, 4 }, 15);
    line.push(id + 1, CommandKind::ReadParameter, { 8 });
    line.exchange();
    for (const InverterView& view : line.views)
    {
      // A unit of 15 frames and the other nine drives may lie between.
      ASSERT_LE(line.now, *view.serve_by + Ms(250));
    }
  }
}

TEST(Scheduler, driveWithATimeOutThatCannotBeMetLeavesTheBusToTheOthers)
{
  VirtualLine line(2);
  line.serve_within[0] = Duration{ 0 };
  line.exchange();
  line.push(1, CommandKind::Velocity, { 1 });
  const Names names = line.exchanges(50);
  EXPECT_THAT(names, Contains("C1"));
  EXPECT_THAT(names, Contains("R1"));
}

TEST(Scheduler, deadlinesThatCannotBeMetLeaveTurnsToTheOthersWhileAStopInsists)
{
  VirtualLine line(4);
  line.serve_within = { { 1, Duration{ 0 } }, { 2, Duration{ 0 } } };
  line.views[1].serve_by = line.views[2].serve_by = at(0);
  line.views[3].background = true;
  line.dead.insert(0);
  line.stop(0);
  const Names names = line.exchanges(200);
  EXPECT_THAT(names, Contains("R3"));
  EXPECT_THAT(longestWithout('B', names), Le(16U)) << "stops, and one row of deadlines";
}

TEST(Scheduler, deadlinesThatCannotBeMetAndAFloodOfServicesLeaveTurnsToTheRefreshesOfTheOthers)
{
  VirtualLine line(4);
  line.reads_per_refresh = 3;
  line.serve_within = { { 1, Duration{ 0 } }, { 2, Duration{ 0 } } };
  line.views[1].serve_by = line.views[2].serve_by = at(0);
  for (CommandId id = 1; id <= 40; ++id)
  {
    line.push(id, CommandKind::ReadParameter, { id % 4 }, 100);
  }
  const Names names = line.exchanges(400);
  for (const std::string other : { "R0", "R3" })
  {
    EXPECT_THAT(std::count(names.begin(), names.end(), other), Ge(9)) << other;
  }
  EXPECT_THAT(only('C', names), SizeIs(Ge(25U))) << "they share the turns between rows of deadlines";
}

TEST(Scheduler, driveThatFallsSilentDoesNotStarveCommandsByItsDeadline)
{
  VirtualLine line(2);
  line.dead.insert(0);
  line.views[0].serve_by = at(0);
  line.push(1, CommandKind::Velocity, { 1 });
  EXPECT_THAT(line.exchanges(4), Contains("C1"));
}

TEST(Scheduler, refreshThatADeadlineBeganInThePauseIsFinishedAtOnce)
{
  VirtualLine line(1, std::chrono::minutes(5));
  line.reads_per_refresh = 2;
  line.serve_within[0] = Ms(700);
  line.exchanges(2);
  line.exchange();
  const TimePoint first_read = line.now;
  line.exchange();
  EXPECT_DOUBLE_EQ(toSeconds(line.now - first_read), 0.01) << "one status is put together from reads that lie apart";
}

TEST(Scheduler, lowestClassGetsEveryEighthExchangeWhileRefreshesGoOn)
{
  VirtualLine line(3);
  line.views[1].background = true;
  const Names names = line.exchanges(160);
  EXPECT_THAT(longestWithout('B', names), Le(7U));
  EXPECT_EQ(only('B', names).size(), 20U);
}

TEST(Scheduler, lowestClassGetsEveryEighthExchangeUnderAFloodOfCommands)
{
  VirtualLine line(3);
  line.views[1].background = true;
  Names names;
  for (CommandId id = 1; id <= 400; id += 2)
  {
    line.push(id, CommandKind::Velocity, { 0 });
    line.push(id + 1, CommandKind::Velocity, { 2 });
    names.push_back(line.exchange());
  }
  EXPECT_THAT(longestWithout('B', names), Le(7U));
}

TEST(Scheduler, lowestClassGetsItsTurnWhileDeadlinesAndALongJobNeverEnd)
{
  VirtualLine line(4);
  line.reads_per_refresh = 4;
  line.views[3].background = true;
  for (std::size_t index = 0; index < 3; ++index)
  {
    line.serve_within[index] = Ms(120);
    line.views[index].serve_by = at(0);
  }
  line.push(1, CommandKind::ReadFaults, { 3 }, 1000);
  // Each of the supervised may begin a refresh of its own before, and go on with it once.
  EXPECT_THAT(longestWithout('B', line.exchanges(300)), Le(7U + 2 * 3U));
}

TEST(Scheduler, lowestClassTakesTurnsBetweenInverters)
{
  VirtualLine line(3);
  line.views[0].background = true;
  line.views[2].background = true;
  EXPECT_THAT(only('B', line.exchanges(32)), ElementsAre("B0", "B2", "B0", "B2"));
}

TEST(Scheduler, lowestClassFillsThePauseOfTheInterval)
{
  VirtualLine line(1, std::chrono::minutes(5));
  line.views[0].background = true;
  ASSERT_EQ(line.exchange(), "R0");
  EXPECT_THAT(line.exchanges(5), Each("B0"));
  EXPECT_EQ(line.now, at(60));
}

TEST(Scheduler, offlineInverterHasNoExchangesOfTheLowestClass)
{
  VirtualLine line(2);
  line.kill(1);
  line.views[1].background = true;
  EXPECT_THAT(line.exchanges(50), Not(Contains("B1")));
}

// --- all of it -------------------------------------------------------------------------------------------------------

/// A busy hour on a bus of eight, from the numbers of \p seed.
Names storm(unsigned seed)
{
  std::mt19937 random(seed);
  VirtualLine line(8, Ms(20), 3);
  line.reads_per_refresh = 2;
  Names names;
  for (CommandId id = 1; id <= 5000; ++id)
  {
    const std::size_t inverter = random() % 8;
    InverterView& view = line.views[inverter];
    switch (random() % 12)
    {
      case 0:
        line.push(id, CommandKind::Velocity, { inverter }, 3);
        break;
      case 1:
        line.push(id, CommandKind::Velocity, { inverter / 2, 4 + inverter / 2 }, 6);
        break;
      case 2:
        line.push(id, static_cast<CommandKind>(1 + random() % 4), { inverter });
        break;
      case 3:
        line.stop(inverter);
        break;
      case 4:
        line.pushZero(id, inverter);
        break;
      case 5:
        view.offline = !view.offline;
        break;
      case 6:
        view.at_rest = !view.at_rest;
        break;
      case 7:
        view.background = !view.background;
        break;
      default:
        break;
    }
    names.push_back(line.exchange());
  }
  return names;
}

TEST(Scheduler, equalRunsAreEqualToTheLastExchange)
{
  for (const unsigned seed : { 1U, 2U, 3U })
  {
    EXPECT_EQ(storm(seed), storm(seed));
  }
  EXPECT_NE(storm(1), storm(2));
}

TEST(Scheduler, offersNothingAndAWakeUpWhenEverythingIsQuiet)
{
  VirtualLine line(1, Ms(100));
  line.exchange();
  const Pick pick = line.next();
  EXPECT_EQ(pick.what, Pick::What::Nothing);
  EXPECT_THAT(pick.wake, AllOf(Gt(line.now), Le(line.now + Ms(100))));
}

/// Everybody waits for it.
TEST(Scheduler, looksSoonWhetherAGatewayHasAnsweredLate)
{
  VirtualLine line(2);
  Gate gate;
  gate.stops_only = true;
  gate.until = line.now + Ms(3000);
  const Pick pick = line.scheduler.next(line.now, line.views, gate);
  EXPECT_EQ(pick.what, Pick::What::Nothing);
  EXPECT_THAT(pick.wake, AllOf(Gt(line.now), Le(line.now + Ms(20))));
}

TEST(Scheduler, wakesForAPostponedCommand)
{
  VirtualLine line(1, std::chrono::minutes(5));
  line.exchange();
  line.push(1, CommandKind::Velocity, { 0 });
  line.scheduler.postpone(1, line.now + Ms(30));
  EXPECT_EQ(line.next().wake, line.now + Ms(30));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

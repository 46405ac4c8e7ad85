// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// A drive that dies, or answers only part of what it is asked, while velocities keep coming (contract, 8.1 and 8.15).

#include <cmath>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
const char* const TWO_BELTS = R"(
port: /dev/virtual
baud_rate: 19200
scan_list:
  - {name: good, node: 1, drive: omron_mx2}
  - {name: bad, node: 2, drive: omron_mx2}
)";

constexpr std::size_t GOOD = 0;
constexpr std::size_t BAD = 1;

bool logged(const VirtualBus& bus, const std::string& text)
{
  const auto lines = bus.logTexts();
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

/// New velocities at a rate, for each inverter by its own topic or for both in a group.
struct Stream
{
  double rate_hz;
  bool grouped;
};

std::string nameOf(const testing::TestParamInfo<Stream>& info)
{
  return std::to_string(static_cast<int>(info.param.rate_hz)) + (info.param.grouped ? "HzGrouped" : "HzSingle");
}

class ChangingStream : public testing::TestWithParam<Stream>
{
protected:
  /// From now on for \p duration seconds: each message another velocity.
  void play(VirtualBus& bus, double duration)
  {
    const double period = 1.0 / GetParam().rate_hz;
    for (int message = 0; message * period < duration; ++message)
    {
      const double velocity = 20.0 + 0.1 * (message % 50);
      bus.at(message * period, [&bus, velocity, this] {
        last_velocity = velocity;
        if (GetParam().grouped)
        {
          bus.group({ { GOOD, velocity }, { BAD, velocity } });
          return;
        }
        bus.command(GOOD, velocity);
        bus.command(BAD, velocity);
      });
    }
  }

  /// Command time-outs beyond the stream's period, so that no command watchdog helps.
  static std::string belts()
  {
    return std::string(TWO_BELTS) + "defaults: {command_timeout: 3.0}\n";
  }

  /// Both run, and the stream goes on for 20 s.
  void begin(VirtualBus& bus)
  {
    bus.settleIn();
    ASSERT_TRUE(bus.runUntil(10.0, [&] { return bus.command(GOOD, 0.0) == 0 && bus.command(BAD, 0.0) == 0; }));
    play(bus, 20.0);
    ASSERT_TRUE(
        bus.runUntil(5.0, [&] { return bus.motor("good", "run_coil") == 1 && bus.motor("bad", "run_coil") == 1; }));
    bus.run(1.0);
  }

  double last_velocity = 0.0;
};

TEST_P(ChangingStream, aDeadDriveGoesOfflineAndTheOtherOneIsRefreshed)
{
  VirtualBus bus(belts());
  begin(bus);
  bus.world("bad offline");
  const TimePoint died = bus.now();
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.status(BAD).communication_error; }));
  EXPECT_TRUE(bus.status(BAD).locked);
  EXPECT_TRUE(bus.status(BAD).stop_active);
  EXPECT_LT(toSeconds(bus.now() - died), 3.0);
  EXPECT_LT(toSeconds(bus.now() - bus.status(GOOD).stamp), 1.5) << "the good one was not refreshed meanwhile";
  bus.run(5.0);
  EXPECT_LT(toSeconds(bus.now() - bus.status(GOOD).stamp), 0.3);
  EXPECT_EQ(bus.motor("good", "run_coil"), GetParam().grouped ? 0 : 1)
      << "a group with an offline member is refused, and silence stops the rest";
}

TEST_P(ChangingStream, theOtherOneIsNeverWithoutAnAnswerForLong)
{
  VirtualBus bus(belts());
  begin(bus);
  bus.world("bad offline");
  Duration longest{ 0 };
  bus.runUntil(5.0, [&] {
    longest = std::max(longest, bus.now() - bus.status(GOOD).stamp);
    return false;
  });
  // A refresh of the good one may lie between lost exchanges of the other one, 0.13 s each: its reads, its own commands,
  // and three tries of a stop.
  EXPECT_LT(toSeconds(longest), 2.0);
}

TEST_P(ChangingStream, aDriveThatAnswersReadsOnlyIsStoppedAndLocked)
{
  VirtualBus bus(belts());
  begin(bus);
  for (const char* function : { "5", "6", "15", "16" })
  {
    bus.world(std::string("bad lost_request count 0 function ") + function);
  }
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.status(BAD).locked; }));
  EXPECT_TRUE(bus.runUntil(3.0, [&] {
    return logged(bus, "bad: stopped and locked: reads are answered, writes are lost") ||
           logged(bus, "bad: stopping and locking: reads are answered, writes are lost");
  }));
  bus.run(3.0);
  EXPECT_FALSE(bus.status(BAD).communication_error) << "its reads are answered";
  EXPECT_EQ(bus.status(BAD).error_id, wire::ERROR_TIMEOUT);
  EXPECT_EQ(bus.status(BAD).error_text, "reads are answered, writes are lost");
  EXPECT_NE(bus.diagnostics(BAD).find("reads are answered, writes are lost"), std::string::npos);
  EXPECT_TRUE(bus.status(BAD).stop_active) << "no velocity cancels that stop";
  // The stop that insists takes every second exchange.
  EXPECT_LT(toSeconds(bus.now() - bus.status(GOOD).stamp), 2.5);
  bus.world("bad clear");
  EXPECT_TRUE(bus.runUntil(2.0, [&] { return !bus.status(BAD).stop_active; }));
  EXPECT_EQ(bus.motor("bad", "run_coil"), 0);
  bus.run(2.0);
  EXPECT_EQ(bus.motor("bad", "run_coil"), 0) << "the stream has not returned to neutral";
}

TEST_P(ChangingStream, aDriveWhoseRepliesToWritesAreLostIsStoppedAndLocked)
{
  VirtualBus bus(belts());
  begin(bus);
  for (const char* function : { "5", "6", "15", "16" })
  {
    bus.world(std::string("bad lost_reply count 0 function ") + function);
  }
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.status(BAD).locked; }));
  EXPECT_TRUE(bus.runUntil(3.0, [&] { return bus.motor("bad", "run_coil") == 0; })) << "the stop was heard";
  bus.run(3.0);
  EXPECT_EQ(bus.motor("bad", "run_coil"), 0);
  EXPECT_EQ(bus.status(BAD).error_id, wire::ERROR_TIMEOUT);
  // The stop that insists takes every second exchange.
  EXPECT_LT(toSeconds(bus.now() - bus.status(GOOD).stamp), 2.5);
}

TEST_P(ChangingStream, aDriveThatRefusesEveryFrequencyTakesNobodysTurn)
{
  VirtualBus bus(belts());
  begin(bus);
  bus.world("bad exception 2 count 0 function 16");
  bus.run(5.0);
  EXPECT_FALSE(bus.status(BAD).communication_error);
  EXPECT_TRUE(bus.runUntil(2.0, [&] { return bus.status(BAD).error_id == 0x9002; }));
  EXPECT_EQ(bus.motor("bad", "run_coil"), 1) << "it goes on as it was";
  EXPECT_LT(toSeconds(bus.now() - bus.status(GOOD).stamp), 0.3);
  EXPECT_NEAR(bus.motor("good", "reference"), last_velocity, 2.0);
}

// --- alive means data (rule 8.15) ------------------------------------------------------------------------------------

/// What a drive does from a moment on, and how the node calls it.
struct Ailment
{
  const char* name;
  std::vector<const char*> faults;
  const char* words;
};

std::string nameOfAilment(const testing::TestParamInfo<Ailment>& info)
{
  return info.param.name;
}

class HalfAlive : public testing::TestWithParam<Ailment>
{
protected:
  void fallIll(VirtualBus& bus)
  {
    for (const char* fault : GetParam().faults)
    {
      bus.world(std::string("bad ") + fault);
    }
  }

  /// Both run at a steady speed.
  void begin(VirtualBus& bus)
  {
    bus.settleIn();
    bus.stream(GOOD, 20.0, 0.1, 60.0, "/good");
    bus.stream(BAD, 20.0, 0.1, 60.0, "/bad");
    bus.run(3.0);
    ASSERT_EQ(bus.motor("bad", "run_coil"), 1);
  }
};

TEST_P(HalfAlive, isOfflineInEverySenseAndSaysWhy)
{
  VirtualBus bus(TWO_BELTS);
  begin(bus);
  fallIll(bus);
  const TimePoint ill = bus.now();
  ASSERT_TRUE(bus.runUntil(4.0, [&] { return bus.status(BAD).communication_error; }));
  EXPECT_LT(toSeconds(bus.now() - ill), 3.0);
  EXPECT_TRUE(bus.status(BAD).locked);
  EXPECT_FALSE(bus.status(BAD).monitor.output_frequency.has_value()) << "an old value is shown as fresh";
  EXPECT_TRUE(logged(bus, std::string("bad: offline: ") + GetParam().words)) << GetParam().words;
  bus.run(1.0);
  EXPECT_EQ(bus.command(BAD, 20.0, "/bad"), bus::ERROR_OFFLINE);
  bus.run(0.6);
  EXPECT_NE(bus.status(BAD).error_text.find(GetParam().words), std::string::npos) << bus.status(BAD).error_text;
  EXPECT_NE(bus.diagnostics(BAD).find(GetParam().words), std::string::npos) << bus.diagnostics(BAD);
  const bus::Answer answer = bus.wait(bus.readParameter(BAD, "F002"));
  EXPECT_EQ(answer.error_id, bus::ERROR_OFFLINE);
}

TEST_P(HalfAlive, staysOfflineAndIsPublished)
{
  VirtualBus bus(TWO_BELTS);
  begin(bus);
  const auto lines_before = bus.logTexts().size();
  fallIll(bus);
  ASSERT_TRUE(bus.runUntil(4.0, [&] { return bus.status(BAD).communication_error; }));
  const TimePoint end = bus.now() + seconds(30.0);
  while (bus.now() < end)
  {
    bus.run(0.1);
    ASSERT_TRUE(bus.status(BAD).communication_error);
  }
  const auto lines = bus.logTexts();
  EXPECT_TRUE(std::none_of(lines.begin() + static_cast<std::ptrdiff_t>(lines_before), lines.end(),
                           [](const auto& line) { return line.find("bad: online") != std::string::npos; }))
      << "online is said when a status was read";
  EXPECT_EQ(bus.motor("good", "run_coil"), 1) << "the good one has nothing to do with it";
  EXPECT_LT(toSeconds(bus.now() - bus.status(GOOD).stamp), 0.5);
}

TEST_P(HalfAlive, costsTheGoodOneNextToNothing)
{
  VirtualBus bus(TWO_BELTS);
  begin(bus);
  fallIll(bus);
  ASSERT_TRUE(bus.runUntil(4.0, [&] { return bus.status(BAD).communication_error; }));
  bus.run(5.0);
  bus.clearFrames();
  const TimePoint start = bus.now();
  bus.run(40.0);
  double spent = 0.0;
  const auto& frames = bus.frames();
  for (std::size_t index = 0; index + 1 < frames.size(); ++index)
  {
    const bool asks = frames[index].source == simulation::FrameRecord::Source::Master && frames[index].bytes[0] == 2;
    if (asks)
    {
      std::size_t next = index + 1;
      while (next + 1 < frames.size() && frames[next].source != simulation::FrameRecord::Source::Master)
      {
        ++next;
      }
      spent += toSeconds(frames[next].time - frames[index].time);
    }
  }
  EXPECT_GT(spent, 0.0);
  // 5 %, the gap before the next frame, and reads on the way that did bring data.
  EXPECT_LE(spent / toSeconds(bus.now() - start), 0.065);
}

TEST_P(HalfAlive, isBackWithinThreeSecondsAndRunsNothing)
{
  VirtualBus bus(TWO_BELTS);
  begin(bus);
  fallIll(bus);
  ASSERT_TRUE(bus.runUntil(4.0, [&] { return bus.status(BAD).communication_error; }));
  bus.run(7.0);
  bus.clearFrames();
  bus.world("bad clear");
  ASSERT_TRUE(bus.runUntil(3.0, [&] { return !bus.status(BAD).communication_error; }));
  EXPECT_TRUE(logged(bus, "bad: online"));
  bus.run(3.0);
  EXPECT_EQ(bus.motor("bad", "run_coil"), 0);
  EXPECT_EQ(bus.count("02 05 00 00 FF 00"), 0U) << "the stream has not returned to neutral";
  EXPECT_EQ(bus.status(BAD).error_id, bus::ERROR_LOCKED);
}

TEST_P(HalfAlive, isToldAtStartUpToo)
{
  VirtualBus bus(TWO_BELTS);
  fallIll(bus);
  ASSERT_TRUE(bus.runUntil(4.0, [&] { return bus.hasStatus(BAD); })) << "nothing is published of it";
  EXPECT_TRUE(bus.status(BAD).communication_error);
  EXPECT_FALSE(logged(bus, "bad: online"));
  bus.world("bad clear");
  EXPECT_TRUE(bus.runUntil(4.0, [&] { return !bus.status(BAD).communication_error; }));
}

TEST(ADriveThatRefuses, isOfflineThoughTheCommunicationWorks)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn(10.0);
  bus.world("bad exception 33 count 0");
  ASSERT_TRUE(bus.runUntil(4.0, [&] { return bus.status(BAD).communication_error; }));
  bus.run(2.0);
  EXPECT_TRUE(bus.status(BAD).refuses) << "for the moment: 21H";
  EXPECT_FALSE(bus.status(BAD).monitor.output_frequency) << "but nothing is shown of it";
  EXPECT_EQ(bus.command(BAD, 10.0), bus::ERROR_OFFLINE);
  bus.world("bad clear");
  bus.world("bad lost_request count 0");
  EXPECT_TRUE(bus.runUntil(5.0, [&] { return !bus.status(BAD).refuses; })) << "now it is silent";
  EXPECT_TRUE(bus.status(BAD).communication_error);
}

TEST(ADriveThatRefuses, forGoodIsNoSuchDrive)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn(10.0);
  bus.world("bad exception 2 count 0");
  ASSERT_TRUE(bus.runUntil(4.0, [&] { return bus.status(BAD).communication_error; }));
  bus.run(2.0);
  EXPECT_FALSE(bus.status(BAD).refuses);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, HalfAlive,
    testing::Values(
        Ailment{ "registersLost", { "lost_reply count 0 function 3" }, "no long replies: " },
        Ailment{ "registersDamaged", { "damaged count 0 function 3" }, "damaged replies to the status: " },
        Ailment{ "statusRefused", { "exception 2 count 0 function 1" }, "answers exception 02 to the status" },
        Ailment{ "busyForEver", { "exception 6 count 0 function 1" }, "answers exception 06 to the status" },
        Ailment{ "loopBacksOnly",
                 { "lost_reply count 0 function 1", "lost_reply count 0 function 3", "lost_request count 0 function 5",
                   "lost_request count 0 function 16" },
                 "no reply in time" },
        Ailment{ "everythingLate", { "late 0.3 count 0" }, "no reply in time" },
        Ailment{ "dead", { "lost_request count 0" }, "no reply in time" }),
    nameOfAilment);

INSTANTIATE_TEST_SUITE_P(Rates, ChangingStream,
                         testing::Values(Stream{ 1.0, false }, Stream{ 2.0, false }, Stream{ 5.0, false },
                                         Stream{ 10.0, false }, Stream{ 20.0, false }, Stream{ 50.0, false },
                                         Stream{ 100.0, false }, Stream{ 1.0, true }, Stream{ 10.0, true },
                                         Stream{ 20.0, true }, Stream{ 100.0, true }),
                         nameOf);
}  // namespace
}  // namespace inverter_bus

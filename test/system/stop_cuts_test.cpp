// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Contract, 8.4: a stop ends the wait for another exchange. Whole buses in virtual time.

#include "support/stop_latency_story.h"
#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
using Death = StopLatencyStory::Death;

std::string belts(unsigned count, const std::string& more = "")
{
  std::ostringstream yaml;
  yaml << "port: /dev/virtual\nbaud_rate: 19200\n" << more << "defaults: {drive: omron_mx2}\nscan_list:\n";
  for (unsigned node = 1; node <= count; ++node)
  {
    yaml << "  - {name: belt_" << node << ", node: " << node << "}\n";
  }
  return yaml.str();
}

/// Calls \p action \p delay after the first byte of the next frame of the master that begins with \p beginning.
void onFrame(VirtualBus& bus, const std::string& beginning, double delay, const std::function<void()>& action)
{
  const std::size_t seen = bus.frames().size();
  bus.at(0.0005, [&bus, beginning, delay, action, seen] {
    for (std::size_t index = seen; index < bus.frames().size(); ++index)
    {
      const simulation::FrameRecord& frame = bus.frames()[index];
      if (frame.source == simulation::FrameRecord::Source::Master &&
          VirtualBus::hex(frame.bytes).compare(0, beginning.size(), beginning) == 0)
      {
        bus.at(toSeconds(frame.time - bus.now()) + delay, action);
        return;
      }
    }
    onFrame(bus, beginning, delay, action);
  });
}

/// When the first frame of the master that begins with this text left.
std::optional<TimePoint> sentAt(const VirtualBus& bus, const std::string& beginning)
{
  for (const simulation::FrameRecord& frame : bus.frames())
  {
    if (frame.source == simulation::FrameRecord::Source::Master &&
        VirtualBus::hex(frame.bytes).compare(0, beginning.size(), beginning) == 0)
    {
      return frame.time;
    }
  }
  return std::nullopt;
}

/// From the first byte of the one to that of the other [ms].
double between(const VirtualBus& bus, const std::string& one, const std::string& other)
{
  const auto from = sentAt(bus, one);
  const auto to = sentAt(bus, other);
  EXPECT_TRUE(from && to) << one << ", " << other;
  return from && to ? toSeconds(*to - *from) * 1e3 : -1.0;
}

const char* const STOP_1 = "01 05 00 00 00 00";
const char* const STOP_2 = "02 05 00 00 00 00";
/// Of 8 characters at 19200 8N1, and of 3.5.
constexpr double REQUEST_MS = 80.0 / 19.2;
constexpr double GAP_MS = 35.0 / 19.2;
/// How often a wait looks for a stop.
constexpr double LOOK_MS = 1.0;
constexpr double ROUNDING_MS = 0.001;
/// This line hands over a reply in one piece at its end: one of 25 characters after the gap, 2 ms of the drive, and its own
/// time. A drive that was heard is given 2 ms more than that.
constexpr double COLLECTED_MS = GAP_MS + 2.0 + 250.0 / 19.2 + 2.0;
/// From the last byte of a request that an MX2 leaves unanswered: the gap, the 5 ms of its profile, response_timeout.
constexpr double FULL_MS = GAP_MS + 5.0 + 100.0;

TEST(StopCuts, theWaitForADriveThatIsSilent)
{
  VirtualBus bus(belts(2));
  bus.settleIn();
  bus.run(3.0);
  bus.world("belt_1 offline");
  bus.clearFrames();
  onFrame(bus, "01 ", 0.005, [&] { bus.stop(1); });
  bus.run(0.2);
  const double waited = between(bus, "01 ", STOP_2);
  EXPECT_GE(waited, REQUEST_MS + COLLECTED_MS - ROUNDING_MS);
  EXPECT_LE(waited, REQUEST_MS + COLLECTED_MS + LOOK_MS + 0.5);
}

TEST(StopCuts, aDriveThatWasNeverHeardIsGiven15Milliseconds)
{
  VirtualBus bus(belts(2));
  bus.world("belt_1 offline");
  onFrame(bus, "01 ", 0.005, [&] { bus.stop(1); });
  bus.run(0.2);
  const double waited = between(bus, "01 ", STOP_2);
  EXPECT_GE(waited, REQUEST_MS + 15.0 - ROUNDING_MS);
  EXPECT_LE(waited, REQUEST_MS + 15.0 + LOOK_MS + 0.1);
}

TEST(StopCuts, aStopThatComesLaterStillEndsIt)
{
  VirtualBus bus(belts(2));
  bus.world("belt_1 offline");
  onFrame(bus, "01 ", 0.06, [&] { bus.stop(1); });
  bus.run(0.2);
  EXPECT_NEAR(between(bus, "01 ", STOP_2), 60.0 + LOOK_MS / 2, LOOK_MS / 2 + 0.1);
}

TEST(StopCuts, aSlowDriveIsGivenThreeTimesItsLongest)
{
  VirtualBus bus(belts(2, "") + "simulation:\n  belt_1: {turnaround: 0.015}\n");
  bus.settleIn();
  bus.world("belt_1 offline");
  bus.clearFrames();
  onFrame(bus, "01 ", 0.005, [&] { bus.stop(1); });
  bus.run(0.2);
  const double shortest = REQUEST_MS + 3.0 * (15.0 + GAP_MS) - ROUNDING_MS;
  const double waited = between(bus, "01 ", STOP_2);
  EXPECT_GE(waited, shortest);
  EXPECT_LE(waited, shortest + LOOK_MS + 0.5);
}

TEST(StopCuts, noReplyThatHasBegun)
{
  VirtualBus bus(belts(2));
  bus.settleIn();
  bus.run(3.0);
  bus.clearFrames();
  const std::uint64_t timeouts = bus.line().counters().timeouts;
  // 8 + 5 ms + 3.5 characters later the first of 25 characters of the slow values comes.
  onFrame(bus, "01 03 10 0F", 0.013, [&] { bus.stop(1); });
  ASSERT_TRUE(bus.runUntil(3.0, [&] { return sentAt(bus, STOP_2).has_value(); }));
  bus.run(0.1);
  // It is waited for to its end, the gap, and then the stop goes.
  const auto stop = sentAt(bus, STOP_2);
  const simulation::FrameRecord* before = nullptr;
  for (const simulation::FrameRecord& frame : bus.frames())
  {
    before = frame.time < *stop ? &frame : before;
  }
  ASSERT_NE(before, nullptr);
  EXPECT_EQ(before->drive, "belt_1");
  EXPECT_EQ(before->bytes.size(), 25U);
  EXPECT_EQ(before->remark, "");
  EXPECT_EQ(bus.line().counters().timeouts, timeouts);
  EXPECT_NEAR(toSeconds(*stop - before->time) * 1e3, 25 * 10.0 / 19.2 + GAP_MS, 0.6);
}

TEST(StopCuts, aPauseInAReplyIsCutAfterThatOfAFifo)
{
  VirtualBus bus(belts(2));
  bus.settleIn();
  bus.run(3.0);
  bus.world("belt_1 truncated 4 for 10");
  bus.clearFrames();
  onFrame(bus, "01 ", 0.015, [&] { bus.stop(1); });
  ASSERT_TRUE(bus.runUntil(3.0, [&] { return sentAt(bus, STOP_2).has_value(); }));
  // 18 characters are longer than 5 ms here; 25 ms would be the patience.
  const simulation::FrameRecord* before = nullptr;
  for (const simulation::FrameRecord& frame : bus.frames())
  {
    before =
        frame.source == simulation::FrameRecord::Source::Drive && frame.time < *sentAt(bus, STOP_2) ? &frame : before;
  }
  ASSERT_NE(before, nullptr);
  const double end =
      toSeconds(before->time - *sentAt(bus, STOP_2)) * -1e3 - static_cast<double>(before->bytes.size()) * 10.0 / 19.2;
  EXPECT_GE(end, 180.0 / 19.2 - 0.1);
  EXPECT_LE(end, 180.0 / 19.2 + LOOK_MS + 0.6);
}

TEST(StopCuts, aVelocityOfZeroCutsToo)
{
  VirtualBus bus(belts(2));
  bus.settleIn();
  bus.command(1, 20.0);
  bus.run(0.4);
  ASSERT_EQ(bus.motor("belt_2", "run_coil"), 1);
  bus.world("belt_1 offline");
  bus.clearFrames();
  onFrame(bus, "01 ", 0.005, [&] { bus.command(1, 0.0); });
  bus.run(0.2);
  EXPECT_LE(between(bus, "01 ", STOP_2), REQUEST_MS + COLLECTED_MS + LOOK_MS + 0.5);
}

TEST(StopCuts, theCommandWatchdogCutsToo)
{
  VirtualBus bus(belts(2));
  bus.settleIn();
  bus.command(1, 20.0);
  bus.run(0.3);
  ASSERT_EQ(bus.motor("belt_2", "run_coil"), 1);
  bus.world("belt_1 offline");
  bus.clearFrames();
  // 0.5 s after the command, in whatever exchange: the dead one's takes 109 ms.
  bus.run(0.35);
  ASSERT_TRUE(sentAt(bus, STOP_2));
  TimePoint before;
  for (const simulation::FrameRecord& frame : bus.frames())
  {
    before = frame.time < *sentAt(bus, STOP_2) ? frame.time : before;
  }
  EXPECT_LE(toSeconds(*sentAt(bus, STOP_2) - before) * 1e3, REQUEST_MS + 100.0 - 20.0);
}

TEST(StopCuts, aCutExchangeCountsInNoOfflineCountAndIsNoTimeOut)
{
  VirtualBus bus(belts(2, "retries: 0\noffline_after: 1\n"));
  bus.settleIn();
  const std::uint64_t timeouts = bus.line().counters().timeouts;
  for (int time = 0; time < 20; ++time)
  {
    bus.world("belt_1 lost_reply count 1");
    onFrame(bus, "01 ", 0.005, [&] { bus.stop(1); });
    // Seldom enough to be no flood.
    bus.run(0.7);
    EXPECT_FALSE(bus.status(0).communication_error) << time;
  }
  EXPECT_EQ(bus.line().counters().timeouts, timeouts);
  EXPECT_EQ(bus.status(0).error_id, 0);
}

TEST(StopCuts, whatIsCutIsBarredUntilALoopBackHasGone)
{
  VirtualBus bus(belts(2));
  bus.settleIn();
  bus.run(3.0);
  bus.world("belt_1 late 0.2 count 1");
  bus.clearFrames();
  std::string cut;
  onFrame(bus, "01 ", 0.005, [&] {
    cut = bus.requests().back();
    bus.stop(1);
  });
  bus.run(1.0);
  const auto requests = bus.requests();
  const auto first = std::find(requests.begin(), requests.end(), cut);
  const auto again = std::find(first + 1, requests.end(), cut);
  const auto loopback =
      std::find_if(first, again, [](const std::string& text) { return text.compare(0, 5, "01 08") == 0; });
  EXPECT_NE(loopback, again) << cut;
  EXPECT_FALSE(bus.status(0).communication_error);
}

TEST(StopCuts, theNextFrameOfThatStopIsRepeatedAtOnceWithItsFullWait)
{
  VirtualBus bus(belts(3));
  bus.settleIn();
  bus.run(3.0);
  bus.world("belt_1 offline");
  bus.clearFrames();
  onFrame(bus, "01 ", 0.005, [&] {
    bus.world("belt_2 lost_request count 1");
    bus.stop(1);
  });
  bus.run(0.3);
  std::vector<TimePoint> stops;
  std::vector<std::string> heads;
  for (const simulation::FrameRecord& frame : bus.frames())
  {
    const std::string text = VirtualBus::hex(frame.bytes);
    if (frame.source == simulation::FrameRecord::Source::Master && (text == STOP_2 || !stops.empty()))
    {
      heads.push_back(text);
      stops.push_back(frame.time);
    }
  }
  ASSERT_GE(stops.size(), 2U);
  EXPECT_EQ(heads[1], STOP_2);
  EXPECT_NEAR(toSeconds(stops[1] - stops[0]) * 1e3, REQUEST_MS + FULL_MS, 1.0);
}

TEST(StopCuts, notTheWaitForARunOfTheSameDriveButThatOfAnother)
{
  for (const std::size_t stopped : { 0U, 1U })
  {
    VirtualBus bus(belts(2));
    bus.settleIn();
    bus.clearFrames();
    // The direction is confirmed before RUN is sent.
    onFrame(bus, "01 05 00 01", 0.012, [&] { bus.world("belt_1 lost_reply function 5 count 1"); });
    bus.command(0, 20.0);
    onFrame(bus, "01 05 00 00 FF 00", 0.005, [&] { bus.stop(stopped); });
    bus.run(0.5);
    const double waited = between(bus, "01 05 00 00 FF 00", stopped == 0 ? STOP_1 : STOP_2);
    if (stopped == 0)
    {
      EXPECT_GE(waited, REQUEST_MS + 100.0);
    }
    else
    {
      EXPECT_LE(waited, REQUEST_MS + COLLECTED_MS + LOOK_MS + 0.5);
    }
  }
}

TEST(StopCuts, aVelocityThatWasCutGoesAgainAndThatIsNoTry)
{
  VirtualBus bus(belts(2, "retries: 0\n"));
  bus.settleIn();
  bus.world("belt_1 lost_reply function 5 count 1");
  bus.command(0, 20.0);
  onFrame(bus, "01 05 00 01", 0.005, [&] { bus.stop(1); });
  bus.run(0.4);
  EXPECT_EQ(bus.motor("belt_1", "run_coil"), 1);
  EXPECT_EQ(bus.status(0).error_id, 0);
  EXPECT_FALSE(bus.status(0).locked);
}

TEST(StopCuts, notAWriteToTheEepromNorAReset)
{
  VirtualBus bus(R"(
port: /dev/virtual
scan_list:
  - {name: pump, node: 1, drive: toshiba_vfs15}
  - {name: belt, node: 2, drive: omron_mx2}
)");
  bus.settleIn();
  bus.run(3.0);
  bus.world("pump lost_reply function 6 count 1");
  bus.clearFrames();
  const auto write = bus.writeParameter(0, "ACC", 12.0, true);
  onFrame(bus, "01 06 00 09", 0.005, [&] { bus.stop(1); });
  bus.run(0.5);
  EXPECT_GE(between(bus, "01 06 00 09", STOP_2), REQUEST_MS + 100.0);

  bus.world("belt trip 3");
  bus.run(0.5);
  bus.world("belt lost_reply function 5 count 1");
  bus.clearFrames();
  const auto reset = bus.reset(1);
  onFrame(bus, "02 05 00 03 FF 00", 0.005, [&] { bus.stop(0); });
  bus.run(0.5);
  EXPECT_GE(between(bus, "02 05 00 03 FF 00", "01 06 FA 00"), REQUEST_MS + 100.0);
}

TEST(StopCuts, aParameterInRamIsWrittenAgain)
{
  VirtualBus bus(belts(2));
  bus.settleIn();
  bus.run(3.0);
  bus.world("belt_1 lost_reply count 1 writes");
  bus.clearFrames();
  const auto write = bus.writeParameter(0, "F002", 3.0, false);
  onFrame(bus, "01 10 11 02", 0.005, [&] { bus.stop(1); });
  const bus::Answer answer = bus.wait(write);
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_LE(between(bus, "01 10 11 02", STOP_2), 13 * 10.0 / 19.2 + COLLECTED_MS + LOOK_MS + 0.5);
}

TEST(StopCuts, anotherStopIsNotCut)
{
  VirtualBus bus(belts(3));
  bus.settleIn();
  bus.run(3.0);
  bus.world("belt_1 lost_request count 1");
  bus.clearFrames();
  bus.stop(0);
  onFrame(bus, STOP_1, 0.005, [&] { bus.stop(1); });
  bus.run(0.3);
  EXPECT_NEAR(between(bus, STOP_1, STOP_2), REQUEST_MS + FULL_MS, 1.0);
}

TEST(StopCuts, theStopOfAnInverterThatIsAwayGivesWayToThatOfALiveOne)
{
  VirtualBus bus(belts(2));
  bus.settleIn();
  bus.command(0, 20.0);
  bus.run(0.3);
  ASSERT_EQ(bus.motor("belt_1", "run_coil"), 1);
  bus.world("belt_1 offline");
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.status(0).communication_error; }));
  bus.run(3.0);
  for (int time = 0; time < 20; ++time)
  {
    bus.clearFrames();
    onFrame(bus, STOP_1, 0.005, [&] { bus.stop(1); });
    bus.run(3.0);
    EXPECT_LE(between(bus, STOP_1, STOP_2), REQUEST_MS + COLLECTED_MS + LOOK_MS + 0.5) << time;
  }
}

TEST(StopCuts, overRtuOverTcpToo)
{
  std::string yaml = belts(2);
  yaml.replace(yaml.find("/dev/virtual"), 12, "rtu+tcp://10.0.0.1:4001");
  VirtualBus bus(yaml);
  bus.telnet().negotiates = false;
  bus.world("belt_1 offline");
  onFrame(bus, "01 ", 0.005, [&] { bus.stop(1); });
  bus.run(0.2);
  EXPECT_LE(between(bus, "01 ", STOP_2), REQUEST_MS + 15.0 + LOOK_MS + 0.1);
}

TEST(StopCuts, betweenTwoTriesOfAStopThatInsistsASilentDriveIsWaitedForAsBriefly)
{
  // Seven dead ones make a probe short.
  VirtualBus bus(belts(10));
  bus.settleIn();
  for (int dead = 1; dead <= 7; ++dead)
  {
    bus.world("belt_" + std::to_string(dead) + " offline");
  }
  ASSERT_TRUE(bus.runUntil(30.0, [&] { return bus.status(6).communication_error; }));
  bus.world("belt_8 lost_reply for 100 writes");
  bus.world("belt_9 offline");
  bus.stop(7);
  bus.clearFrames();
  ASSERT_TRUE(bus.runUntil(10.0, [&] { return bus.status(8).communication_error; }));
  double longest = 0.0;
  bool first = true;
  for (std::size_t index = 0; index + 1 < bus.frames().size(); ++index)
  {
    const simulation::FrameRecord& frame = bus.frames()[index];
    if (VirtualBus::hex(frame.bytes).compare(0, 3, "09 ") == 0)
    {
      longest = first ? longest : std::max(longest, toSeconds(bus.frames()[index + 1].time - frame.time));
      first = false;
    }
  }
  EXPECT_FALSE(first);
  EXPECT_LT(longest, 0.06);
}

/// The worst of 1,000 stops at random instants [ms].
double worstOf(unsigned dead, Death death)
{
  StopLatencyStory::Plan plan;
  plan.dead = dead;
  plan.death = death;
  StopLatencyStory story(plan, INVERTER_BUS_ROOT "/config/drives");
  const std::vector<Duration> latencies = story.play();
  EXPECT_EQ(latencies.size(), plan.stops) << "a stop did not come at all";
  return latencies.empty() ? 0.0 : toSeconds(*std::max_element(latencies.begin(), latencies.end())) * 1e3;
}

TEST(StopLatency, atRandomInstantsOnABusyBus)
{
  EXPECT_LE(worstOf(0, Death::Silent), 40.0);
}

TEST(StopLatency, atRandomInstantsBesideThreeSilentDrives)
{
  EXPECT_LE(worstOf(3, Death::Silent), 40.0);
}

TEST(StopLatency, atRandomInstantsBesideFifteenSilentDrives)
{
  EXPECT_LE(worstOf(15, Death::Silent), 40.0);
}

TEST(StopLatency, atRandomInstantsBesideLateDrives)
{
  EXPECT_LE(worstOf(15, Death::Late), 46.0);
}

TEST(StopLatency, atRandomInstantsBesideDrivesWhoseRepliesBreakOff)
{
  EXPECT_LE(worstOf(15, Death::Broken), 46.0);
}
}  // namespace
}  // namespace inverter_bus

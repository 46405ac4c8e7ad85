// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Slow values have a share of the wire (contract, 8.3): on whole buses in virtual time, by the frames on the wire.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>

#include <gmock/gmock.h>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// From the end of a request to its reply; the simulated drive takes the gap by which it knows the end, and what is left.
constexpr double TURNAROUND = 0.005;
// 8 characters there and 8 back for the coils, 8 and 13 for the registers of an MX2.
constexpr double CHARACTERS_OF_A_REFRESH = 37.0;

double gapOf(unsigned baud_rate)
{
  return baud_rate > 19200 ? 0.00175 : 35.0 / baud_rate;
}

std::string belts(unsigned count, unsigned baud_rate, const std::string& bus = "", const std::string& entry = "")
{
  std::ostringstream yaml;
  yaml << "port: /dev/virtual\nbaud_rate: " << baud_rate << "\n"
       << bus << "defaults: {drive: omron_mx2" << entry << "}\nscan_list:\n";
  for (unsigned node = 1; node <= count; ++node)
  {
    yaml << "  - {name: belt_" << node << ", node: " << node << "}\n";
  }
  yaml << "simulation:\n";
  for (unsigned node = 1; node <= count; ++node)
  {
    yaml << "  belt_" << node << ": {turnaround: " << TURNAROUND - gapOf(baud_rate) << "}\n";
  }
  return yaml.str();
}

struct Figures
{
  double ratio = 0.0;         ///< median of a refresh's period to the plain loop with legal gaps
  double ratio_to_plain = 0;  ///< the same to the loop that leaves 0.24 ms between two frames
  double share = 0.0;         ///< of the wire in the 10 s in which slow values had most of it
};

bool isSlow(const std::string& request)
{
  const std::string read = request.substr(3, 8);
  return read == "03 00 4D" || read == "03 10 0F" || read == "03 10 18" || read == "03 10 25";
}

/// Runs a bus for \p duration and measures it by its frames.
Figures measure(VirtualBus& bus, unsigned count, unsigned baud_rate, double duration)
{
  bus.clearFrames();
  bus.run(duration);
  std::map<std::string, TimePoint> last;
  std::vector<double> periods;
  std::vector<std::pair<double, double>> slow;
  const auto& frames = bus.frames();
  const double character = 10.0 / baud_rate;
  for (std::size_t index = 0; index + 1 < frames.size(); ++index)
  {
    if (frames[index].source != simulation::FrameRecord::Source::Master)
    {
      continue;
    }
    const std::string text = VirtualBus::hex(frames[index].bytes);
    if (text.substr(2) == " 01 00 00 00 18")
    {
      const std::string station = text.substr(0, 2);
      if (last.count(station) != 0)
      {
        periods.push_back(toSeconds(frames[index].time - last[station]));
      }
      last[station] = frames[index].time;
    }
    if (isSlow(text))
    {
      const auto& answer = frames[index + 1];
      const double end =
          toSeconds(answer.time.time_since_epoch()) + static_cast<double>(answer.bytes.size()) * character;
      const double begin = toSeconds(frames[index].time.time_since_epoch()) - gapOf(baud_rate);
      slow.emplace_back(begin, end - begin);
    }
  }
  Figures figures;
  for (auto first = slow.begin(); first != slow.end(); ++first)
  {
    double sum = 0.0;
    for (auto one = first; one != slow.end() && one->first + one->second <= first->first + 10.0; ++one)
    {
      sum += one->second;
    }
    figures.share = std::max(figures.share, sum / 10.0);
  }
  std::nth_element(periods.begin(), periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2), periods.end());
  const double frames_alone = count * (CHARACTERS_OF_A_REFRESH * character + 2 * TURNAROUND);
  figures.ratio = periods[periods.size() / 2] / (frames_alone + count * 2 * gapOf(baud_rate));
  figures.ratio_to_plain = periods[periods.size() / 2] / (frames_alone + count * 2 * 0.00024);
  return figures;
}

struct Line
{
  unsigned count;
  unsigned baud_rate;
};

class OnLine : public testing::TestWithParam<Line>
{
};

TEST_P(OnLine, slowValuesKeepToTheirShareAndARefreshIsNearThePlainLoop)
{
  const Line line = GetParam();
  VirtualBus bus(belts(line.count, line.baud_rate));
  bus.settleIn(20.0);
  const Figures figures = measure(bus, line.count, line.baud_rate, 60.0);
  std::cout << line.count << " drives, " << line.baud_rate << " baud: refresh " << figures.ratio
            << " x the loop with legal gaps, " << figures.ratio_to_plain << " x the plain loop, slow values at most "
            << figures.share * 100.0 << " % in 10 s\n";
  EXPECT_LE(figures.ratio, 1.12);
  EXPECT_LE(figures.share, 0.075);
  for (unsigned index = 0; index < line.count; ++index)
  {
    const bus::InverterStatus& status = bus.status(index);
    EXPECT_TRUE(status.monitor.torque && status.monitor.temperature && status.monitor.dc_voltage &&
                status.monitor.output_voltage && status.monitor.warning_code)
        << index;
  }
}

INSTANTIATE_TEST_SUITE_P(SlowValues, OnLine,
                         testing::Values(Line{ 1, 19200 }, Line{ 5, 19200 }, Line{ 31, 19200 }, Line{ 8, 9600 },
                                         Line{ 8, 115200 }));

TEST(SlowValues, comeOnceInSlowIntervalWhereThatFits)
{
  VirtualBus bus(belts(1, 19200, "slow_interval: 2.5\n"));
  bus.settleIn();
  bus.run(5.0);
  bus.clearFrames();
  bus.run(50.0);
  for (const char* request : { "01 03 00 4D", "01 03 10 0F", "01 03 10 25" })
  {
    EXPECT_THAT(bus.count(request), testing::AllOf(testing::Ge(19U), testing::Le(20U))) << request;
  }
}

TEST(SlowValues, areNeverReadWhereSlowIntervalIsZero)
{
  VirtualBus bus(belts(2, 19200, "slow_interval: 0\n"));
  bus.settleIn();
  bus.run(20.0);
  for (const std::string& request : bus.requests())
  {
    EXPECT_FALSE(isSlow(request)) << request;
  }
  EXPECT_FALSE(bus.status(0).monitor.torque);
  EXPECT_FALSE(bus.status(0).slow_age);
  EXPECT_TRUE(bus.status(0).monitor.output_frequency);
}

TEST(SlowValues, tellTheirAge)
{
  VirtualBus bus(belts(1, 19200, "slow_interval: 4\n"));
  bus.settleIn();
  bus.run(12.0);
  double oldest = 0.0;
  double youngest = 100.0;
  for (int step = 0; step < 100; ++step)
  {
    bus.run(0.1);
    ASSERT_TRUE(bus.status(0).slow_age);
    oldest = std::max(oldest, toSeconds(*bus.status(0).slow_age));
    youngest = std::min(youngest, toSeconds(*bus.status(0).slow_age));
  }
  EXPECT_NEAR(oldest, 4.0, 0.2);
  EXPECT_LT(youngest, 4.0);
}

TEST(SlowValues, warningWordIsReadNextWhenADriveTrips)
{
  VirtualBus bus(belts(5, 19200, "slow_interval: 30\n"));
  bus.settleIn();
  bus.run(10.0);
  bus.world("belt_3 trip 7");
  bus.clearFrames();
  ASSERT_TRUE(bus.runUntil(2.0, [&] { return bus.count("03 03 00 4D") > 0; }));
  for (const std::string& request : bus.requests())
  {
    EXPECT_TRUE(!isSlow(request) || request.substr(0, 11) == "03 03 00 4D") << request;
  }
}

TEST(SlowValues, temperatureAndDcVoltageComeInOneReadWhereNothingElseIsWanted)
{
  VirtualBus bus(belts(1, 19200, "", ", skip: [torque, output_voltage]"));
  bus.run(8.0);
  EXPECT_GT(bus.count("01 03 10 18 00 0E"), 1U);
  EXPECT_EQ(bus.count("01 03 10 25 00 01"), 0U);
}

TEST(SlowValues, aHoleBetweenThemSplitsTheirReadForGood)
{
  std::string yaml = belts(1, 19200, "", ", skip: [torque, output_voltage]");
  yaml.insert(yaml.rfind("turnaround"), "reserved_readable: false, ");
  VirtualBus bus(yaml);
  bus.run(8.0);
  EXPECT_EQ(bus.count("01 03 10 18 00 0E"), 1U);
  bus.world("belt_1 offline");
  bus.run(3.0);
  bus.world("belt_1 online");
  bus.run(8.0);
  EXPECT_EQ(bus.count("01 03 10 18 00 0E"), 1U);
  EXPECT_GT(bus.count("01 03 10 25 00 01"), 1U);
}

std::vector<std::string> texts(const std::vector<bus::Finding>& findings)
{
  std::vector<std::string> texts;
  for (const bus::Finding& finding : findings)
  {
    texts.push_back(finding.text);
  }
  return texts;
}

TEST(SlowValues, budgetNamesSkipWhereTheyBecomeRare)
{
  VirtualBus few(belts(2, 19200));
  EXPECT_THAT(texts(few.coordinator().budget()), Not(Contains(HasSubstr("skip"))));
  EXPECT_THAT(texts(few.coordinator().budget()), Contains(HasSubstr("slow values every")));
  VirtualBus many(belts(31, 19200));
  EXPECT_THAT(texts(many.coordinator().budget()),
              Contains(testing::AllOf(HasSubstr("slow values"), HasSubstr("skip"))));
}
}  // namespace
}  // namespace inverter_bus

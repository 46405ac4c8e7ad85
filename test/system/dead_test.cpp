// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Dead inverters beside live ones, in virtual time (contract, 3.7): what they cost, and when one that answers again is back.

#include <cmath>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
// 3.7
constexpr double BACK_S = 3.0;
// With 15 of 31 dead at 19200 baud, as the budget prints it.
constexpr double BACK_OF_MANY_S = 8.0;
// How much longer than alone the cycle of the live ones may take: 1 / 0.95, and where the cycle happens to be cut.
constexpr double CYCLE_RATIO = 1.06;
constexpr double PATIENCE_S = 120.0;

std::string belt(std::size_t index)
{
  return "belt_" + std::to_string(index + 1);
}

/// MX2 that begin their replies after 5 ms, in which the silence of 3.5 characters is.
std::string belts(std::size_t count)
{
  std::ostringstream list;
  std::ostringstream drives;
  for (std::size_t index = 0; index < count; ++index)
  {
    list << "  - {name: " << belt(index) << ", node: " << index + 1 << "}\n";
    drives << "  " << belt(index) << ": {turnaround: 0.0032}\n";
  }
  return "port: /dev/virtual\nbaud_rate: 19200\ndefaults: {drive: omron_mx2, command_timeout: 0}\nscan_list:\n" +
         list.str() + "simulation:\n" + drives.str();
}

/// Some drives of a line, spread over it, have been dead for a while.
class DeadDrives
{
public:
  DeadDrives(std::size_t inverters, std::size_t dead) : bus(belts(inverters)), inverters_(inverters)
  {
    for (std::size_t number = 0; number < dead; ++number)
    {
      dead_.push_back((2 * number + 1) * inverters / (2 * dead));
    }
    const bool online = bus.runUntil(PATIENCE_S, [this] {
      for (std::size_t index = 0; index < inverters_; ++index)
      {
        if (!isOnline(index))
        {
          return false;
        }
      }
      return true;
    });
    EXPECT_TRUE(online);
    // All settings are read.
    bus.run(60.0);
    for (const std::size_t index : dead_)
    {
      bus.world(belt(index) + " offline");
    }
    waitForSilence();
    bus.run(30.0);
  }

  /// [s] until one that answers again is back, the longest over \p instants of its return.
  double longestReturn(int instants)
  {
    double longest = 0.0;
    for (int instant = 0; instant < instants; ++instant)
    {
      const std::size_t index = dead_[static_cast<std::size_t>(instant) % dead_.size()];
      // Every phase of the probes.
      bus.run(10.0 + std::fmod(0.6180339887 * instant, 1.0) * 10.0);
      longest = std::max(longest, timeBack(index));
      bus.world(belt(index) + " offline");
      waitForSilence();
    }
    return longest;
  }

  /// Reads of a status of the live ones within \p duration seconds.
  std::size_t refreshes(double duration)
  {
    bus.clearFrames();
    bus.run(duration);
    std::size_t count = 0;
    for (std::size_t index = 0; index < inverters_; ++index)
    {
      const bool dead = std::count(dead_.begin(), dead_.end(), index) > 0;
      count += dead ? 0 : bus.count(hexByte(index + 1) + " 03 10 00");
    }
    return count;
  }

  std::size_t first() const
  {
    return dead_.front();
  }

  double timeBack(std::size_t index)
  {
    const TimePoint begin = bus.now();
    bus.world(belt(index) + " online");
    EXPECT_TRUE(bus.runUntil(PATIENCE_S, [&] { return isOnline(index); })) << belt(index);
    return toSeconds(bus.now() - begin);
  }

  VirtualBus bus;

private:
  static std::string hexByte(std::size_t value)
  {
    char text[8];
    std::snprintf(text, sizeof text, "%02zX", value);
    return text;
  }

  bool isOnline(std::size_t index) const
  {
    return bus.hasStatus(index) && !bus.status(index).communication_error;
  }

  void waitForSilence()
  {
    const bool all = bus.runUntil(PATIENCE_S, [this] {
      return std::none_of(dead_.begin(), dead_.end(), [this](std::size_t index) { return isOnline(index); });
    });
    ASSERT_TRUE(all);
  }

  std::size_t inverters_;
  std::vector<std::size_t> dead_;
};

struct Line
{
  std::size_t inverters;
  std::size_t dead;
  double limit;
};

class ReturnOfADeadDrive : public testing::TestWithParam<Line>
{
};

TEST_P(ReturnOfADeadDrive, isNoticedInTimeAtAnyInstant)
{
  DeadDrives line(GetParam().inverters, GetParam().dead);
  const double longest = line.longestReturn(30);
  EXPECT_GT(longest, 0.0);
  EXPECT_LE(longest, GetParam().limit);
}

INSTANTIATE_TEST_SUITE_P(Lines, ReturnOfADeadDrive,
                         testing::Values(Line{ 5, 1, BACK_S }, Line{ 31, 1, BACK_S }, Line{ 31, 3, BACK_S },
                                         Line{ 31, 6, BACK_S }, Line{ 31, 15, BACK_OF_MANY_S }));

class CycleBesideDeadDrives : public testing::TestWithParam<std::size_t>
{
};

TEST_P(CycleBesideDeadDrives, isHardlyLongerThanAlone)
{
  const std::size_t dead = GetParam();
  DeadDrives line(31, dead);
  DeadDrives alone(31 - dead, 0);
  const std::size_t reads = line.refreshes(60.0);
  ASSERT_GT(reads, 500U);
  EXPECT_LE(static_cast<double>(alone.refreshes(60.0)), CYCLE_RATIO * static_cast<double>(reads));
}

INSTANTIATE_TEST_SUITE_P(Lines, CycleBesideDeadDrives, testing::Values(1, 3, 15));

TEST(ADeadDrive, thatHasBecomeSlowIsFoundByAProbeThatWaitsLonger)
{
  DeadDrives line(31, 6);
  line.bus.world(belt(line.first()) + " late 0.06 count 0");
  // 88 ms more than a short wait, of 0.5 % of the time, and six of them take turns.
  EXPECT_LE(line.timeBack(line.first()), 6 * 0.088 / 0.005 + BACK_S);
}
}  // namespace
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Nothing from the wire or from a message can fill the log: whole buses in virtual time, and the node's throttle behind.
#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "ros/log_throttle.h"
#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
const char* const ONE_BELT = R"(
port: /dev/virtual
baud_rate: 115200
response_timeout: 0.02
retries: 0
offline_after: 1
scan_list:
  - {name: belt, node: 1, drive: omron_mx2}
)";

/// Whatever happens, one text comes once in this time.
constexpr double PERIOD_S = 5.0;

/// A bus whose log lines go through the throttle at the moment they are made.
class Flood : public testing::Test
{
protected:
  /// Runs on until \p condition.
  void runUntil(const std::function<bool()>& condition)
  {
    ASSERT_TRUE(bus_.runUntil(60.0, [&] {
      logWhatIsNew();
      return condition();
    }));
  }

  void logWhatIsNew()
  {
    const std::vector<bus::Finding>& log = bus_.log();
    for (; made_ < log.size(); ++made_)
    {
      newest_[log[made_].subject] = log[made_].text;
      if (throttle_.admit(log[made_], bus_.now()))
      {
        note(log[made_]);
      }
    }
    for (const bus::Finding& finding : throttle_.takeDue(bus_.now()))
    {
      note(finding);
    }
  }

  void note(const bus::Finding& finding)
  {
    ++logged_;
    last_[finding.subject] = finding.text;
  }

  /// What the log says last of \p subject is what was last the case, some seconds later.
  void expectRightLastWord(const std::string& subject)
  {
    runUntil([&] { return last_[subject] == newest_[subject]; });
    bus_.run(PERIOD_S);
    logWhatIsNew();
    EXPECT_EQ(newest_[subject], last_[subject]);
  }

  /// Lines that \p texts different ones may have left in the log since the start.
  std::size_t bound(std::size_t texts) const
  {
    return texts * (1 + static_cast<std::size_t>(toSeconds(bus_.now() - start_) / PERIOD_S));
  }

  VirtualBus bus_{ ONE_BELT };
  const TimePoint start_ = bus_.now();
  ros_node::LogThrottle throttle_;
  std::size_t made_ = 0;
  std::size_t logged_ = 0;
  /// By subject.
  std::map<std::string, std::string> newest_;
  std::map<std::string, std::string> last_;
};

TEST_F(Flood, anInverterThatComesAndGoesAThousandTimes)
{
  bus_.settleIn();
  for (int i = 0; i < 1000; ++i)
  {
    bus_.world("belt offline");
    runUntil([this] { return bus_.status(0).communication_error; });
    bus_.world("belt online");
    runUntil([this] { return !bus_.status(0).communication_error; });
  }
  EXPECT_GE(made_, 2000U);
  // The port is open; four of the inverter's link.
  EXPECT_LE(logged_, bound(5));
  EXPECT_GE(logged_, 3U);
  expectRightLastWord("belt");
}

TEST_F(Flood, aDriveThatTripsAHundredTimes)
{
  bus_.settleIn();
  for (int i = 0; i < 100; ++i)
  {
    bus_.world("belt trip 5");
    runUntil([this] { return bus_.status(0).monitor.faulted.value_or(false); });
    ASSERT_TRUE(bus_.wait(bus_.reset(0)).success);
  }
  EXPECT_GE(made_, 100U);
  EXPECT_LE(logged_, bound(4));
  EXPECT_GE(logged_, 2U);
}

TEST_F(Flood, aPortThatIsPulledOutTwoHundredTimes)
{
  bus_.settleIn();
  for (int i = 0; i < 200; ++i)
  {
    bus_.world("bus unplug");
    runUntil([this] { return bus_.status(0).communication_error; });
    bus_.world("bus plug");
    runUntil([this] { return !bus_.status(0).communication_error; });
  }
  EXPECT_GE(made_, 600U);
  // Four of the port, four of the inverter's link.
  EXPECT_LE(logged_, bound(8));
  EXPECT_GE(logged_, 3U);
  expectRightLastWord("the port");
  expectRightLastWord("belt");
}

TEST_F(Flood, tenThousandWrongGroupsEachWrongInItsOwnWay)
{
  bus_.settleIn();
  logWhatIsNew();
  const std::size_t before = made_;
  for (int i = 0; i < 10000; ++i)
  {
    bus_.at(i * 0.001, [this, i] {
      bus_.coordinator().refuse(bus_.now(), { 0 }, bus::ERROR_OUT_OF_RANGE, "names '" + std::to_string(i) + "'", true);
    });
  }
  bus_.run(9.9995);
  logWhatIsNew();
  const std::vector<std::string> texts = bus_.logTexts();
  ASSERT_EQ(before + 2, texts.size());
  EXPECT_EQ("grouped command refused: names '0'", texts[before]);
  EXPECT_EQ(0U, texts[before + 1].find("grouped command refused: names '")) << texts[before + 1];
  EXPECT_NE(std::string::npos, texts[before + 1].find(" since the previous line)")) << texts[before + 1];
}

TEST_F(Flood, refusedVelocitiesLogOneLineInFiveSecondsAndRefusedCallsNone)
{
  bus_.settleIn();
  logWhatIsNew();
  const std::size_t before = made_;
  for (int i = 0; i < 10000; ++i)
  {
    EXPECT_EQ(bus::ERROR_OUT_OF_RANGE, bus_.command(0, 1e9 + i, "/user" + std::to_string(i)));
    bus_.group({ { 0, 1e9 + i } });
    bus_.writeParameter(0, "nonsense_" + std::to_string(i), 1.0, false);
    bus_.readParameter(0, "nonsense_" + std::to_string(i));
  }
  bus_.run(12.0);
  const std::vector<std::string> texts = bus_.logTexts();
  ASSERT_EQ(before + 2, texts.size());
  EXPECT_NE(std::string::npos, texts[before].find("velocity 1000000000 is out of range")) << texts[before];
  EXPECT_NE(std::string::npos, texts[before + 1].find("the last of 19999 since the previous line"))
      << texts[before + 1];
}
}  // namespace
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/log_throttle.h"

#include <chrono>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
using std::chrono::milliseconds;

bus::Finding line(const std::string& text, const std::string& subject = "")
{
  return { bus::Level::Ok, text, subject };
}

TEST(LogThrottleTest, theSameTextComesOnceInFiveSeconds)
{
  LogThrottle throttle;
  const TimePoint start;
  EXPECT_TRUE(throttle.admit(line("a"), start));
  EXPECT_FALSE(throttle.admit(line("a"), start + milliseconds(4999)));
  EXPECT_TRUE(throttle.admit(line("b"), start + milliseconds(4999)));
  EXPECT_TRUE(throttle.admit(line("a"), start + milliseconds(5000)));
}

TEST(LogThrottleTest, whatIsKeptBackIsCounted)
{
  LogThrottle throttle;
  const TimePoint start;
  throttle.admit(line("a"), start);
  throttle.admit(line("a"), start);
  throttle.admit(line("a"), start);
  EXPECT_EQ(2U, throttle.takeSuppressed());
  EXPECT_EQ(0U, throttle.takeSuppressed());
}

TEST(LogThrottleTest, textsThatAllDifferCannotFloodEither)
{
  LogThrottle throttle;
  int admitted = 0;
  for (int i = 0; i < 1000; ++i)
  {
    admitted += throttle.admit(line(std::to_string(i)), TimePoint() + milliseconds(i)) ? 1 : 0;
  }
  EXPECT_EQ(50, admitted);
}
/// Lines of one subject as they come, and what the log shows of them.
class LogStates : public testing::Test
{
protected:
  void say(const std::string& text, int at_ms)
  {
    takeDue(at_ms);
    if (throttle_.admit(line(text, "port"), at(at_ms)))
    {
      log_ += text + "@" + std::to_string(at_ms) + " ";
    }
  }

  /// Time goes on until then; what was held back is logged when its time has come.
  void takeDue(int until_ms)
  {
    while (const auto due = throttle_.nextDue())
    {
      const auto due_ms = std::chrono::duration_cast<milliseconds>(*due - TimePoint()).count();
      if (due_ms > until_ms)
      {
        return;
      }
      for (const bus::Finding& finding : throttle_.takeDue(*due))
      {
        log_ += finding.text + "@" + std::to_string(due_ms) + " ";
      }
    }
  }

  static TimePoint at(int milliseconds)
  {
    return TimePoint() + std::chrono::milliseconds(milliseconds);
  }

  LogThrottle throttle_;
  std::string log_;
};

TEST_F(LogStates, twoQuickLossesAreToldToTheEnd)
{
  say("gone", 10000);
  say("open", 12000);
  say("gone", 15500);
  say("open", 15800);
  EXPECT_EQ("gone@10000 open@12000 gone@15500 open@15800 ", log_);
}

TEST_F(LogStates, theLastOfManyIsToldWhenThereIsRoom)
{
  for (int i = 0; i < 10; ++i)
  {
    say("gone", 10000 + 200 * i);
    say("open", 10100 + 200 * i);
  }
  takeDue(60000);
  EXPECT_EQ("gone@10000 open@10100 gone@10200 open@10300 ", log_) << "it ends with open, as it is";
  say("gone", 60000);
  say("open", 60100);
  say("gone", 60200);
  say("open", 60300);
  say("gone", 60400);
  takeDue(90000);
  EXPECT_EQ("gone@10000 open@10100 gone@10200 open@10300 gone@60000 open@60100 gone@60200 open@60300 gone@65000 ",
            log_);
  EXPECT_EQ(16U, throttle_.takeSuppressed());
}

TEST_F(LogStates, aStateThatComesBackTakesTheHeldOneAway)
{
  say("gone", 0);
  say("open", 1);
  say("gone", 2);
  say("open", 3);
  say("gone", 4);
  say("open", 5);
  EXPECT_FALSE(throttle_.nextDue()) << "the log ends with open";
  takeDue(60000);
  EXPECT_EQ("gone@0 open@1 gone@2 open@3 ", log_);
}

TEST_F(LogStates, theSameStateIsToldAgainAfterFiveSeconds)
{
  say("gone", 0);
  say("gone", 4000);
  say("gone", 5000);
  EXPECT_EQ("gone@0 gone@5000 ", log_);
}

TEST_F(LogStates, aFullLogHoldsThemBackToo)
{
  for (int i = 0; i < 50; ++i)
  {
    ASSERT_TRUE(throttle_.admit(line(std::to_string(i)), at(i)));
  }
  say("gone", 100);
  EXPECT_EQ("", log_);
  takeDue(60000);
  EXPECT_EQ("gone@5000 ", log_);
}

TEST_F(LogStates, whatIsHeldAtTheEndIsStillTold)
{
  say("gone", 0);
  say("open", 1);
  say("gone", 2);
  say("open", 3);
  say("gone", 4);
  const std::vector<bus::Finding> held = throttle_.takeHeld();
  ASSERT_EQ(1U, held.size());
  EXPECT_EQ("gone", held.front().text);
  EXPECT_TRUE(throttle_.takeHeld().empty());
}

TEST_F(LogStates, subjectsDoNotReplaceEachOther)
{
  say("open", 0);
  EXPECT_TRUE(throttle_.admit(line("open", "another port"), at(1)));
  EXPECT_TRUE(throttle_.admit(line("a line of its own"), at(1)));
}

}  // namespace
}  // namespace ros_node
}  // namespace inverter_bus

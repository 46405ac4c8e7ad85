// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Velocities near zero, at their limits and beyond, on whole buses in virtual time (contract, 8.5).

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

const std::string RUN_OFF = "01 05 00 00 00 00";

/// Two wheels, up to 0.5 units of 100 Hz; \p more goes into the entry of both, \p right into that of the second one.
std::string wheels(const std::string& more = "", const std::string& right = "")
{
  return "port: /dev/virtual\nbaud_rate: 19200\ndefaults: {drive: omron_mx2, hz_per_unit: 100.0, max_velocity: 0.5" +
         more + "}\nscan_list:\n  - {name: left, node: 1}\n  - {name: right, node: 2" + right +
         "}\nsimulation:\n  left: {parameters: {F002: 1.0, F003: 1.0}}\n  right: {parameters: {F002: 1.0, F003: "
         "1.0}}\n";
}

/// Lines of the log that were written while \p bus went on.
std::vector<std::string> warnings(VirtualBus& bus, const std::string& about)
{
  std::vector<std::string> lines;
  for (const std::string& line : bus.logTexts())
  {
    if (line.find(about) != std::string::npos)
    {
      lines.push_back(line);
    }
  }
  return lines;
}

class Velocities : public testing::Test
{
protected:
  void start(const std::string& yaml)
  {
    bus_ = std::make_unique<VirtualBus>(yaml);
    bus_->settleIn();
  }

  void runBoth(double velocity)
  {
    bus_->at(0.0, [this, velocity] { bus_->group({ { 0, velocity }, { 1, velocity } }); });
    ASSERT_TRUE(bus_->runUntil(0.4, [this] { return runs("left") && runs("right"); }));
  }

  bool runs(const std::string& name)
  {
    return bus_->motor(name, "run_coil") == 1.0;
  }

  std::unique_ptr<VirtualBus> bus_;
};

TEST_F(Velocities, nearZeroStopsAndTheNextVelocityStartsAgain)
{
  start(wheels());
  bus_->stream(0, 0.3, 0.05, 1.0);
  bus_->run(1.0);
  ASSERT_TRUE(runs("left"));
  bus_->clearFrames();
  bus_->stream(0, 5e-14, 0.05, 3.0);
  EXPECT_TRUE(bus_->runUntil(0.2, [this] { return !runs("left"); }));
  bus_->run(3.0);
  EXPECT_EQ(bus_->count(RUN_OFF), 1U) << "a stream near zero sends its stop once";
  EXPECT_EQ(bus_->status(0).error_id, 0);
  EXPECT_FALSE(bus_->status(0).locked);
  EXPECT_EQ(bus_->status(0).commanded_velocity, 0.0);
  EXPECT_EQ(bus_->command(0, 0.3), 0);
  EXPECT_TRUE(bus_->runUntil(0.3, [this] { return runs("left"); }));
}

TEST_F(Velocities, nearZeroStopsInARefusedGroup)
{
  start(wheels(", min_velocity: 0.1"));
  runBoth(0.3);
  EXPECT_EQ(bus_->group({ { 0, 0.05 }, { 1, 9.0 } }), bus::ERROR_OUT_OF_RANGE);
  EXPECT_TRUE(bus_->runUntil(0.2, [this] { return !runs("left"); }));
  EXPECT_TRUE(runs("right"));
}

TEST_F(Velocities, nearZeroIsTakenWhileLockedOfflineAndDuringAStop)
{
  start(wheels());
  runBoth(0.3);
  const VirtualBus::Box stopped = bus_->stop(0);
  EXPECT_EQ(bus_->command(0, 1e-9), 0);
  EXPECT_TRUE(bus_->wait(stopped).success);
  EXPECT_EQ(bus_->command(0, 0.3), bus::ERROR_LOCKED);
  EXPECT_EQ(bus_->command(0, 1e-9), 0);
  EXPECT_EQ(bus_->command(0, 0.3), bus::ERROR_LOCKED) << "near zero is no return to neutral";
  bus_->world("left offline");
  ASSERT_TRUE(bus_->runUntil(3.0, [this] { return bus_->status(0).communication_error; }));
  EXPECT_EQ(bus_->command(0, 1e-9), 0);
}

TEST_F(Velocities, anOldMessageNearZeroStopsAndNoOtherOldMessageDoesAnything)
{
  start(wheels());
  runBoth(0.3);
  bus::VelocityCommand old;
  old.targets = { { 0, 1e-9 }, { 1, 0.2 } };
  old.grouped = true;
  old.publisher.name = "/user";
  old.publisher.topic = "group";
  old.publisher.latched = old.publisher.first_on_connection = true;
  EXPECT_EQ(bus_->coordinator().command(bus_->now(), old), 0);
  EXPECT_TRUE(bus_->runUntil(0.2, [this] { return !runs("left"); }));
  bus_->run(0.1);
  EXPECT_TRUE(runs("right"));
  EXPECT_EQ(bus_->status(1).commanded_velocity, 0.3);
}

TEST_F(Velocities, aFloatsTopSpeedIsTheTopSpeed)
{
  start(wheels());
  EXPECT_EQ(bus_->command(0, 0.5 * (1.0 + 5e-7)), 0);
  ASSERT_TRUE(bus_->runUntil(0.3, [this] { return runs("left"); }));
  bus_->run(0.1);
  EXPECT_EQ(bus_->status(0).commanded_velocity, 0.5);
}

TEST_F(Velocities, saturateClampsShowsItAndSendsNothingForTheSameAgain)
{
  start(wheels(", limit: saturate"));
  EXPECT_EQ(bus_->command(0, -7.0), 0);
  ASSERT_TRUE(bus_->runUntil(0.3, [this] { return runs("left"); }));
  ASSERT_TRUE(bus_->runUntil(2.0, [this] {
    bus_->command(0, -7.0);
    return bus_->motor("left", "frequency") >= 49.99;
  }));
  EXPECT_EQ(bus_->status(0).commanded_velocity, -0.5);
  bus_->clearFrames();
  // Each of these is the same command, and feeds the command watchdog.
  for (int i = 0; i < 10; ++i)
  {
    bus_->at(0.1 * i, [this, i] { EXPECT_EQ(bus_->command(0, -7.0 - i), 0); });
  }
  bus_->run(1.0);
  EXPECT_TRUE(runs("left"));
  EXPECT_EQ(bus_->count("01 10") + bus_->count("01 05"), 0U);
  for (const double velocity : { std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity() })
  {
    EXPECT_EQ(bus_->command(0, velocity), bus::ERROR_OUT_OF_RANGE);
  }
}

TEST_F(Velocities, oneFactorForTheWholeGroup)
{
  start(wheels(", limit: saturate", ", max_velocity: 0.4"));
  EXPECT_EQ(bus_->group({ { 0, 0.4 }, { 1, -0.8 } }), 0);
  ASSERT_TRUE(bus_->runUntil(0.4, [this] { return runs("left") && runs("right"); }));
  bus_->run(0.1);
  EXPECT_DOUBLE_EQ(bus_->status(0).commanded_velocity, 0.2);
  EXPECT_EQ(bus_->status(1).commanded_velocity, -0.4);
}

TEST_F(Velocities, aMemberThatRefusesIsJudgedBeforeTheFactorAndReducedByIt)
{
  start(wheels(", limit: saturate", ", limit: refuse"));
  EXPECT_EQ(bus_->group({ { 0, 1.0 }, { 1, 0.4 } }), 0);
  ASSERT_TRUE(bus_->runUntil(0.4, [this] { return runs("left") && runs("right"); }));
  EXPECT_EQ(bus_->group({ { 0, 1.0 }, { 1, 0.6 } }), bus::ERROR_OUT_OF_RANGE);
  bus_->run(0.1);
  EXPECT_EQ(bus_->status(0).commanded_velocity, 0.5);
  EXPECT_DOUBLE_EQ(bus_->status(1).commanded_velocity, 0.2);
}

TEST_F(Velocities, aFactorThatBringsAMemberNearZeroRefusesTheGroup)
{
  start(wheels(", limit: saturate, min_velocity: 0.1"));
  runBoth(0.3);
  EXPECT_EQ(bus_->group({ { 0, 5.0 }, { 1, 0.2 } }), bus::ERROR_OUT_OF_RANGE);
  bus_->run(0.2);
  EXPECT_TRUE(runs("left") && runs("right"));
  // One that is near zero by itself stops, and the others go as told.
  EXPECT_EQ(bus_->group({ { 0, 5.0 }, { 1, 0.01 } }), 0);
  EXPECT_TRUE(bus_->runUntil(0.3, [this] { return !runs("right"); }));
  bus_->run(0.1);
  EXPECT_EQ(bus_->status(0).commanded_velocity, 0.5);
}

TEST_F(Velocities, aRefusedStreamIsToldOnceAndTheWatchdogSaysWhy)
{
  start(wheels(", command_timeout: 0.25"));
  runBoth(0.3);
  bus_->stream(0, 0.7, 0.05, 2.0);
  ASSERT_TRUE(bus_->runUntil(1.0, [this] { return !runs("left"); }));
  const std::vector<std::string> stopping = warnings(*bus_, "left: stopping");
  ASSERT_EQ(stopping.size(), 1U);
  EXPECT_THAT(stopping[0],
              AllOf(HasSubstr("commands came in 0.25 s (command_timeout) and all were refused"),
                    HasSubstr("velocity 0.7 is out of range: 0, or up to 0.5"), Not(HasSubstr("no command"))));
  bus_->run(1.2);
  const std::vector<std::string> refused = warnings(*bus_, "refused: left: velocity 0.7");
  ASSERT_FALSE(refused.empty());
  EXPECT_EQ(refused[0], "refused: left: velocity 0.7 is out of range: 0, or up to 0.5 in either direction (0xA000)");
  EXPECT_EQ(refused.size(), 1U);
  EXPECT_THAT(warnings(*bus_, "right: stopping"), Each(HasSubstr("no command for 0.25 s (command_timeout)")));
}

TEST_F(Velocities, aRefusedGroupNamesWhoIsTheReasonInLogAndStatus)
{
  start(wheels());
  runBoth(0.3);
  EXPECT_EQ(bus_->group({ { 0, 0.2 }, { 1, 0.51 } }), bus::ERROR_OUT_OF_RANGE);
  bus_->run(0.1);
  EXPECT_THAT(bus_->logTexts(), Contains(AllOf(HasSubstr("group refused: right: velocity 0.51"), HasSubstr("0xA000"))));
  EXPECT_THAT(bus_->status(0).error_text, HasSubstr("the group was refused: right: velocity 0.51"));
  bus_->stop(std::nullopt);
  bus_->run(0.2);
  EXPECT_EQ(bus_->group({ { 0, 0.2 }, { 1, 0.2 } }), bus::ERROR_LOCKED);
  bus_->run(0.1);
  EXPECT_THAT(bus_->logTexts(), Contains(AllOf(HasSubstr("group refused: left: velocity 0.2: locked"),
                                               HasSubstr("right: velocity 0.2: locked"), HasSubstr("0xB005"))));
}
}  // namespace
}  // namespace inverter_bus

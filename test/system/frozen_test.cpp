// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The driver itself does not run for a while (SIGSTOP, a debugger, the pause of a virtual machine), on a whole bus in virtual
// time: no drive is to blame for that, but motors have run on, and what watches over them counts that time.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// Lost exchanges alone make nobody offline here.
std::string belt(double command_timeout)
{
  return "port: /dev/virtual\n"
         "retries: 0\n"
         "offline_after: 20\n"
         "scan_list:\n"
         "  - {name: belt, node: 1, drive: omron_mx2, command_timeout: " +
         std::to_string(command_timeout) + "}\n";
}

class FrozenDriver : public ::testing::Test
{
protected:
  void start(const std::string& yaml)
  {
    bus_ = std::make_unique<VirtualBus>(yaml);
    bus_->settleIn();
    bus_->command(0, 20.0);
    ASSERT_TRUE(bus_->runUntil(0.4, [&] { return bus_->status(0).monitor.running.value_or(false); }));
  }

  /// The drive has lost some exchanges, and answers again.
  void loseSome()
  {
    const std::size_t before = bus_->frames().size();
    bus_->world("belt offline");
    ASSERT_TRUE(bus_->runUntil(1.0, [&] { return bus_->frames().size() >= before + 4; }));
    ASSERT_FALSE(bus_->status(0).communication_error);
    bus_->world("belt online");
  }

  /// Runs for \p duration, and fails if the belt is ever shown as offline.
  void expectOnlineFor(double duration)
  {
    EXPECT_FALSE(bus_->runUntil(duration, [&] { return bus_->status(0).communication_error; }));
    EXPECT_LT(toSeconds(bus_->now() - bus_->status(0).stamp), 0.5) << "and it is read again";
  }

  /// For \p duration, in the middle of the exchange that follows.
  void freezeInTheNextExchange(double duration)
  {
    const auto done = std::make_shared<bool>(false);
    const std::size_t before = bus_->frames().size();
    for (double time = 0.0; time < 5.0; time += 0.001)
    {
      bus_->at(time, [this, duration, done, before] {
        if (!*done && bus_->frames().size() > before)
        {
          *done = true;
          bus_->pass(duration);
        }
      });
    }
    ASSERT_TRUE(bus_->runUntil(5.0, [&] { return *done; }));
  }

  std::unique_ptr<VirtualBus> bus_;
};

TEST_F(FrozenDriver, takesNoDriveForBlindThatHasLostAnExchange)
{
  for (const double duration : { 2.5, 4.0, 60.0 })
  {
    start(belt(0.0));
    loseSome();
    bus_->pass(duration);
    expectOnlineFor(3.0);
    EXPECT_EQ(bus_->motor("belt", "run_coil"), 1.0) << "nobody watches over its commands here";
    EXPECT_FALSE(bus_->status(0).locked);
    EXPECT_THAT(bus_->logTexts(), Contains(HasSubstr("this node did not run for")));
  }
}

TEST_F(FrozenDriver, takesNoDriveForBlindInTheMiddleOfAnExchange)
{
  for (const double duration : { 2.5, 60.0 })
  {
    start(belt(0.0));
    loseSome();
    freezeInTheNextExchange(duration);
    expectOnlineFor(3.0);
    EXPECT_EQ(bus_->motor("belt", "run_coil"), 1.0);
    EXPECT_THAT(bus_->logTexts(), Not(Contains(HasSubstr("no drive answers any more")))) << "nor the link for mute";
  }
}

TEST_F(FrozenDriver, theCommandWatchdogHasCountedThatTime)
{
  start(belt(1.0));
  loseSome();
  bus_->pass(3.0);
  EXPECT_FALSE(bus_->runUntil(2.0, [&] { return bus_->status(0).communication_error; }));
  EXPECT_EQ(bus_->motor("belt", "run_coil"), 0.0);
  EXPECT_THAT(bus_->logTexts(), Contains(HasSubstr("belt: stopping: no command for")));
}

TEST_F(FrozenDriver, aDriveThatIsAwayIsFoundOutAllTheSame)
{
  start(belt(0.0));
  bus_->world("belt offline");
  bus_->run(0.5);
  bus_->pass(60.0);
  EXPECT_TRUE(bus_->runUntil(3.0, [&] { return bus_->status(0).communication_error; }));
  EXPECT_TRUE(bus_->status(0).locked);
}

TEST_F(FrozenDriver, aProbeThatLastedSoLongKeepsNobodyAway)
{
  start("port: /dev/virtual\nscan_list:\n  - {name: belt, node: 1, drive: omron_mx2}\n");
  bus_->world("belt offline");
  ASSERT_TRUE(bus_->runUntil(5.0, [&] { return bus_->status(0).communication_error; }));
  freezeInTheNextExchange(60.0);
  bus_->world("belt online");
  EXPECT_TRUE(bus_->runUntil(4.0, [&] { return !bus_->status(0).communication_error; }));
}

TEST_F(FrozenDriver, aBusyMachineIsNotToldOfAsAFreeze)
{
  start(belt(0.0));
  for (int time = 0; time < 20; ++time)
  {
    bus_->pass(0.4);
    bus_->run(0.2);
  }
  EXPECT_THAT(bus_->logTexts(), Not(Contains(HasSubstr("did not run"))));
}
}  // namespace
}  // namespace inverter_bus

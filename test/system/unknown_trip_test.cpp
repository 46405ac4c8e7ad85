// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// A state of the drive that its profile does not know counts as a trip (contract, 8.6), on whole buses in virtual time.

#include <algorithm>
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
using testing::Contains;
using testing::HasSubstr;
using testing::Optional;

const std::string RX_RESET = "01 05 00 03 FF 00";

/// An RX (status B: 0 stop, 1 run, 2 trip), with \p overrides of its profile.
std::string rx(const std::string& overrides = "")
{
  return "port: /dev/virtual\nbaud_rate: 19200\nscan_list:\n  - {name: mixer, node: 1, drive: omron_rx, "
         "command_timeout: "
         "1.0" +
         overrides + "}\nsimulation:\n  mixer: {parameters: {F002: 1.0, F003: 1.0}, reset_silence: 0.3}\n";
}

class UnknownTrip : public testing::Test
{
protected:
  void run(const std::string& yaml)
  {
    bus_ = std::make_unique<VirtualBus>(yaml);
    bus_->settleIn();
    bus_->stream(0, 20.0, 0.05, 60.0);
    ASSERT_TRUE(bus_->runUntil(1.0, [this] { return bus_->status(0).monitor.running.value_or(false); }));
    bus_->clearFrames();
  }

  bool runs()
  {
    return bus_->motor("mixer", "run_coil") == 1.0;
  }

  std::unique_ptr<VirtualBus> bus_;
};

TEST_F(UnknownTrip, stopsAndLocksAtOnceAndIsShownWithItsValueAndReason)
{
  run(rx());
  bus_->world("mixer trip 7 state 9");
  EXPECT_TRUE(bus_->runUntil(0.3, [this] { return !runs(); }));
  ASSERT_TRUE(bus_->runUntil(0.5, [this] { return bus_->status(0).monitor.unknown_trip.has_value(); }));
  const bus::InverterStatus status = bus_->status(0);
  EXPECT_FALSE(status.monitor.faulted.has_value());
  EXPECT_THAT(status.monitor.unknown_trip, Optional(testing::Eq(9U)));
  EXPECT_EQ(status.monitor.fault_code, 7);
  EXPECT_TRUE(status.locked);
  EXPECT_EQ(bus_->command(0, 20.0), bus::ERROR_LOCKED);
  EXPECT_EQ(bus_->command(0, 0.0), 0);
  EXPECT_EQ(bus_->command(0, 20.0), bus::ERROR_LOCKED) << "no 0 unlocks a trip";
  EXPECT_THAT(bus_->logTexts(),
              Contains(AllOf(HasSubstr("mixer: tripped"), HasSubstr("unknown state 9"), HasSubstr("trip 7"))));
  EXPECT_THAT(bus_->diagnostics(0), AllOf(HasSubstr("unknown state 9"), HasSubstr("call reset")));
  bus_->run(3.0);
  EXPECT_FALSE(runs());
}

TEST_F(UnknownTrip, resetIsSentWithRunOffAndSaysThatTheStateWasUnknown)
{
  run(rx());
  bus_->world("mixer trip 7 state 9");
  ASSERT_TRUE(bus_->runUntil(0.5, [this] { return bus_->status(0).monitor.unknown_trip.has_value(); }));
  const bus::Answer answer = bus_->wait(bus_->reset(0));
  EXPECT_EQ(bus_->count(RX_RESET), 1U);
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_THAT(answer.message, HasSubstr("unknown state 9"));
  EXPECT_FALSE(runs());
  EXPECT_EQ(bus_->motor("mixer", "tripped"), 0.0);
  // The stream went on all the time, and starts nothing.
  bus_->run(5.0);
  EXPECT_FALSE(runs());
  EXPECT_THAT(bus_->status(0).monitor.faulted, Optional(false));
}

TEST_F(UnknownTrip, aStateThatNoResetEndsIsToldAsUnknownAfterTheBound)
{
  run(rx());
  bus_->world("mixer sto on");
  bus_->run(0.2);
  bus_->world("mixer trip 7 state 9");
  ASSERT_TRUE(bus_->runUntil(0.5, [this] { return bus_->status(0).monitor.unknown_trip.has_value(); }));
  const bus::Answer answer = bus_->wait(bus_->reset(0));
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.error_id, 0);
  EXPECT_THAT(answer.message, HasSubstr("unknown state 9"));
}

TEST_F(UnknownTrip, onlyWhatIsKnownToBeHealthyNeedsNoReset)
{
  run(rx());
  bus_->stop(0);
  bus_->run(0.5);
  EXPECT_EQ(bus_->wait(bus_->reset(0)).message, "no trip: nothing was sent");
  EXPECT_EQ(bus_->count(RX_RESET), 0U);
}

TEST_F(UnknownTrip, aDriveThatRefusesToTellIsResetWithTheMotorStopped)
{
  // No such register: the drive answers exception 02 to it, and everything else goes on.
  run(rx(", overrides: {status: {faulted: {register: 0x0EEE}}}"));
  bus_->run(1.0);
  ASSERT_FALSE(bus_->status(0).monitor.tripped().has_value());
  ASSERT_TRUE(runs()) << "not told is no trip";
  const bus::Answer answer = bus_->wait(bus_->reset(0));
  EXPECT_EQ(bus_->count(RX_RESET), 1U);
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_THAT(answer.message, HasSubstr("unknown"));
  EXPECT_FALSE(runs());
}

TEST_F(UnknownTrip, oneLostExchangeChangesNothing)
{
  run(rx());
  bus_->world("mixer lost_reply");
  bus_->run(1.0);
  EXPECT_TRUE(runs());
  EXPECT_FALSE(bus_->status(0).monitor.unknown_trip.has_value());
}

TEST_F(UnknownTrip, anErrorWordThatIsNotZeroIsAnOrdinaryTrip)
{
  // d081 of the RX keeps the last trip; 0 while there has been none.
  run(rx(", overrides: {status: {faulted: {register: 0x0012, nonzero: true}}}"));
  bus_->world("mixer trip 99");
  EXPECT_TRUE(bus_->runUntil(0.3, [this] { return !runs(); }));
  ASSERT_TRUE(bus_->runUntil(0.5, [this] { return bus_->status(0).monitor.faulted.value_or(false); }));
  EXPECT_FALSE(bus_->status(0).monitor.unknown_trip.has_value());
}

TEST(UnknownTripOfAToshiba, aCodeThatNoTableListsStopsIt)
{
  // FC90 is 0 without a trip; of its codes this profile knows two.
  VirtualBus bus(
      "port: /dev/virtual\nbaud_rate: 19200\nparity: even\nscan_list:\n  - {name: pump, node: 1, drive: "
      "toshiba_vfs15, command_timeout: 1.0, overrides: {status: {faulted: {register: 0xFC90, values: {'0': 0, "
      "'1': 1, '2': 1}}}}}\n");
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 10.0);
  ASSERT_TRUE(bus.runUntil(1.0, [&] { return bus.status(0).monitor.running.value_or(false); }));
  bus.world("pump trip 16");
  ASSERT_TRUE(bus.runUntil(0.5, [&] { return bus.status(0).monitor.unknown_trip.has_value(); }));
  EXPECT_TRUE(bus.status(0).locked);
  EXPECT_EQ(bus.command(0, 20.0), bus::ERROR_LOCKED);
  bus.run(1.0);
  EXPECT_FALSE(bus.status(0).run_command);
}
}  // namespace
}  // namespace inverter_bus

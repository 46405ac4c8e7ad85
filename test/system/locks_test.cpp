// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What the status says of the lock is what becomes of velocities (contract, 4.2), on whole buses in virtual time: whatever locks,
// for a stream that goes on and for a publisher that returns to neutral before each velocity.

#include <memory>
#include <set>
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

enum class Manner
{
  Stream,
  NeutralBefore
};

const char* const MX2 = R"(
port: /dev/virtual
baud_rate: 19200
scan_list:
  - {name: belt, node: 1, drive: omron_mx2}
)";

const char* const VFS15 = R"(
port: /dev/virtual
baud_rate: 19200
parity: even
scan_list:
  - {name: pump, node: 1, drive: toshiba_vfs15}
)";

/// The codes are those that the simulated drive was given; the manual's own are not public.
const char* const JE = R"(
port: /dev/virtual
protocol: compoway_f
baud_rate: 9600
scan_list:
  - name: fan
    node: 1
    drive: omron_3g3je
    confirm: [current_scale, controller_status_meaning]
    overrides:
      operation_codes: {run_forward: "1101", run_reverse: "1102", stop: "1100", fault_reset: "1201", ram_write_mode: "1401",
                        setup_area_0: "1700", setup_area_1: "1701"}
)";

/// One publisher, the only one of inverter 0.
class ToldLocks : public testing::TestWithParam<Manner>
{
protected:
  void start(const std::string& yaml)
  {
    bus_ = std::make_unique<VirtualBus>(yaml);
  }

  bus::InverterStatus status()
  {
    return bus_->coordinator().report(bus_->now()).inverters.front().status;
  }

  /// A velocity: refused exactly if the status says so just before it.
  void command()
  {
    if (GetParam() == Manner::NeutralBefore)
    {
      bus_->command(0, 0.0);
    }
    const bool locked = status().locked;
    const std::uint16_t error_id = bus_->command(0, 20.0);
    const bool barred =
        error_id == bus::ERROR_LOCKED || error_id == bus::ERROR_CANCELLED || error_id == bus::ERROR_OFFLINE;
    EXPECT_EQ(locked, barred) << status().error_text;
    (barred ? refusals_ : accepted_).insert(barred ? status().error_text : "");
  }

  /// Such a velocity every 20 ms, for \p duration [s].
  void commandFor(double duration)
  {
    for (double time = 0.0; time < duration; time += 0.02)
    {
      bus_->at(time, [this] { command(); });
    }
    bus_->run(duration);
  }

  std::unique_ptr<VirtualBus> bus_;
  std::set<std::string> refusals_;
  std::set<std::string> accepted_;
};

INSTANTIATE_TEST_SUITE_P(Publisher, ToldLocks, testing::Values(Manner::Stream, Manner::NeutralBefore),
                         [](const auto& info) { return info.param == Manner::Stream ? "stream" : "neutralBefore"; });

TEST_P(ToldLocks, beforeTheFirstStatus)
{
  start(MX2);
  EXPECT_TRUE(status().locked);
  command();
  EXPECT_EQ(accepted_.size(), 0U);
  commandFor(3.0);
  EXPECT_EQ(accepted_.size(), GetParam() == Manner::Stream ? 0U : 1U);
}

TEST_P(ToldLocks, afterAStopThatWasConfirmedBeforeTheFirstStatus)
{
  start(MX2);
  const auto box = bus_->stop(0);
  bus_->world("belt lost_reply function 3 count 20");
  ASSERT_TRUE(bus_->runUntil(2.0, [&] { return box->has_value(); }));
  ASSERT_TRUE((*box)->success);
  ASSERT_FALSE(bus_->hasStatus(0));
  bus_->run(0.6);
  ASSERT_FALSE(bus_->hasStatus(0) && bus_->status(0).has_stamp);
  command();
  EXPECT_EQ(accepted_.size(), 0U);
}

TEST_P(ToldLocks, whileItIsOfflineAndAfterwards)
{
  start(MX2);
  bus_->settleIn();
  commandFor(0.5);
  EXPECT_EQ(accepted_.size(), 1U);
  bus_->world("belt power off");
  commandFor(3.0);
  EXPECT_THAT(refusals_, Contains(HasSubstr("offline")));
  bus_->world("belt power on");
  commandFor(5.0);
}

TEST_P(ToldLocks, duringATripAndItsReset)
{
  start(VFS15);
  bus_->settleIn();
  bus_->run(8.0);
  bus_->world("pump trip 16");
  bus_->run(2.0);
  const auto box = bus_->reset(0);
  commandFor(8.0);
  ASSERT_TRUE(box->has_value());
  EXPECT_TRUE((*box)->success) << (*box)->message;
  EXPECT_THAT(refusals_, Contains(HasSubstr("a reset of the drive is under way")));
}

TEST_P(ToldLocks, duringAResetOfADriveThatDoesNotTellOfItsTrip)
{
  // No such register: nothing but the reset itself locks.
  start(R"(
port: /dev/virtual
baud_rate: 19200
scan_list:
  - {name: mixer, node: 1, drive: omron_rx, overrides: {status: {faulted: {register: 0x0EEE}}}}
simulation:
  mixer: {reset_silence: 0.3}
)");
  bus_->settleIn();
  bus_->run(2.0);
  const auto box = bus_->reset(0);
  commandFor(3.0);
  ASSERT_TRUE(box->has_value());
  EXPECT_THAT(refusals_, Contains(HasSubstr("a reset of the drive is under way")));
}

TEST_P(ToldLocks, whileAParameterIsWrittenInTheSetupArea)
{
  start(JE);
  bus_->settleIn();
  bus_->run(8.0);
  const auto box = bus_->writeParameter(0, "P06", 70.0, false);
  ASSERT_TRUE(bus_->runUntil(2.0, [&] { return bus_->motor("fan", "setup_area") > 0.0; }));
  ASSERT_FALSE(box->has_value());
  command();
  EXPECT_THAT(refusals_, Contains(HasSubstr("setup area")));
  commandFor(3.0);
  ASSERT_TRUE(box->has_value());
  EXPECT_TRUE((*box)->success) << (*box)->message;
}

TEST_P(ToldLocks, untilTheDriveHasToldAfterARestartWhatItIs)
{
  start(VFS15);
  bus_->settleIn();
  bus_->run(8.0);
  bus_->clearFrames();
  bus_->world("pump power_cycle 0.02");
  // Its restart marker shows it.
  ASSERT_TRUE(bus_->runUntil(8.0, [&] { return bus_->count("01 03 FA 87 00 01") > 0; }));
  command();
  commandFor(8.0);
  EXPECT_THAT(refusals_, Contains(HasSubstr("has not reported yet what it is")));
}

TEST_P(ToldLocks, afterAStopAndAfterASilence)
{
  start(MX2);
  bus_->settleIn();
  commandFor(0.5);
  bus_->stop(0);
  commandFor(1.0);
  EXPECT_THAT(refusals_, Contains(HasSubstr("stop")));
  bus_->run(1.0);
  commandFor(0.5);
  bus_->run(1.0);
  EXPECT_FALSE(status().run_command) << "the command watchdog";
  commandFor(1.0);
}
}  // namespace
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// An adapter that holds bytes back is told of (contract, 8.13).
#include "bus/link/adapter_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>
#include <string>

#include "bus/bus_loop.h"
#include "support/bus_fixture.h"
#include "support/fake_port.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using std::chrono::milliseconds;
using testing::AllOf;
using testing::HasSubstr;

const char* const TIMER = "/sys/class/tty/ttyUSB0/device/latency_timer";

TEST(AdapterWatch, warnsAboveTwoMillisecondsWithTheCommandThatMendsIt)
{
  AdapterWatch watch;
  watch.note(wire::AdapterLatency{ milliseconds(16), TIMER });
  ASSERT_TRUE(watch.finding());
  EXPECT_EQ(Level::Warn, watch.finding()->level);
  EXPECT_THAT(watch.finding()->text, AllOf(HasSubstr("16 ms"), HasSubstr(std::string("echo 1 | sudo tee ") + TIMER)));
  EXPECT_EQ("16 ms", watch.text());
  EXPECT_EQ(milliseconds(16), watch.latency());
}

TEST(AdapterWatch, isContentWithTwo)
{
  AdapterWatch watch;
  watch.note(wire::AdapterLatency{ milliseconds(2), TIMER });
  EXPECT_FALSE(watch.finding());
  watch.note(wire::AdapterLatency{ milliseconds(3), TIMER });
  EXPECT_TRUE(watch.finding());
}

TEST(AdapterWatch, saysWhenTheDriverDoesNotTell)
{
  AdapterWatch watch;
  watch.note(wire::AdapterLatency{ milliseconds(16), TIMER });
  watch.note(std::nullopt);
  EXPECT_FALSE(watch.finding());
  EXPECT_EQ("not reported by its driver", watch.text());
  EXPECT_EQ(Duration::zero(), watch.latency());
}

class SlowAdapter : public wire::FakePort
{
public:
  using FakePort::FakePort;

  std::optional<wire::AdapterLatency> adapterLatency() const override
  {
    return wire::AdapterLatency{ latency, TIMER };
  }

  Duration latency = milliseconds(16);
};

TEST(AdapterWatch, isAskedAfterTheOpeningAndNowAndThen)
{
  Configuration configuration;
  configuration.bus.inverters.push_back(inverterConfig());
  configuration.drives.push_back(shipped("omron_mx2"));
  wire::VirtualClock clock;
  SlowAdapter port(clock);
  const auto protocol = wire::makeModbusRtu();
  wire::Line line(port, *protocol, clock, wire::LineTiming(19200, 10));
  std::mutex mutex;
  Coordinator coordinator(configuration, line);
  BusLoop loop(coordinator, line, clock, mutex);
  const auto warned = [&] {
    for (const Finding& finding : coordinator.report(clock.now()).findings)
    {
      if (finding.text.find("holds bytes back") != std::string::npos)
      {
        return true;
      }
    }
    return false;
  };
  const auto run = [&](double duration) {
    for (const TimePoint end = clock.now() + seconds(duration); clock.now() < end;)
    {
      clock.sleepUntil(std::min(loop.step(), end));
    }
  };
  EXPECT_FALSE(warned());
  run(0.5);
  EXPECT_TRUE(warned());
  // Somebody follows the advice.
  port.latency = milliseconds(1);
  run(6.0);
  EXPECT_FALSE(warned());
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// A port that another process holds (contract, section 2 and 8.13).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>
#include <string>
#include <vector>

#include "bus/bus_loop.h"
#include "support/bus_fixture.h"
#include "support/fake_port.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::HasSubstr;

/// Says what it is told to say, and when it was asked.
class RefusingPort : public wire::FakePort
{
public:
  explicit RefusingPort(wire::VirtualClock& clock) : FakePort(clock), time_(clock)
  {
  }

  wire::OpenResult open(std::string& error) override
  {
    tries.push_back(toSeconds(time_.now() - start_));
    if (result == wire::OpenResult::Opened)
    {
      return FakePort::open(error);
    }
    error = result == wire::OpenResult::InUse ? "fake is in use by another process" : "cannot open fake";
    return result;
  }

  wire::OpenResult result = wire::OpenResult::InUse;
  /// [s] after the start.
  std::vector<double> tries;

private:
  wire::VirtualClock& time_;
  const TimePoint start_ = time_.now();
};

class PortInUse : public testing::Test
{
protected:
  static Configuration oneBelt()
  {
    Configuration configuration;
    configuration.bus.inverters.push_back(inverterConfig());
    configuration.drives.push_back(shipped("omron_mx2"));
    return configuration;
  }

  void run(double duration)
  {
    const TimePoint end = clock_.now() + seconds(duration);
    while (clock_.now() < end)
    {
      const TimePoint wake = loop_.step();
      statuses_ += coordinator_.takeOutputs().bus_statuses.size();
      clock_.sleepUntil(std::min(wake, end));
    }
  }

  std::vector<std::string> busFindings() const
  {
    std::vector<std::string> texts;
    for (const Finding& finding : coordinator_.report(clock_.now()).findings)
    {
      texts.push_back(finding.text);
    }
    return texts;
  }

  const Configuration configuration_ = oneBelt();
  wire::VirtualClock clock_;
  RefusingPort port_{ clock_ };
  std::unique_ptr<wire::Protocol> protocol_ = wire::makeModbusRtu();
  wire::Line line_{ port_, *protocol_, clock_, wire::LineTiming(19200, 10) };
  std::mutex mutex_;
  Coordinator coordinator_{ configuration_, line_ };
  BusLoop loop_{ coordinator_, line_, clock_, mutex_ };
  std::size_t statuses_ = 0;
};

TEST_F(PortInUse, isTriedOnceASecondForThirtySeconds)
{
  run(29.9);
  EXPECT_FALSE(loop_.portInUse());
  ASSERT_EQ(30U, port_.tries.size());
  for (std::size_t i = 0; i < port_.tries.size(); ++i)
  {
    EXPECT_NEAR(static_cast<double>(i), port_.tries[i], 1e-3);
  }
  run(0.2);
  EXPECT_TRUE(loop_.portInUse());
}

TEST_F(PortInUse, isToldWhileItIsTried)
{
  run(10.05);
  EXPECT_GE(statuses_, 10U);
  EXPECT_THAT(busFindings(), testing::Contains(HasSubstr("in use by another process")));
}

TEST_F(PortInUse, isTriedForEverByANodeThatHasHadIt)
{
  port_.result = wire::OpenResult::Opened;
  run(1.0);
  port_.unplug();
  port_.result = wire::OpenResult::InUse;
  run(1.0);
  port_.tries.clear();
  run(100.0);
  EXPECT_FALSE(loop_.portInUse());
  EXPECT_NEAR(100.0, static_cast<double>(port_.tries.size()), 1.0);
}

TEST_F(PortInUse, countsFromTheFirstRefusalInARow)
{
  run(20.05);
  port_.result = wire::OpenResult::NotThere;
  run(1.0);
  port_.result = wire::OpenResult::InUse;
  run(29.0);
  EXPECT_FALSE(loop_.portInUse());
  run(3.0);
  EXPECT_TRUE(loop_.portInUse());
}

TEST_F(PortInUse, aMissingOneIsTriedFiveTimesASecond)
{
  port_.result = wire::OpenResult::NotThere;
  run(0.95);
  EXPECT_EQ(5U, port_.tries.size());
}

TEST_F(PortInUse, thePortIsNamedForTheInverterToo)
{
  run(1.0);
  const Report report = coordinator_.report(clock_.now());
  ASSERT_FALSE(report.inverters.front().findings.empty());
  const std::string text = report.inverters.front().findings.front().text;
  EXPECT_THAT(text, HasSubstr("the port is not open"));
  EXPECT_THAT(text, testing::Not(HasSubstr("station number")));
}

TEST_F(PortInUse, anInverterThatDoesNotAnswerOnTheOpenPortIsToldApart)
{
  run(1.0);
  port_.result = wire::OpenResult::Opened;
  run(10.0);
  const Report report = coordinator_.report(clock_.now());
  ASSERT_FALSE(report.inverters.front().findings.empty());
  EXPECT_THAT(report.inverters.front().findings.front().text, HasSubstr("station number"));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

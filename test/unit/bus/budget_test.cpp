// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The computed figures of rule 3.11, compared with figures computed by hand.
//
// At 19200 8N1 a character has 10 bits = 520.8 us and the gap 3.5 of them = 1.823 ms. An MX2 waits 5 ms before a reply.
//   coils 0001h-0018h:     8 characters there,  8 back: 16 * 0.5208 + 2 * 1.823 + 5 = 16.979 ms
//   registers 1001h-1004h: 8 characters there, 13 back: 21 * 0.5208 + 2 * 1.823 + 5 = 19.583 ms  together 36.563 ms
//   slow reads, with the drive's wait: 16.458 + 25.833 + 16.458 = 58.750 ms; once a second each they take 5.875 % of the
//   wire, and never more than 7.5 %
//   a cycle with them in proportion: 36.563 / (1 - 0.05875) = 38.845 ms
//   longest exchange: 33 characters, 2 gaps, 5 ms, 100 ms of silence and a pause of 25 ms in the reply = 150.833 ms
//   a stop after it: gap and 8 characters = 5.990 ms, with a gap behind it 7.813 ms

#include "bus/rules/budget.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"
#include "support/fake_port.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

/// A bus of equal inverters on a line that nobody sends on.
class Planned
{
public:
  explicit Planned(std::size_t inverters, unsigned baud_rate = 19200, unsigned bits = 10,
                   const drive::Drive& drive = shipped("omron_mx2"))
    : Planned(inverters, wire::LineTiming(baud_rate, bits), drive)
  {
  }

  Planned(std::size_t inverters, const wire::LineTiming& timing, const drive::Drive& drive = shipped("omron_mx2"))
    : protocol_(wire::makeModbusRtu()), line_(port_, *protocol_, clock_, timing)
  {
    for (std::size_t index = 0; index < inverters; ++index)
    {
      InverterConfig config = inverterConfig();
      config.name = "belt_" + std::to_string(index + 1);
      config.node = static_cast<std::uint8_t>(index + 1);
      configuration.bus.inverters.push_back(config);
      configuration.drives.push_back(drive);
    }
  }

  /// Texts of a level.
  std::vector<std::string> texts(Level level) const
  {
    std::vector<std::string> texts;
    for (const Finding& finding : budget.findings())
    {
      if (finding.level == level)
      {
        texts.push_back(finding.text);
      }
    }
    return texts;
  }

  Configuration configuration;

private:
  wire::VirtualClock clock_;
  wire::FakePort port_{ clock_ };
  std::unique_ptr<wire::Protocol> protocol_;
  wire::Line line_;

public:
  const Budget budget{ configuration, line_ };
};

double ms(Duration duration)
{
  return toSeconds(duration) * 1e3;
}

TEST(Budget, cycleOfOneMx2)
{
  const Planned bus(1);
  EXPECT_NEAR(ms(bus.budget.cycle()), 38.845, 0.01);
}

TEST(Budget, cycleOfTwoMx2)
{
  // Slow reads would take 11.75 %: 73.125 / (1 - 0.075).
  const Planned bus(2);
  EXPECT_NEAR(ms(bus.budget.cycle()), 79.054, 0.01);
}

TEST(Budget, cycleAt9600With11Bits)
{
  // A character 1.1458 ms, the gap 4.0104 ms: 31.354 + 37.083 = 68.438; slow reads would take 11.1 %:
  // 68.438 / (1 - 0.075).
  const Planned bus(1, 9600, 11);
  EXPECT_NEAR(ms(bus.budget.cycle()), 73.987, 0.01);
}

TEST(Budget, cycleAbove19200BaudWithTheFixedGap)
{
  // 38400 8N1: a character 0.2604 ms, the gap 1.75 ms: 12.667 + 13.969 = 26.635; slow 26.91 to 41.91: 27.37 to 27.80.
  const Planned bus(1, 38400);
  EXPECT_THAT(ms(bus.budget.cycle()), AllOf(testing::Ge(27.3), testing::Le(27.9)));
}

TEST(Budget, slowPeriodIsWhatTheirShareOfTheWireAllows)
{
  // The cycle is below 0.7 s, so that of 7.5 % of 10 s 0.7 s may be saved up: 7.009 % of the wire for 31 * 58.750 ms; the
  // cycle of 31 drives is 1.225 s: 6.681 %.
  EXPECT_EQ(Planned(1).budget.slowPeriod(), std::chrono::seconds(1));
  EXPECT_NEAR(toSeconds(Planned(5).budget.slowPeriod()), 5 * 0.05875 / 0.07009, 0.01);
  EXPECT_NEAR(toSeconds(Planned(31).budget.slowPeriod()), 31 * 0.05875 / 0.06681, 0.05);
}

TEST(Budget, warnsAboveFiveSecondsAndNamesSkip)
{
  EXPECT_THAT(Planned(5).texts(Level::Ok), Contains(HasSubstr("slow values every 4.19 s")));
  EXPECT_THAT(Planned(5).texts(Level::Warn), Not(Contains(HasSubstr("skip"))));
  EXPECT_THAT(Planned(6).texts(Level::Warn), Contains(AllOf(HasSubstr("slow values"), HasSubstr("skip"))));
}

TEST(Budget, whoWantsThemSeldomIsNotWarned)
{
  Planned bus(6);
  bus.configuration.bus.slow_interval = 30.0;
  EXPECT_THAT(bus.texts(Level::Warn), Not(Contains(HasSubstr("skip"))));
  bus.configuration.bus.slow_interval = 0.0;
  EXPECT_THAT(bus.texts(Level::Warn), Not(Contains(HasSubstr("skip"))));
  EXPECT_THAT(bus.texts(Level::Ok), Contains(HasSubstr("slow values never")));
}

TEST(Budget, longestExchangeIsTheReadOfTenRegistersWhoseReplyBeginsAtTheLastMoment)
{
  // 8 + 25 characters 17.188, two gaps 3.646, the drive's wait 5, the response time-out 100, a pause in the reply 25.
  EXPECT_NEAR(ms(Planned(1).budget.longestExchange()), 150.833, 0.01);
}

TEST(Budget, longestExchangeHasTheLongestResponseTimeoutOfTheBus)
{
  Planned bus(3);
  bus.configuration.bus.inverters[1].response_timeout = 0.5;
  EXPECT_NEAR(ms(bus.budget.longestExchange()), 550.833, 0.01);
}

TEST(Budget, worstStopIsBehindTheLongestExchangeThatItCutsAndTheStopsOwnFrame)
{
  // 8 + 25 characters 17.188, two gaps 3.646, 15 of silence, a pause of 18 characters 9.375: 45.208. The stop's frame is a
  // gap and 8 characters, 5.990, or a gap more.
  EXPECT_THAT(ms(Planned(1).budget.worstStop()), AllOf(testing::Ge(49.3), testing::Le(53.1)));
}

TEST(Budget, worstStopBehindWhatItDoesNotCutIsTheLongestExchangeAndTheStopsOwnFrame)
{
  EXPECT_THAT(ms(Planned(1).budget.worstStopUncut()), AllOf(testing::Ge(156.82), testing::Le(158.66)));
}

TEST(Budget, worstStopContainsThePauseThatIsAllowedForInAReply)
{
  // At 2400 8N1 18 characters take 75 ms. A character takes 4.167 ms and the gap 14.583: 33 characters 137.5, two gaps
  // 29.167, 5, 100, and 75 of pause make 346.667; the stop's frame is a gap and 8 characters, 47.917, or a gap more.
  EXPECT_THAT(ms(Planned(1, 2400).budget.worstStopUncut()), AllOf(testing::Ge(394.5), testing::Le(409.2)));
  // The default at 19200 8N1 is 25 ms.
  const double raised = 0.3;
  EXPECT_NEAR(ms(Planned(1, wire::LineTiming(19200, 10, seconds(raised))).budget.worstStopUncut()) -
                  ms(Planned(1).budget.worstStopUncut()),
              (raised - 0.025) * 1e3, 0.01);
  EXPECT_EQ(Planned(1, wire::LineTiming(19200, 10, seconds(raised))).budget.worstStop(), Planned(1).budget.worstStop());
}

TEST(Budget, worstStopDoesNotDependOnTheNumberOfInverters)
{
  EXPECT_EQ(Planned(1).budget.worstStop(), Planned(20).budget.worstStop());
}

TEST(Budget, worstStopDoesNotDependOnTheInterval)
{
  Planned bus(1);
  bus.configuration.bus.interval = 600.0;
  EXPECT_THAT(ms(bus.budget.worstStop()), testing::Le(53.1));
}

TEST(Budget, longestGapIsACycleWithAVelocityBeforeEachReadAndALostExchange)
{
  // A velocity: 21 characters, then twice 16, six gaps, three waits of 5 = 53.54. 38.24 + 2 * 53.54 + 150.83 = 296.2.
  EXPECT_THAT(ms(Planned(1).budget.longestGap()), AllOf(testing::Ge(296.1), testing::Le(296.9)));
}

TEST(Budget, longestGapContainsTheInterval)
{
  Planned bus(1);
  bus.configuration.bus.interval = 0.5;
  EXPECT_THAT(ms(bus.budget.longestGap()), AllOf(testing::Ge(796.1), testing::Le(796.9)));
}

TEST(Budget, printsItsFiguresInOneLine)
{
  const std::vector<std::string> lines = Planned(1).texts(Level::Ok);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines.front(), AllOf(HasSubstr("cycle 38."), HasSubstr("stop latency 5"), HasSubstr("15"),
                                   HasSubstr("behind another stop"),
                                   HasSubstr("gap between two "
                                             "frames"),
                                   HasSubstr("296.")));
}

// A probe that nobody answers: 8 characters, 2 gaps and 12 ms of silence = 19.812 ms. The turns have 4.5 % of the time, and
// a first status may take 0.3 s: 440.3 ms for each that is offline.
TEST(Budget, returnOfAnOfflineInverterTakesATurnOfEveryOther)
{
  EXPECT_NEAR(ms(Planned(31).budget.returnTime(6)), 3000.0, 0.1) << "2.942 s: what rule 3.7 says";
  EXPECT_NEAR(ms(Planned(31).budget.returnTime(15)), 6904.2, 0.5);
  EXPECT_NEAR(ms(Planned(31).budget.returnTime(31)), 13948.6, 1.0);
}

TEST(Budget, printsHowLongAnOfflineInverterNeedsToBeBack)
{
  EXPECT_THAT(Planned(5).texts(Level::Ok).front(), EndsWith("an inverter that answers again back within 3 s"));
  EXPECT_THAT(Planned(31).texts(Level::Ok).front(),
              EndsWith("an inverter that answers again back within 3 s with up to 6 offline, within 13.9 s with all"));
}

TEST(Budget, saysHowLongAnOfflineInverterMayNeedToBeBackBehindAGateway)
{
  // 5 % of 60 s are 3 s, and 5 % of 3 s are 0.15 s.
  Planned bus(1);
  const auto told = HasSubstr("may need up to");
  EXPECT_THAT(bus.texts(Level::Ok), Not(Contains(told))) << "a serial port";
  bus.configuration.bus.modbus_tcp = true;
  bus.configuration.bus.gateway_timeout = 3.0;
  EXPECT_THAT(bus.texts(Level::Ok),
              Contains(AllOf(told, HasSubstr("up to 60 s"), HasSubstr("3 s if it does so for 150 ms at most"))));
  bus.configuration.bus.gateway_timeout = 0.15;
  EXPECT_THAT(bus.texts(Level::Ok), Not(Contains(told)));
}

TEST(Budget, offlineInvertersTakeTurnsToBeBackBehindAGateway)
{
  EXPECT_NEAR(ms(Budget::longestReturn(Ms(1000), 1)), 20000.0, 1.0);
  EXPECT_NEAR(ms(Budget::longestReturn(Ms(1000), 3)), 60000.0, 1.0);
  EXPECT_NEAR(ms(Budget::longestReturn(Ms(1000), 0)), 20000.0, 1.0) << "the next one that goes offline";
  EXPECT_NEAR(ms(Budget::longestReturn(Ms(150), 1)), 3000.0, 1.0);
  EXPECT_NEAR(ms(Budget::longestReturn(Ms(0), 4)), 3000.0, 1.0);
  EXPECT_NEAR(ms(Budget::longestReturn(Ms(0), 10)), 5000.0, 1.0) << "each at most once in 0.5 s";
}

TEST(Budget, warnsOfNothingOnASmallBus)
{
  EXPECT_THAT(Planned(1).texts(Level::Warn), testing::IsEmpty());
}

TEST(Budget, warnsOfACommandTimeoutThatIsShorterThanACycle)
{
  Planned bus(2);
  bus.configuration.bus.inverters[1].command_timeout = 0.05;
  EXPECT_THAT(bus.texts(Level::Warn),
              testing::ElementsAre(AllOf(HasSubstr("belt_2"), HasSubstr("command_timeout"), HasSubstr("0.05"))));
}

TEST(Budget, warnsOfNoCommandTimeoutThatIsOff)
{
  Planned bus(2);
  bus.configuration.bus.inverters[1].command_timeout = 0.0;
  EXPECT_THAT(bus.texts(Level::Warn), testing::IsEmpty());
}

TEST(Budget, warnsOfADriveTimeoutThatCannotBeMet)
{
  // A velocity 53.54, a read of 4 registers 19.58 and the longest exchange 150.83: 223.96.
  const Planned bus(1);
  EXPECT_FALSE(bus.budget.judgeDriveTimeout("belt", Ms(225)));
  const auto finding = bus.budget.judgeDriveTimeout("belt", Ms(150));
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->level, Level::Warn);
  EXPECT_THAT(finding->text, AllOf(HasSubstr("belt"), HasSubstr("150.0 ms"), HasSubstr("raise")));
}

TEST(Budget, intervalIsNoReasonToWarnOfADriveTimeoutSinceItIsCutShort)
{
  Planned bus(1);
  bus.configuration.bus.interval = 60.0;
  EXPECT_FALSE(bus.budget.judgeDriveTimeout("belt", Ms(1000)));
}

TEST(Budget, warnsOfAnAssumedDriveTimeoutThatCannotBeMet)
{
  drive::Profile profile = drive::loadProfile("omron_mx2", drive::profileDirectory());
  profile.communication_loss = drive::CommunicationLoss();
  profile.communication_loss.assumed_timeout = 1.0;
  profile.communication_loss.assumed_action = "decelerate";
  const drive::Drive drive(profile);
  EXPECT_THAT(Planned(1, 19200, 10, drive).texts(Level::Warn), testing::IsEmpty());
  // 20 inverters need more than 700 ms for a cycle.
  const std::vector<std::string> warnings = Planned(20, 19200, 10, drive).texts(Level::Warn);
  EXPECT_THAT(warnings, Contains(AllOf(HasSubstr("belt_1:"), HasSubstr("1000.0 ms"))));
}

TEST(Budget, rxNeedsItsOwnReads)
{
  // Coils 16.979 ms; the trip register 8 + 7 = 15 characters, 16.458 ms; registers 1001h, 1002h, 1004h of the RX hold
  // no confirmed current, so that 4 of them are still one read of 21 characters, 19.583 ms: 53.02 ms and the slow part.
  const Planned bus(1, 19200, 10, shipped("omron_rx"));
  EXPECT_THAT(ms(bus.budget.cycle()), AllOf(testing::Ge(53.0), testing::Le(58.0)));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

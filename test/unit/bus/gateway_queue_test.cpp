// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Contract, 8.8: what may follow a request that a gateway has not answered. Times by hand.

#include "bus/link/gateway_queue.h"

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr std::size_t DEAD = 1;
constexpr std::size_t LIVE = 0;

GatewayQueue::Settings settings()
{
  GatewayQueue::Settings settings;
  settings.active = true;
  settings.timeout = std::chrono::seconds(3);
  settings.response_timeout = std::chrono::milliseconds(300);
  return settings;
}

class AGatewayQueue : public ::testing::Test
{
protected:
  TimePoint at(double time) const
  {
    return start_ + seconds(time);
  }

  /// A request that leaves at \p time and is lost 0.3 s later.
  std::uint64_t lose(double time, std::size_t inverter, GatewayRisk risk = GatewayRisk::None)
  {
    queue_.sent(at(time), ++ticket_, inverter, risk);
    queue_.lost(at(time + 0.3), ticket_);
    return ticket_;
  }

  void answer(double time, double took, std::size_t inverter)
  {
    queue_.sent(at(time), ++ticket_, inverter, GatewayRisk::None);
    queue_.answered(at(time + took), ticket_);
  }

  const TimePoint start_ = TimePoint() + std::chrono::hours(1);
  GatewayQueue queue_{ settings() };
  std::uint64_t ticket_ = 0;
};

TEST_F(AGatewayQueue, isFreeAfterAnAnswer)
{
  answer(0.0, 0.05, LIVE);
  EXPECT_TRUE(queue_.free(at(0.05)));
  EXPECT_EQ(queue_.freeAt(at(0.05)), at(0.05));
}

TEST_F(AGatewayQueue, isBusyWithALostRequestUntilTheGatewayTimeoutHasPassed)
{
  lose(0.0, DEAD);
  EXPECT_FALSE(queue_.free(at(0.3)));
  EXPECT_EQ(queue_.freeAt(at(0.3)), at(3.0));
  EXPECT_FALSE(queue_.free(at(2.999)));
  EXPECT_TRUE(queue_.free(at(3.0)));
}

TEST_F(AGatewayQueue, isFreeAsSoonAsTheLateAnswerHasCome)
{
  const std::uint64_t ticket = lose(0.0, DEAD);
  const auto late = queue_.answeredLate(at(1.1), ticket);
  ASSERT_TRUE(late);
  EXPECT_EQ(late->inverter, DEAD);
  EXPECT_TRUE(late->alone);
  EXPECT_TRUE(queue_.free(at(1.1)));
  EXPECT_EQ(queue_.block(), seconds(1.1)) << "so long does a silent station keep the gateway";
  EXPECT_FALSE(queue_.answeredLate(at(1.2), ticket)) << "it is owed one answer only";
}

TEST_F(AGatewayQueue, isKeptByASilentStationAlsoWhenItSaysSoInTime)
{
  answer(0.0, 0.2, LIVE);
  EXPECT_EQ(queue_.block(), Duration::zero()) << "a drive's answer";
  queue_.sent(at(1.0), 100, DEAD, GatewayRisk::None);
  queue_.answered(at(1.25), 100, true);
  EXPECT_EQ(queue_.block(), seconds(0.25));
  queue_.sent(at(2.0), 101, DEAD, GatewayRisk::None);
  queue_.answered(at(2.01), 101, true);
  EXPECT_EQ(queue_.block(), seconds(0.25)) << "it may know that from a moment ago";
}

TEST_F(AGatewayQueue, aTimeOutThatWasShortenedInItCountsAfterAWhile)
{
  queue_.answeredLate(at(2.2), lose(0.0, DEAD));
  ASSERT_EQ(queue_.block(), seconds(2.2));
  for (int probe = 0; probe < 8; ++probe)
  {
    EXPECT_EQ(queue_.block(), seconds(2.2)) << probe;
    queue_.sent(at(10.0 + probe), 100, DEAD, GatewayRisk::None);
    queue_.answered(at(10.1 + probe), 100, true);
  }
  EXPECT_EQ(queue_.block(), seconds(10.1) - seconds(10.0));
}

TEST_F(AGatewayQueue, letsOneStopFramePerInverterIn)
{
  lose(0.0, DEAD);
  EXPECT_EQ(queue_.stopMayGoAt(at(0.4), LIVE), at(0.4));
  const std::uint64_t stop = lose(0.4, LIVE, GatewayRisk::Stop);
  EXPECT_EQ(queue_.stopMayGoAt(at(0.8), LIVE), at(3.4)) << "the next try waits";
  EXPECT_EQ(queue_.stopMayGoAt(at(0.8), DEAD), at(0.8)) << "another inverter's goes at once";
  EXPECT_FALSE(queue_.answeredLate(at(1.2), stop)->alone);
  EXPECT_EQ(queue_.stopMayGoAt(at(1.2), LIVE), at(1.2));
}

TEST_F(AGatewayQueue, saysThatARequestBehindAnotherOneProvesNothing)
{
  const std::uint64_t first = lose(0.0, DEAD);
  EXPECT_FALSE(queue_.behindAnother(first));
  const std::uint64_t second = lose(0.5, LIVE, GatewayRisk::Stop);
  EXPECT_TRUE(queue_.behindAnother(second));
}

TEST_F(AGatewayQueue, aStopThatWaitedBehindAnotherOneDoesNotTellHowLongASilentStationTakes)
{
  lose(0.0, DEAD);
  const std::uint64_t stop = lose(0.5, LIVE, GatewayRisk::Stop);
  queue_.answeredLate(at(2.0), stop);
  EXPECT_EQ(queue_.block(), Duration::zero());
}

TEST_F(AGatewayQueue, allowsOneRefreshPerInverterThatItsOwnTimeOutNeeds)
{
  lose(0.0, DEAD);
  EXPECT_FALSE(queue_.refreshUnanswered(at(0.5), LIVE));
  const std::uint64_t refresh = lose(0.5, LIVE, GatewayRisk::Refresh);
  EXPECT_TRUE(queue_.refreshUnanswered(at(0.9), LIVE));
  queue_.answeredLate(at(1.0), refresh);
  EXPECT_FALSE(queue_.refreshUnanswered(at(1.0), LIVE));
}

TEST_F(AGatewayQueue, isSilentByNatureAfterThreeThatNobodyAnswered)
{
  answer(0.0, 0.05, LIVE);
  for (int lost = 0; lost < 3; ++lost)
  {
    EXPECT_FALSE(queue_.silentByNature());
    lose(1.0 + 4.0 * lost, DEAD);
    queue_.tick(at(4.0 + 4.0 * lost));
  }
  EXPECT_TRUE(queue_.silentByNature());
  EXPECT_EQ(queue_.wait(), seconds(0.05) + seconds(0.3)) << "the longest reply seen and response_timeout";
  const std::uint64_t ticket = lose(20.0, DEAD);
  EXPECT_EQ(queue_.freeAt(at(20.3)), at(20.35));
  queue_.answeredLate(at(20.34), ticket);
  EXPECT_FALSE(queue_.silentByNature()) << "one late answer ends it";
  EXPECT_EQ(queue_.wait(), std::chrono::seconds(3));
}

TEST_F(AGatewayQueue, aLateAnswerInBetweenShowsThatItIsNotSilentByNature)
{
  for (int lost = 0; lost < 6; ++lost)
  {
    const std::uint64_t ticket = lose(10.0 * lost, DEAD);
    if (lost % 2 == 1)
    {
      queue_.answeredLate(at(10.0 * lost + 1.0), ticket);
    }
    queue_.tick(at(10.0 * lost + 5.0));
    EXPECT_FALSE(queue_.silentByNature());
  }
}

TEST_F(AGatewayQueue, remembersWhatMayStartAMotorAlsoBeyondTheConnection)
{
  lose(0.0, LIVE, GatewayRisk::Motion);
  EXPECT_EQ(queue_.motionUntil(at(0.4), LIVE), at(3.0));
  EXPECT_FALSE(queue_.motionUntil(at(0.4), DEAD));
  queue_.connectionEnded(at(0.5));
  EXPECT_TRUE(queue_.free(at(0.5))) << "over the new connection nobody waits for it";
  EXPECT_EQ(queue_.motionUntil(at(2.9), LIVE), at(3.0)) << "but the gateway may still carry it out";
  EXPECT_FALSE(queue_.motionUntil(at(3.0), LIVE));
}

TEST_F(AGatewayQueue, forgetsWhatMayStartAMotorWhenItWasAnswered)
{
  const std::uint64_t run = lose(0.0, LIVE, GatewayRisk::Motion);
  EXPECT_EQ(queue_.answeredLate(at(0.9), run)->risk, GatewayRisk::Motion);
  EXPECT_FALSE(queue_.motionUntil(at(0.9), LIVE));
}

TEST_F(AGatewayQueue, reckonsWithALateStartForTheWholeTimeWhereTheGatewayIsSilentByNature)
{
  for (int lost = 0; lost < 3; ++lost)
  {
    lose(4.0 * lost, DEAD);
    queue_.tick(at(4.0 * lost + 3.5));
  }
  ASSERT_TRUE(queue_.silentByNature());
  lose(20.0, LIVE, GatewayRisk::Motion);
  EXPECT_TRUE(queue_.free(at(20.7)));
  EXPECT_EQ(queue_.motionUntil(at(20.7), LIVE), at(23.0));
}

TEST_F(AGatewayQueue, tellsWhatAGivenUpProbeHasCost)
{
  queue_.sent(at(0.0), 1, DEAD, GatewayRisk::None, true);
  queue_.lost(at(0.3), 1);
  EXPECT_FALSE(queue_.tick(at(2.9)));
  EXPECT_EQ(queue_.tick(at(3.0)), std::optional<Duration>(std::chrono::seconds(3)));
  EXPECT_FALSE(queue_.tick(at(3.1))) << "once";
}

TEST_F(AGatewayQueue, tellsWhatAGivenUpProbeHasCostAlsoWhenAnotherRequestHasShownIt)
{
  queue_.sent(at(0.0), 100, DEAD, GatewayRisk::None, true);
  queue_.lost(at(0.3), 100);
  // A stop goes in spite of it, and it is given up while that one is on its way.
  queue_.sent(at(2.8), 101, LIVE, GatewayRisk::Stop);
  queue_.lost(at(3.1), 101);
  EXPECT_EQ(queue_.tick(at(3.1)), std::optional<Duration>(std::chrono::seconds(3)));
  EXPECT_FALSE(queue_.tick(at(3.2))) << "once";
  queue_.sent(at(10.0), 102, DEAD, GatewayRisk::None, true);
  queue_.lost(at(10.3), 102);
  queue_.sent(at(13.5), 103, LIVE, GatewayRisk::None);
  EXPECT_EQ(queue_.tick(at(13.6)), std::optional<Duration>(std::chrono::seconds(3)));
}

TEST_F(AGatewayQueue, whoLooksLateHasNotBeenKeptForSoLong)
{
  queue_.sent(at(0.0), 1, DEAD, GatewayRisk::None, true);
  queue_.lost(at(0.3), 1);
  EXPECT_EQ(queue_.tick(at(60.0)), std::optional<Duration>(std::chrono::seconds(3)));
  queue_.sent(at(70.0), 2, DEAD, GatewayRisk::None);
  queue_.lost(at(70.3), 2);
  queue_.answeredLate(at(130.0), 2);
  EXPECT_EQ(queue_.block(), std::chrono::seconds(3));
}

TEST_F(AGatewayQueue, theLongestOfTheProbesThatRanSideBySideIsPaid)
{
  for (const std::uint64_t ticket : { 1U, 2U })
  {
    queue_.sent(at(static_cast<double>(ticket)), ticket, DEAD, GatewayRisk::Stop, true);
    queue_.lost(at(static_cast<double>(ticket) + 0.3), ticket);
  }
  EXPECT_EQ(queue_.tick(at(9.0)), std::optional<Duration>(std::chrono::seconds(3)));
  EXPECT_FALSE(queue_.tick(at(9.0)));
}

TEST_F(AGatewayQueue, aProbeInWhosePlaceTheConnectionWasEndedHasCostTheTimeUntilThen)
{
  queue_.sent(at(0.0), 1, DEAD, GatewayRisk::None, true);
  queue_.lost(at(0.3), 1);
  queue_.connectionEnded(at(1.2));
  EXPECT_EQ(queue_.tick(at(1.2)), std::optional<Duration>(seconds(1.2)));
  EXPECT_EQ(queue_.block(), seconds(1.2)) << "so long has the gateway waited for the station";
  EXPECT_FALSE(queue_.tick(at(5.0))) << "once";
}

TEST_F(AGatewayQueue, aConnectionThatEndsSoonerMakesTheBlockNoShorter)
{
  lose(0.0, DEAD);
  queue_.tick(at(3.0));
  ASSERT_EQ(queue_.block(), seconds(3.0));
  lose(4.0, LIVE);
  queue_.connectionEnded(at(4.4));
  EXPECT_EQ(queue_.block(), seconds(3.0));
}

TEST_F(AGatewayQueue, aLostRequestThatWasNoProbeCostsTheProbesNothing)
{
  lose(0.0, LIVE);
  EXPECT_FALSE(queue_.tick(at(3.0)));
  lose(4.0, LIVE, GatewayRisk::Motion);
  queue_.connectionEnded(at(4.5));
  EXPECT_FALSE(queue_.tick(at(7.0))) << "of a connection that has ended";
}

TEST(NoGateway, allowsEverything)
{
  GatewayQueue queue{ GatewayQueue::Settings() };
  const TimePoint now = TimePoint() + std::chrono::hours(1);
  queue.sent(now, 1, 0, GatewayRisk::Motion);
  queue.lost(now + std::chrono::milliseconds(100), 1);
  EXPECT_FALSE(queue.active());
  EXPECT_TRUE(queue.free(now));
  EXPECT_FALSE(queue.behindAnother(1));
  EXPECT_FALSE(queue.motionUntil(now, 0));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

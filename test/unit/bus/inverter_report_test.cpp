// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What users are told of one inverter.

#include "bus/report/inverter_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

MATCHER_P(warns, text, "")
{
  return arg.level == Level::Warn && arg.text.find(text) != std::string::npos;
}

MATCHER_P(isError, text, "")
{
  return arg.level == Level::Error && arg.text.find(text) != std::string::npos;
}

class Mx2Report : public testing::Test
{
protected:
  void loseExchange(std::uint16_t error_id = wire::ERROR_TIMEOUT)
  {
    wire::Reply reply = lost();
    reply.error_id = error_id;
    inverter_.noteExchange(reply);
    inverter_.record.note(reply);
    inverter_.failed(at(0), error_id);
  }

  InverterStatus status(int time = 0) const
  {
    return statusOf(inverter_, at(time));
  }

  std::vector<Finding> findings(int time = 0) const
  {
    return findingsOf(inverter_, at(time));
  }

  const InverterConfig config_ = inverterConfig();
  const drive::Drive mx2_ = shipped("omron_mx2");
  Inverter inverter_{ 4, config_, mx2_, 2, 1 };
};

TEST_F(Mx2Report, statusAtFirstIsLockedAndShowsNothing)
{
  const InverterStatus status = this->status();
  EXPECT_EQ(4U, status.index);
  EXPECT_FALSE(status.has_stamp);
  EXPECT_TRUE(status.locked);
  EXPECT_FALSE(status.communication_error);
  EXPECT_FALSE(status.monitor.output_frequency);
  EXPECT_EQ(0, status.error_id);
  EXPECT_EQ("", status.error_text);
}

TEST_F(Mx2Report, aSingleLostExchangeIsShownBehindAllElse)
{
  loseExchange(wire::ERROR_DAMAGED);
  EXPECT_EQ(wire::ERROR_DAMAGED, status().error_id);
  inverter_.command_error.failed(wire::ERROR_TIMEOUT, "writes are lost");
  EXPECT_THAT(status().error_text, HasSubstr("the last velocity was not carried out"));
  inverter_.command_error.set(ERROR_OUT_OF_RANGE, "300 is above 50", inverter_.obstacles(at(0)));
  EXPECT_EQ(ERROR_OUT_OF_RANGE, status().error_id);
  inverter_.lost_writes.raise();
  EXPECT_EQ(wire::ERROR_TIMEOUT, status().error_id) << "why it is locked says more than a refusal";
  EXPECT_EQ("writes are lost", status().error_text);
}

TEST_F(Mx2Report, whyItIsOfflineSaysMoreThanARefusalBecauseItIs)
{
  inverter_.command_error.set(ERROR_LOCKED, lockedText(false), inverter_.obstacles(at(0)));
  loseExchange();
  loseExchange();
  EXPECT_TRUE(status().communication_error);
  EXPECT_EQ(wire::ERROR_TIMEOUT, status().error_id);
  inverter_.command_error.set(ERROR_OUT_OF_RANGE, "300 is above 50", inverter_.obstacles(at(0)));
  EXPECT_EQ(ERROR_OUT_OF_RANGE, status().error_id);
}

TEST_F(Mx2Report, anInverterThatIsOfflineIsTheOnlyErrorAndSaysWhatToCheck)
{
  loseExchange();
  loseExchange();
  inverter_.lost_writes.raise();
  ASSERT_FALSE(findings().empty());
  EXPECT_THAT(findings().front(), isError("offline (0x0205 no reply in time"));
  EXPECT_THAT(findings().front().text, AllOf(HasSubstr("last answer never"), HasSubstr("of 2 requests"),
                                             HasSubstr("check supply, wiring, station number")));
  EXPECT_THAT(findings(), Not(Contains(isError("writes are lost"))));
  EXPECT_THAT(offlineReason(inverter_), HasSubstr("no reply in time; since the last complete status of 2 requests"));
}

TEST_F(Mx2Report, aMissingPortIsToldOfTheBus)
{
  loseExchange();
  inverter_.goOffline(wire::ERROR_PORT_LOST);
  EXPECT_THAT(findings().front().text, AllOf(HasSubstr("reported for the bus"), Not(HasSubstr("wiring"))));
  EXPECT_THAT(offlineReason(inverter_), Not(HasSubstr("since the last complete status")));
}

TEST_F(Mx2Report, writesThatAreLostAndATripAreErrors)
{
  inverter_.lost_writes.lost();
  inverter_.lost_writes.raise();
  inverter_.interlock.faulted(true);
  EXPECT_THAT(findings(), Contains(isError("writes are lost (1 in a row): stopped and locked")));
  EXPECT_THAT(findings(), Contains(isError("tripped: ")));
  EXPECT_THAT(findings(), Contains(isError("remove the cause, then call reset")));
}

TEST_F(Mx2Report, beforeTheFirstStatusItSaysWhatCameInstead)
{
  EXPECT_THAT(findings(), Contains(warns("has not been asked yet")));
  loseExchange();
  EXPECT_THAT(findings(), Contains(warns("no complete status yet: of 1 requests 1 without a reply")));
  inverter_.link.statusComplete();
  EXPECT_THAT(findings(), Not(Contains(warns("no complete status yet"))));
}

TEST_F(Mx2Report, aReplyThatCameTooLateIsAWarningWithItsDelay)
{
  inverter_.link.cameLate(Ms(120));
  EXPECT_THAT(findings(), Contains(warns("a reply came 120 ms after its request")));
}

TEST_F(Mx2Report, severalPublishersAreAWarning)
{
  for (const char* const name : { "/one", "/two" })
  {
    Publisher publisher;
    publisher.name = name;
    inverter_.interlock.commanded(at(0), publisher, false, inverter_.holds());
  }
  EXPECT_THAT(findings(), Contains(warns("several publishers")));
  EXPECT_THAT(findings(60000), Not(Contains(warns("several publishers"))));
}

TEST_F(Mx2Report, valuesNameTheDriveAndHowItAnswers)
{
  wire::Reply answer = reply("");
  answer.turnaround = Ms(8);
  inverter_.link.answered(answer);
  const auto values = valuesOf(inverter_, at(0));
  EXPECT_THAT(values, Contains(Pair("node", "1")));
  EXPECT_THAT(values, Contains(Pair("drive", "omron_mx2")));
  EXPECT_THAT(values, Contains(Pair("age of status", "no status yet")));
  EXPECT_THAT(values, Contains(Pair("slowest reply", "8 ms")));
  EXPECT_THAT(values, Contains(Pair("locked", "yes")));
  EXPECT_THAT(values, Not(Contains(Pair("block read", testing::_)))) << "it has none";
}

TEST(Vfs15Report, tellsOfItsBlockReadAndWhyItIsNotUsed)
{
  const InverterConfig config = inverterConfig();
  const drive::Drive vfs15 = shipped("toshiba_vfs15");
  Inverter inverter(0, config, vfs15, 3, 1);
  EXPECT_THAT(valuesOf(inverter, at(0)), Contains(Pair("block read", "not used")));
  EXPECT_THAT(findingsOf(inverter, at(0)), Not(Contains(warns("block read"))))
      << "what the drive has selected is not known yet";
  inverter.refresh.useBlock(vfs15.chosenRead(config.block_read));
  EXPECT_THAT(valuesOf(inverter, at(0)), Contains(Pair("block read", "in use: 1, 2, 3, 4, 14")));
}

TEST_F(Mx2Report, theLogSaysWhatToDoWhenItIsOnline)
{
  EXPECT_EQ("online; locked until it is sent 0, or nothing for 500 ms", onlineText(inverter_));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

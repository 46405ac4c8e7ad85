// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/link_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::HasSubstr;

class LinkRecordTest : public testing::Test
{
protected:
  void note(wire::Outcome outcome, int times, std::uint8_t gateway_code = 0)
  {
    wire::Reply end;
    end.outcome = outcome;
    end.gateway_code = gateway_code;
    for (int time = 0; time < times; ++time)
    {
      record_.note(end);
    }
  }

  std::string text() const
  {
    return record_.text(mx2_);
  }

  const drive::Drive mx2_ = shipped("omron_mx2");
  LinkRecord record_;
};

TEST_F(LinkRecordTest, nothingAskedIsNothingToTell)
{
  EXPECT_EQ("", text());
  record_.noteLate();
  EXPECT_EQ("", text());
  note(wire::Outcome::PortLost, 3);
  EXPECT_EQ("", text()) << "a lost port is not the drive's";
}

TEST_F(LinkRecordTest, countsWhatCameMostOftenFirst)
{
  note(wire::Outcome::Timeout, 2);
  note(wire::Outcome::Damaged, 7);
  EXPECT_EQ("of 9 requests 7 damaged or foreign, 2 without a reply", text());
  EXPECT_THAT(record_.advice(), HasSubstr("parity"));
}

TEST_F(LinkRecordTest, exceptionsAreInTheDrivesOwnWords)
{
  for (int time = 0; time < 38; ++time)
  {
    record_.note(exception(0x81, 0x02));
  }
  note(wire::Outcome::Timeout, 2);
  EXPECT_THAT(text(), HasSubstr("of 40 requests 38 answered by exception 02H: "));
  EXPECT_THAT(text(), HasSubstr(", 2 without a reply"));
  EXPECT_THAT(record_.advice(), HasSubstr("profile"));
}

TEST_F(LinkRecordTest, whatAGatewaySaysIsTheGateways)
{
  note(wire::Outcome::Timeout, 4, 0x0B);
  EXPECT_EQ("of 4 requests 4 without a reply, as the gateway reports (exception 0BH)", text());
  EXPECT_THAT(record_.advice(), HasSubstr("check supply"));
}

TEST_F(LinkRecordTest, lateRepliesAskForMorePatience)
{
  note(wire::Outcome::Timeout, 4);
  record_.noteLate();
  EXPECT_EQ("of 4 requests 4 without a reply; 1 came too late", text());
  EXPECT_THAT(record_.advice(), HasSubstr("response_timeout"));
}

TEST_F(LinkRecordTest, aCompleteStatusBeginsANewRecord)
{
  note(wire::Outcome::Timeout, 4);
  record_.restart();
  EXPECT_EQ("", text());
}

TEST_F(LinkRecordTest, hundredsOfCodesMakeNoEndlessText)
{
  for (int code = 1; code < 256; ++code)
  {
    record_.note(exception(0x83, static_cast<std::uint8_t>(code)));
  }
  EXPECT_LT(text().size(), 500U);
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

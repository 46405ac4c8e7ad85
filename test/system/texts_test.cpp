// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What people read, on a whole bus in virtual time: it is true at the moment when it is read.

#include <gmock/gmock.h>

#include <limits>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

const char* const ONE_BELT = R"(
port: /dev/virtual
scan_list:
  - {name: belt, node: 1, drive: omron_mx2}
simulation:
  belt: {parameters: {F002: 1, F003: 1}}
)";

const char* const TWO_BELTS = R"(
port: /dev/virtual
scan_list:
  - {name: belt, node: 1, drive: omron_mx2}
  - {name: feed, node: 2, drive: omron_mx2}
)";

/// Leaves the belt locked, with a stream that is refused.
void lockUnderAStream(VirtualBus& bus)
{
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 5.0);
  bus.run(2.0);
  ASSERT_TRUE(bus.wait(bus.stop(0)).success);
  bus.run(1.0);
  ASSERT_EQ(bus::ERROR_LOCKED, bus.status(0).error_id);
}

TEST(Texts, aLockThatIsOverIsNotToldAsOneThatLasts)
{
  VirtualBus bus(ONE_BELT);
  lockUnderAStream(bus);
  EXPECT_TRUE(bus.status(0).locked);
  EXPECT_THAT(bus.status(0).error_text, HasSubstr("send 0"));
  // The stream ends after 5 s; silence unlocks.
  ASSERT_TRUE(bus.runUntil(10.0, [&] { return !bus.status(0).locked; }));
  EXPECT_EQ(bus::ERROR_LOCKED, bus.status(0).error_id) << "stays until the next accepted command";
  EXPECT_THAT(bus.status(0).error_text,
              AllOf(HasSubstr("was refused"), HasSubstr("unlocked now"), Not(HasSubstr("send 0"))));
  EXPECT_EQ(0U, bus.command(0, 10.0));
  bus.run(0.5);
  EXPECT_EQ(0U, bus.status(0).error_id);
  EXPECT_EQ("", bus.status(0).error_text);
}

TEST(Texts, aLockThatHoldsOneOfTwoPublishersOnlySaysSo)
{
  VirtualBus bus(ONE_BELT);
  lockUnderAStream(bus);
  bus.command(0, 0.0, "/panel");
  bus.run(0.35);
  // "/user" goes on; "/panel" has returned to neutral.
  EXPECT_FALSE(bus.status(0).locked);
  EXPECT_EQ(bus::ERROR_LOCKED, bus.status(0).error_id);
  EXPECT_THAT(bus.status(0).error_text, AllOf(HasSubstr("locked for /user"), Not(HasSubstr("unlocked now"))));
}

TEST(Texts, silenceIsShownBeforeALockThatCameEarlier)
{
  VirtualBus bus(ONE_BELT);
  lockUnderAStream(bus);
  bus.run(3.0);
  bus.world("belt offline");
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.status(0).communication_error; }));
  EXPECT_EQ(0x0205, bus.status(0).error_id);
  EXPECT_THAT(bus.status(0).error_text, AllOf(HasSubstr("no reply in time"), Not(HasSubstr("locked"))));
  bus.world("belt online");
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return !bus.status(0).communication_error && !bus.status(0).locked; }));
  EXPECT_EQ(bus::ERROR_LOCKED, bus.status(0).error_id);
  EXPECT_THAT(bus.status(0).error_text, HasSubstr("unlocked now"));
}

TEST(Texts, aCommandToAnOfflineInverterIsRefusedWithTheReasonOfTheSilence)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.world("belt offline");
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.status(0).communication_error; }));
  EXPECT_EQ(bus::ERROR_OFFLINE, bus.command(0, 10.0));
  bus.run(1.5);
  EXPECT_EQ(bus::ERROR_OFFLINE, bus.status(0).error_id);
  EXPECT_THAT(bus.status(0).error_text, AllOf(HasSubstr("is offline"), HasSubstr("no reply in time")));
  bus.world("belt online");
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return !bus.status(0).communication_error; }));
  EXPECT_EQ(bus::ERROR_OFFLINE, bus.status(0).error_id);
  EXPECT_THAT(bus.status(0).error_text, AllOf(HasSubstr("was offline"), HasSubstr("answers again")));
}

TEST(Texts, aWrongInputIsShownAlsoWhileTheInverterIsOffline)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.world("belt offline");
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.status(0).communication_error; }));
  EXPECT_EQ(bus::ERROR_OUT_OF_RANGE, bus.command(0, std::numeric_limits<double>::quiet_NaN()));
  bus.run(1.5);
  EXPECT_EQ(bus::ERROR_OUT_OF_RANGE, bus.status(0).error_id);
}

TEST(Texts, aMemberOfARefusedGroupIsToldThatAnotherOneWasTheReason)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn();
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.hasStatus(0) && !bus.status(0).locked; }));
  EXPECT_EQ(0U, bus.command(0, 5.0));
  ASSERT_TRUE(bus.wait(bus.stop(1)).success);
  EXPECT_EQ(bus::ERROR_LOCKED, bus.group({ { 0, 10.0 }, { 1, 10.0 } }));
  bus.run(0.2);
  EXPECT_FALSE(bus.status(0).locked);
  EXPECT_EQ(bus::ERROR_LOCKED, bus.status(0).error_id);
  EXPECT_THAT(bus.status(0).error_text, AllOf(HasSubstr("one of its inverters was locked"), Not(HasSubstr("send 0"))));
  EXPECT_THAT(bus.status(1).error_text, HasSubstr("send 0"));
}

TEST(Texts, aLiveMemberOfAGroupIsNotToldOfAnothersSilenceAsItsOwn)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn();
  bus.world("feed offline");
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.status(1).communication_error; }));
  ASSERT_TRUE(bus.wait(bus.stop(0)).success);
  // Locked itself, which counts less than the other one's silence.
  EXPECT_EQ(bus::ERROR_OFFLINE, bus.group({ { 0, 10.0 }, { 1, 10.0 } }));
  ASSERT_TRUE(bus.runUntil(0.4, [&] { return bus.status(0).error_id != 0; }));
  EXPECT_EQ(bus::ERROR_OFFLINE, bus.status(0).error_id);
  EXPECT_THAT(bus.status(0).error_text, AllOf(HasSubstr("the group was refused: one of its inverters was offline"),
                                              HasSubstr("send 0"), Not(HasSubstr("answers again"))));
  bus.run(1.5);
  EXPECT_EQ("the group was refused: one of its inverters was offline", bus.status(0).error_text) << "it is free";
  EXPECT_THAT(bus.status(1).error_text, HasSubstr("the inverter is offline: no reply in time"));
}

TEST(Texts, aTripIsToBeResetBeforeAnythingElseHelps)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 60.0);
  bus.run(2.0);
  bus.world("belt trip 7");
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.status(0).locked && !bus.status(0).stop_active; }));
  bus.run(1.0);
  EXPECT_EQ(bus::ERROR_LOCKED, bus.status(0).error_id);
  EXPECT_THAT(bus.status(0).error_text, AllOf(HasSubstr("tripped"), HasSubstr("call reset, then send 0")));
  EXPECT_THAT(bus.logTexts(), ::testing::Contains(AllOf(HasSubstr("refused"), HasSubstr("call reset, then send 0"))));
  ASSERT_TRUE(bus.wait(bus.reset(0)).success);
  bus.run(1.0);
  EXPECT_THAT(bus.status(0).error_text, AllOf(HasSubstr("send 0"), Not(HasSubstr("reset")), Not(HasSubstr("tripped"))));
  bus.command(0, 0.0);
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.status(0).monitor.running.value_or(false); }));
}

TEST(Texts, whoComesOnlineSaysWhatHasToBeDoneBeforeItMoves)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  EXPECT_THAT(bus.logTexts(),
              ::testing::Contains(HasSubstr("belt: online; locked until it is sent 0, or nothing for 500 ms")));
}

TEST(Texts, offlineSaysWhatCameInsteadOfAStatus)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.world("belt offline");
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.status(0).communication_error; }));
  bus.run(3.0);
  EXPECT_THAT(bus.findings(0), AllOf(HasSubstr("0x0205 no reply in time"), HasSubstr("without a reply"),
                                     HasSubstr("last answer "), HasSubstr("check supply")));
}

TEST(Texts, aDriveThatRefusesEveryReadIsNotSaidToBeSilent)
{
  VirtualBus bus(ONE_BELT);
  bus.world("belt exception 2 count 100000");
  bus.run(3.0);
  EXPECT_THAT(bus.findings(0), AllOf(HasSubstr("exception 02H"), HasSubstr("profile"), Not(HasSubstr("not answered"))));
  EXPECT_THAT(bus.findings(0), Not(HasSubstr("without a reply")));
}

TEST(Texts, numbersAreWrittenAsPeopleWriteThem)
{
  VirtualBus bus(ONE_BELT);
  bus.settleIn();
  bus.world("belt late 3.81 count 1");
  bus.run(20.0);
  EXPECT_THAT(bus.diagnostics(0), Not(AnyOf(HasSubstr("e+0"), HasSubstr("e-0"), HasSubstr("00000"))));
}
}  // namespace
}  // namespace inverter_bus

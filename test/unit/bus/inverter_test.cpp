// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What the words of one inverter mean together (contract, section 4).

#include "bus/inverter/inverter.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/link/own_exceptions.h"
#include "bus/report/inverter_report.h"
#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
class Mx2Inverter : public testing::Test
{
protected:
  /// One refresh with these coils; the registers say 0 Hz, 0 A, stopped, the newest trip is E12.
  Judgement status(const std::string& coils)
  {
    bool more = true;
    while (more)
    {
      const drive::ReadBlock& block = inverter_.refresh.next(at(time_));
      const std::string request = printed(mx2_.read(1, block));
      const int sent_at = time_;
      time_ += 10;
      more = inverter_.refresh.received(reply(answerTo(request, coils), at(time_), at(sent_at)));
    }
    EXPECT_TRUE(inverter_.refresh.takeComplete());
    return inverter_.statusComplete(at(time_));
  }

  /// One refresh in which the drive refuses every read: busy.
  Judgement busyStatus()
  {
    bool more = true;
    for (int reads = 0; more && reads < 100; ++reads)
    {
      const drive::ReadBlock& block = inverter_.refresh.next(at(time_));
      const std::uint8_t function = block.space == drive::Space::Coil ? 0x81 : 0x83;
      time_ += 10;
      more = inverter_.refresh.refused(exception(function, 0x06, at(time_)));
    }
    return inverter_.statusComplete(at(time_));
  }

  static std::string answerTo(const std::string& request, const std::string& coils)
  {
    if (request == "01 01 00 00 00 18")
    {
      return coils;
    }
    if (request == "01 03 10 00 00 04")
    {
      return "03 08 00 00 00 00 00 00 00 00";
    }
    if (request == "01 03 10 0F 00 0A")
    {
      return "03 14 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00";
    }
    return "03 02 00 0C";
  }

  /// A velocity whose words the drive has confirmed.
  void run(double velocity)
  {
    inverter_.movement.aim(inverter_.movement.judge(velocity).target);
    for (auto write = inverter_.movement.next(); write; write = inverter_.movement.next())
    {
      inverter_.movement.sent(*write);
      inverter_.movement.confirmed(*write, at(time_));
    }
  }

  static drive::Monitor turning()
  {
    drive::Monitor words;
    words.run_seen = true;
    words.running = true;
    words.output_frequency = 20.0;
    return words;
  }

  const InverterConfig config_ = inverterConfig();
  const drive::Drive mx2_ = shipped("omron_mx2");
  Inverter inverter_{ 0, config_, mx2_, 3, 1 };
  int time_ = 0;
};

const std::string AT_REST = "01 03 00 00 01";
const std::string TRIPPED = "01 03 00 00 81";
const std::string LEFTOVER_RUN = "01 03 01 40 05";

TEST_F(Mx2Inverter, newTripAsksForAStopAtOnceAndOnce)
{
  status(AT_REST);
  const Judgement judgement = status(TRIPPED);
  EXPECT_TRUE(judgement.tripped);
  EXPECT_THAT(judgement.stop_reason, testing::HasSubstr("E12"));
  EXPECT_TRUE(inverter_.interlock.isFaulted());
  EXPECT_FALSE(status(TRIPPED).tripped);
}

TEST_F(Mx2Inverter, leftoverRunAtTheFirstStatusIsCleared)
{
  EXPECT_FALSE(status(LEFTOVER_RUN).stop_reason.empty());
}

TEST_F(Mx2Inverter, driveAtRestGivesNoReasonToStop)
{
  EXPECT_TRUE(status(AT_REST).stop_reason.empty());
  EXPECT_TRUE(status(AT_REST).stop_reason.empty());
}

TEST_F(Mx2Inverter, statusThatCannotTellOfTheTripDoesNotLiftTheLock)
{
  status(AT_REST);
  status(TRIPPED);
  ASSERT_TRUE(inverter_.interlock.isFaulted());
  busyStatus();
  EXPECT_TRUE(inverter_.interlock.isFaulted()) << "not known is not healthy";
}

TEST_F(Mx2Inverter, driveThatWasBusyForAMomentIsReadInFullAgainAfterwards)
{
  status(AT_REST);
  busyStatus();
  time_ += 1000;
  std::string request;
  for (int reads = 0; reads < 6 && request != "01 01 00 00 00 18"; ++reads)
  {
    const drive::ReadBlock& block = inverter_.refresh.next(at(time_));
    request = printed(mx2_.read(1, block));
    inverter_.refresh.failed();
  }
  EXPECT_EQ(request.substr(0, 5), "01 01") << "run and alarm bits stay unread for half a minute";
}

TEST_F(Mx2Inverter, aCompleteStatusMakesItKnownAndBringsItBack)
{
  status(AT_REST);
  EXPECT_TRUE(inverter_.link.known());
  inverter_.goOffline(wire::ERROR_TIMEOUT);
  EXPECT_FALSE(inverter_.link.known());
  EXPECT_TRUE(inverter_.interlock.isOffline());
  status(AT_REST);
  EXPECT_TRUE(inverter_.link.known());
  EXPECT_FALSE(inverter_.interlock.isOffline());
  EXPECT_EQ(1U, inverter_.link.returns());
}

TEST_F(Mx2Inverter, goesOfflineAfterSoManyLostReadsAndForgetsWhatItHasTold)
{
  status(AT_REST);
  run(20.0);
  inverter_.services.resetBegun();
  inverter_.services.setupOpened();
  EXPECT_FALSE(inverter_.failed(at(time_), wire::ERROR_TIMEOUT));
  EXPECT_FALSE(inverter_.failed(at(time_), wire::ERROR_TIMEOUT));
  EXPECT_TRUE(inverter_.failed(at(time_), wire::ERROR_TIMEOUT));
  EXPECT_FALSE(inverter_.failed(at(time_), wire::ERROR_TIMEOUT)) << "it is no news any more";
  EXPECT_FALSE(inverter_.movement.target()) << "nothing is sent again when it is back";
  EXPECT_TRUE(inverter_.movement.runPossible()) << "nobody has seen it stop";
  EXPECT_FALSE(inverter_.services.resetting());
  EXPECT_FALSE(inverter_.holds().in_setup);
  EXPECT_FALSE(inverter_.refresh.fresh().monitor.run_seen);
}

TEST_F(Mx2Inverter, expectedSilenceDoesNotTakeItOffline)
{
  status(AT_REST);
  inverter_.liveness.deafUntil(at(time_ + 1000));
  for (int lost = 0; lost < 5; ++lost)
  {
    EXPECT_FALSE(inverter_.failed(at(time_), wire::ERROR_TIMEOUT));
  }
  EXPECT_EQ(0, inverter_.link.error());
}

TEST_F(Mx2Inverter, refusedRunWordsTakeItOfflineTooButWhatItIsNeedNotBeAskedAgain)
{
  status(AT_REST);
  EXPECT_FALSE(inverter_.refusedStatus(0x8102));
  EXPECT_FALSE(inverter_.refusedStatus(0x8102));
  EXPECT_TRUE(inverter_.refusedStatus(0x8102));
  EXPECT_TRUE(inverter_.link.offline());
  EXPECT_FALSE(inverter_.refusedStatus(0x8102));
}

TEST_F(Mx2Inverter, comesToRestForMovementAndWatchdog)
{
  status(AT_REST);
  run(20.0);
  Publisher publisher;
  publisher.name = "/user";
  inverter_.interlock.commanded(at(time_), publisher, true, inverter_.holds());
  ASSERT_TRUE(inverter_.mayRun());
  inverter_.cameToRest(at(time_));
  EXPECT_FALSE(inverter_.mayRun());
  EXPECT_FALSE(inverter_.interlock.watchdogDue(at(time_ + 600000))) << "nothing is left to watch";
}

TEST_F(Mx2Inverter, repeatsNoWordsWhileAStopOrATripIsPending)
{
  status(AT_REST);
  run(20.0);
  time_ += 10;
  inverter_.evidence.statusRead(turning(), reply("", at(time_), at(time_)), inverter_.movement);
  EXPECT_TRUE(inverter_.mayRepeatWords(at(time_)));
  inverter_.interlock.faulted(true);
  EXPECT_FALSE(inverter_.mayRepeatWords(at(time_)));
  inverter_.interlock.faulted(false);
  inverter_.stop.request(at(time_), StopMode::Decelerate);
  EXPECT_FALSE(inverter_.mayRepeatWords(at(time_)));
}

TEST_F(Mx2Inverter, namesWhatStandsInTheWayOfAVelocity)
{
  status(AT_REST);
  EXPECT_FALSE(inverter_.obstacles(at(0)).tripped);
  inverter_.services.setupOpened();
  EXPECT_TRUE(inverter_.obstacles(at(0)).in_setup);
  status(TRIPPED);
  EXPECT_TRUE(inverter_.obstacles(at(0)).tripped);
  inverter_.goOffline(wire::ERROR_TIMEOUT);
  EXPECT_TRUE(inverter_.obstacles(at(0)).offline);
}

/// An MX2 behind a Modbus TCP gateway.
class Mx2BehindAGateway : public testing::Test
{
protected:
  static InverterConfig config()
  {
    InverterConfig config = inverterConfig();
    config.modbus_tcp = true;
    return config;
  }

  bool isOwn(unsigned code) const
  {
    return inverter_.prepared(wire::Request()).own_exceptions[code];
  }

  const InverterConfig config_ = config();
  drive::Drive mx2_ = shipped("omron_mx2");
  Inverter inverter_{ 0, config_, mx2_, 3, 1 };
};

TEST_F(Mx2BehindAGateway, whatItsProfileListsIsItsOwnAndAllElseTheGateways)
{
  for (unsigned code = 1; code < 256; ++code)
  {
    const bool listed = code <= 3 || (code >= 0x21 && code <= 0x23) || code == 0x31 || code == 0x32;
    EXPECT_EQ(listed, isOwn(code)) << code;
  }
}

/// Frames at connect of a VF-S15 whose parameters are all 0.
std::string connectFunctions(const InverterConfig& config)
{
  const drive::Drive drive = shipped("toshiba_vfs15");
  Inverter inverter(0, config, drive, 3, 1);
  std::string functions;
  for (int frame = 0; frame < 50 && inverter.connectDue(at(1)); ++frame)
  {
    const wire::Request request = inverter.settings.next();
    functions += std::to_string(request.pdu[0]) + " ";
    wire::Reply reply;
    reply.outcome = wire::Outcome::Ok;
    const std::uint8_t identity = request.pdu[1] == 0xFB && request.pdu[2] == 0x07 ? 224 : 0;
    reply.pdu = request.pdu[0] == 3 ? wire::Bytes{ 3, 2, 0, identity } : request.pdu;
    reply.finished_at = at(0);
    inverter.settings.done(reply);
  }
  return functions;
}

TEST(AnOwnPort, isNotWrittenToBeforeItsFirstStatus)
{
  InverterConfig config = inverterConfig();
  EXPECT_THAT(connectFunctions(config), testing::HasSubstr("6 ")) << "on a serial line the driver sets its marker";
  config.modbus_tcp = true;
  config.node = 255;
  EXPECT_THAT(connectFunctions(config), testing::Not(testing::HasSubstr("6 ")));
}

TEST(Mx2OnAWire, isAskedNothingOfTheKind)
{
  const InverterConfig config = inverterConfig();
  const drive::Drive mx2 = shipped("omron_mx2");
  const Inverter inverter(0, config, mx2, 3, 1);
  EXPECT_EQ(wire::everyExceptionOfADrive(), inverter.prepared(wire::Request()).own_exceptions);
}

TEST_F(Mx2BehindAGateway, theGatewaysCodeIsShown)
{
  wire::Reply reply = lost();
  reply.gateway_code = 0xE0;
  for (int i = 0; i < 3; ++i)
  {
    inverter_.noteExchange(reply);
    inverter_.failed(at(0), reply.error_id);
  }
  EXPECT_EQ("no reply in time (the gateway answered with exception E0H)", statusOf(inverter_, at(0)).error_text);
  inverter_.noteExchange(lost());
  inverter_.failed(at(0), 0x0205);
  EXPECT_EQ("no reply in time", statusOf(inverter_, at(0)).error_text);
}

TEST(Vfs11BehindAGateway, refusesWith04OnlyWhileItSendsData)
{
  InverterConfig config = inverterConfig();
  config.modbus_tcp = true;
  const drive::Drive vfs11 = shipped("toshiba_vfs11");
  Inverter inverter(0, config, vfs11, 3, 1);
  const auto own = [&inverter] { return inverter.prepared(wire::Request()).own_exceptions[4]; };
  EXPECT_FALSE(own()) << "it has never sent any";
  inverter.refresh.next(at(0));
  const wire::Reply data = reply("03 02 00 00", at(10), at(0));
  inverter.noteExchange(data);
  inverter.noteStatus(data, true);
  EXPECT_TRUE(own());
  inverter.noteExchange(exception(0x86, 4));
  inverter.noteExchange(lost());
  EXPECT_TRUE(own());
  inverter.noteExchange(exception(0x86, 4));
  EXPECT_FALSE(own()) << "three exchanges without data";
}

TEST(OwnExceptions, commonCodesUnlessTheProfileListsOthers)
{
  const wire::ExceptionCodes common = ownExceptions({}, true);
  EXPECT_EQ(wire::ExceptionCodes().set(1).set(2).set(3), common);
  EXPECT_EQ(wire::ExceptionCodes().set(2).set(6), ownExceptions({ { 2, "" }, { 6, "" } }, true));
  EXPECT_EQ(wire::ExceptionCodes(), ownExceptions({ { 0x0A, "" }, { 0x0B, "" } }, true)) << "never a drive's";
  EXPECT_FALSE(ownExceptions({ { 4, "" } }, false)[4]);
  EXPECT_TRUE(ownExceptions({ { 4, "" } }, true)[4]);
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

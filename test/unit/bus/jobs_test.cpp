// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Services as sequences of single exchanges, compared with literal frames (without CRC).

#include "bus/activities/jobs.h"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using Progress = Job::Progress;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

const std::string READ_RUN = "01 01 00 00 00 01";
const std::string RESET_ON = "01 05 00 03 FF 00";
const std::string RESET_OFF = "01 05 00 03 00 00";
const std::string READ_STATUS = "01 01 00 00 00 18";

const wire::Reply RUN_IS_OFF = reply("01 01 00");
const wire::Reply RUN_IS_ON = reply("01 01 01");
const wire::Reply RESET_ON_DONE = reply("05 00 03 FF 00");
const wire::Reply RESET_OFF_DONE = reply("05 00 03 00 00");
const wire::Reply HEALTHY = reply("01 03 00 00 01");
const wire::Reply TRIPPED = reply("01 03 00 00 80");

/// A job and what it wants next.
template <typename AnyJob>
std::string frame(AnyJob& job)
{
  return printed(job.next());
}

// --- reset -----------------------------------------------------------------------------------------------------------

class Reset : public testing::Test
{
protected:
  const drive::Drive mx2_ = shipped("omron_mx2");
  ResetJob job_{ mx2_, 1 };
};

TEST_F(Reset, readsRunBackPulsesTheResetCoilAndReadsTheTrip)
{
  EXPECT_EQ(frame(job_), READ_RUN);
  EXPECT_EQ(job_.done(RUN_IS_OFF), Progress::GoesOn);
  EXPECT_EQ(frame(job_), RESET_ON);
  EXPECT_EQ(job_.done(RESET_ON_DONE), Progress::GoesOn);
  EXPECT_EQ(job_.pause(), Ms(100));
  EXPECT_EQ(frame(job_), RESET_OFF);
  EXPECT_EQ(job_.done(RESET_OFF_DONE), Progress::GoesOn);
  EXPECT_EQ(frame(job_), READ_STATUS);
  EXPECT_EQ(job_.done(HEALTHY), Progress::Done);
  EXPECT_TRUE(job_.answer().success);
  EXPECT_EQ(job_.answer().error_id, 0);
}

TEST_F(Reset, sendsNothingWhileRunIsOnAndAsksForAStop)
{
  ASSERT_EQ(frame(job_), READ_RUN);
  EXPECT_EQ(job_.done(RUN_IS_ON), Progress::NeedsStop);
  EXPECT_FALSE(job_.clearsWords());
  EXPECT_EQ(frame(job_), READ_RUN) << "RUN is read back again after the stop";
}

TEST_F(Reset, goesOnAfterTheStopOnceRunIsSeenOff)
{
  frame(job_);
  job_.done(RUN_IS_ON);
  frame(job_);
  EXPECT_EQ(job_.done(RUN_IS_OFF), Progress::GoesOn);
  EXPECT_EQ(frame(job_), RESET_ON);
}

TEST_F(Reset, failsWithoutSendingAnythingWhenRunStaysOn)
{
  frame(job_);
  job_.done(RUN_IS_ON);
  ASSERT_EQ(frame(job_), READ_RUN);
  EXPECT_EQ(job_.done(RUN_IS_ON), Progress::Done);
  EXPECT_FALSE(job_.answer().success);
  EXPECT_NE(job_.answer().error_id, 0);
  EXPECT_THAT(job_.answer().message, HasSubstr("RUN"));
}

TEST_F(Reset, failsWithoutSendingAnythingWhenRunCannotBeRead)
{
  frame(job_);
  EXPECT_EQ(job_.lost(lost()), Progress::Done);
  EXPECT_FALSE(job_.answer().success);
  EXPECT_EQ(job_.answer().error_id, 0x0205);
  EXPECT_FALSE(job_.clearsWords());
}

TEST_F(Reset, failsWithoutSendingAnythingWhenTheReadOfRunIsRefused)
{
  frame(job_);
  EXPECT_EQ(job_.done(exception(0x81, 0x02)), Progress::Done);
  EXPECT_FALSE(job_.answer().success);
  EXPECT_EQ(job_.answer().error_id, 0x8102);
}

TEST_F(Reset, waitsForATripThatStaysAndSaysSo)
{
  frame(job_);
  job_.done(RUN_IS_OFF);
  frame(job_);
  job_.done(RESET_ON_DONE);
  frame(job_);
  job_.done(RESET_OFF_DONE);
  frame(job_);
  EXPECT_EQ(job_.done(TRIPPED), Progress::GoesOn);
  EXPECT_GT(job_.pause(), Duration::zero());
  EXPECT_FALSE(job_.answer().success);
  EXPECT_THAT(job_.answer().message, HasSubstr("still tripped"));
  EXPECT_EQ(frame(job_), READ_STATUS);
  EXPECT_EQ(job_.done(HEALTHY), Progress::Done);
  EXPECT_TRUE(job_.answer().success);
  EXPECT_EQ(job_.answer().error_id, 0);
}

TEST_F(Reset, takesTheResetCoilBackUntilTheDriveAnswers)
{
  frame(job_);
  job_.done(RUN_IS_OFF);
  frame(job_);
  job_.done(RESET_ON_DONE);
  for (int deaf = 0; deaf < 10; ++deaf)
  {
    ASSERT_EQ(frame(job_), RESET_OFF);
    ASSERT_EQ(job_.lost(lost()), Progress::GoesOn);
    ASSERT_GT(job_.pause(), Duration::zero());
  }
  EXPECT_EQ(frame(job_), RESET_OFF);
}

TEST_F(Reset, takesTheResetCoilBackWhenTheDriveIsDeafFromTheResetOn)
{
  frame(job_);
  job_.done(RUN_IS_OFF);
  ASSERT_EQ(frame(job_), RESET_ON);
  EXPECT_EQ(job_.lost(lost()), Progress::GoesOn) << "the frame has left: the coil may be on, and nobody takes it back";
  EXPECT_TRUE(job_.clearsWords());
}

TEST_F(Reset, bearsADeafDriveWhileItReadsTheTrip)
{
  frame(job_);
  job_.done(RUN_IS_OFF);
  frame(job_);
  job_.done(RESET_ON_DONE);
  frame(job_);
  job_.done(RESET_OFF_DONE);
  frame(job_);
  EXPECT_EQ(job_.lost(lost()), Progress::GoesOn);
  EXPECT_EQ(frame(job_), READ_STATUS);
  EXPECT_EQ(job_.done(HEALTHY), Progress::Done);
  EXPECT_TRUE(job_.answer().success);
}

TEST_F(Reset, countsAsResettingFromTheFirstAcknowledgedFrame)
{
  EXPECT_FALSE(job_.clearsWords());
  frame(job_);
  job_.done(RUN_IS_OFF);
  EXPECT_FALSE(job_.clearsWords());
  frame(job_);
  job_.done(RESET_ON_DONE);
  EXPECT_TRUE(job_.clearsWords());
}

TEST_F(Reset, refusedResetIsReportedInTheDrivesWords)
{
  frame(job_);
  job_.done(RUN_IS_OFF);
  frame(job_);
  EXPECT_EQ(job_.done(exception(0x85, 0x22)), Progress::Done);
  EXPECT_FALSE(job_.answer().success);
  EXPECT_EQ(job_.answer().error_id, 0x8522);
  EXPECT_THAT(job_.answer().message, AllOf(HasSubstr("reset"), HasSubstr("22H"), HasSubstr("not allowed now")));
}

TEST(ResetJob, valueOfRunThatMeansNothingAllowsNoReset)
{
  drive::Profile profile = drive::loadProfile("omron_mx2", drive::profileDirectory());
  profile.status.erase("running");
  drive::Item& run = profile.status.at("run_seen");
  run.space = drive::Space::Register;
  run.values = { { 0, 0 }, { 1, 1 } };
  const drive::Drive drive(profile);
  ResetJob job(drive, 1);
  frame(job);
  EXPECT_NE(job.done(reply("03 02 00 07")), Progress::GoesOn) << "7 is not confirmed off";
}

TEST(ResetJob, rxReadsItsTripFromTheStatusRegister)
{
  const drive::Drive rx = shipped("omron_rx");
  ResetJob job(rx, 3);
  EXPECT_EQ(frame(job), "03 01 00 00 00 01");
  job.done(RUN_IS_OFF);
  EXPECT_EQ(frame(job), "03 05 00 03 FF 00");
  job.done(RESET_ON_DONE);
  EXPECT_EQ(frame(job), "03 05 00 03 00 00");
  job.done(RESET_OFF_DONE);
  EXPECT_EQ(frame(job), "03 03 00 03 00 01");
  EXPECT_EQ(job.done(reply("03 02 00 02")), Progress::GoesOn);
  frame(job);
  EXPECT_EQ(job.done(reply("03 02 00 00")), Progress::Done);
  EXPECT_TRUE(job.answer().success);
}

/// An RX that was reset, up to the read that shows whether the trip is gone.
class RxReset : public testing::Test
{
protected:
  RxReset()
  {
    frame(job_);
    job_.done(RUN_IS_OFF);
    frame(job_);
    job_.done(RESET_ON_DONE);
    frame(job_);
    job_.done(RESET_OFF_DONE);
    EXPECT_EQ(frame(job_), "03 03 00 03 00 01");
  }

  const drive::Drive rx_ = shipped("omron_rx");
  ResetJob job_{ rx_, 3, 7 };
};

TEST_F(RxReset, anUnknownStateThatIsGoneIsSaid)
{
  EXPECT_EQ(job_.done(reply("03 02 00 00")), Progress::Done);
  EXPECT_TRUE(job_.answer().success);
  EXPECT_EQ(job_.answer().message, "reset sent: the unknown state 7 is gone");
}

TEST_F(RxReset, anUnknownStateThatStaysIsNoSuccess)
{
  EXPECT_EQ(job_.done(reply("03 02 00 07")), Progress::GoesOn);
  EXPECT_FALSE(job_.answer().success);
  EXPECT_NE(job_.answer().error_id, 0);
  EXPECT_THAT(job_.answer().message, HasSubstr("unknown state 7"));
}

TEST_F(RxReset, aDriveThatNeverTellsItsStateIsUnknown)
{
  EXPECT_EQ(job_.done(exception(0x83, 0x02)), Progress::Done);
  EXPECT_TRUE(job_.answer().success) << "the reset itself was taken";
  EXPECT_THAT(job_.answer().message, HasSubstr("unknown"));
}

TEST_F(RxReset, oneThatIsBusyIsAskedAgain)
{
  EXPECT_EQ(job_.done(exception(0x83, 0x06)), Progress::GoesOn);
  EXPECT_FALSE(job_.answer().success);
  EXPECT_EQ(frame(job_), "03 03 00 03 00 01");
  EXPECT_EQ(job_.done(reply("03 02 00 00")), Progress::Done);
  EXPECT_TRUE(job_.answer().success);
}

// --- trip memory -----------------------------------------------------------------------------------------------------

const wire::Reply NO_TRIP = reply("03 14 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00");
/// E12 with 0 Hz, 0 A, 333.0 V as a real MX2 reported it, then 291 and 70000 hours.
const wire::Reply E12 = reply("03 14 00 0C 00 01 00 00 00 00 00 00 0D 02 00 00 01 23 00 01 11 70");
/// E07 at 50.00 Hz and 2.34 A.
const wire::Reply E07 = reply("03 14 00 07 00 03 00 00 13 88 00 EA 0F A0 00 00 00 01 00 00 00 02");

TEST(ReadFaultsJob, readsEachOfTheSixEntriesInOneExchange)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  ReadFaultsJob job(mx2, 1, false);
  for (const char* request :
       { "01 03 00 11 00 0A", "01 03 00 1B 00 0A", "01 03 00 25 00 0A", "01 03 00 2F 00 0A", "01 03 00 39 00 0A" })
  {
    EXPECT_EQ(frame(job), request);
    EXPECT_EQ(job.done(NO_TRIP), Progress::GoesOn);
  }
  EXPECT_EQ(frame(job), "01 03 00 43 00 0A");
  EXPECT_EQ(job.done(NO_TRIP), Progress::Done);
  EXPECT_TRUE(job.answer().success);
  EXPECT_THAT(job.answer().faults, IsEmpty());
}

/// The job's answer after these entries; the others are empty.
Answer readFaults(bool faulted, const std::vector<wire::Reply>& entries)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  ReadFaultsJob job(mx2, 1, faulted);
  Progress progress = Progress::GoesOn;
  for (std::size_t entry = 0; progress == Progress::GoesOn && entry < 20; ++entry)
  {
    job.next();
    progress = job.done(entry < entries.size() ? entries[entry] : NO_TRIP);
  }
  EXPECT_EQ(progress, Progress::Done);
  return job.answer();
}

TEST(ReadFaultsJob, entriesComeNewestFirstWithTheirValues)
{
  const Answer answer = readFaults(false, { E12, E07 });
  ASSERT_EQ(answer.faults.size(), 2U);
  const drive::FaultRecord& newest = answer.faults[0];
  EXPECT_EQ(newest.code, 12);
  EXPECT_THAT(newest.text, HasSubstr("E12"));
  EXPECT_DOUBLE_EQ(newest.output_frequency.value(), 0.0);
  EXPECT_DOUBLE_EQ(newest.output_current.value(), 0.0);
  EXPECT_DOUBLE_EQ(newest.dc_voltage.value(), 333.0);
  EXPECT_DOUBLE_EQ(newest.run_hours.value(), 291.0);
  EXPECT_DOUBLE_EQ(newest.power_on_hours.value(), 70000.0);
  EXPECT_EQ(answer.faults[1].code, 7);
  EXPECT_DOUBLE_EQ(answer.faults[1].output_frequency.value(), 50.0);
  EXPECT_DOUBLE_EQ(answer.faults[1].output_current.value(), 2.34);
  EXPECT_DOUBLE_EQ(answer.faults[1].dc_voltage.value(), 400.0);
}

TEST(ReadFaultsJob, newestEntryIsPresentWhileTheDriveIsTripped)
{
  EXPECT_EQ(readFaults(true, { E12, E07 }).present.code, 12);
}

TEST(ReadFaultsJob, nothingIsPresentWhileTheDriveIsHealthy)
{
  EXPECT_EQ(readFaults(false, { E12, E07 }).present.code, 0);
}

TEST(ReadFaultsJob, emptyMemoryIsASuccess)
{
  const Answer answer = readFaults(true, {});
  EXPECT_TRUE(answer.success);
  EXPECT_THAT(answer.message, HasSubstr("empty"));
}

TEST(ReadFaultsJob, lostReadFails)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  ReadFaultsJob job(mx2, 1, false);
  job.next();
  EXPECT_EQ(job.lost(lost()), Progress::Done);
  EXPECT_FALSE(job.answer().success);
  EXPECT_EQ(job.answer().error_id, 0x0205);
}

TEST(ReadFaultsJob, refusedReadFailsWithTheDrivesWords)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  ReadFaultsJob job(mx2, 1, false);
  job.next();
  EXPECT_EQ(job.done(exception(0x83, 0x02)), Progress::Done);
  EXPECT_EQ(job.answer().error_id, 0x8302);
  EXPECT_THAT(job.answer().message, HasSubstr("address not found"));
}

TEST(ReadFaultsJob, rxReadsAnEntryInPiecesOfFourRegisters)
{
  const drive::Drive rx = shipped("omron_rx");
  ReadFaultsJob job(rx, 1, false);
  EXPECT_EQ(frame(job), "01 03 00 11 00 04");
  EXPECT_EQ(job.done(reply("03 08 00 07 00 03 00 00 13 88")), Progress::GoesOn);
  // The current (0016H) needs `current_scale`; the voltage and the hours follow.
  EXPECT_EQ(frame(job), "01 03 00 16 00 03");
  EXPECT_EQ(job.done(reply("03 06 01 4D 00 00 01 23")), Progress::GoesOn);
  EXPECT_EQ(frame(job), "01 03 00 19 00 02");
}

// --- parameters ------------------------------------------------------------------------------------------------------

class Mx2Parameters : public testing::Test
{
protected:
  WriteParameterJob write(const std::string& name, std::uint32_t raw, bool persist)
  {
    return WriteParameterJob(mx2_, 1, *mx2_.findParameter(name, true), raw, persist, ram_changes_);
  }

  const drive::Drive mx2_ = shipped("omron_mx2");
  std::set<std::string> ram_changes_;
};

const std::string WRITE_F002 = "01 10 11 02 00 02 04 00 00 03 E8";
const std::string ENTER = "01 06 08 FF 00 01";
const std::string READ_BUSY = "01 01 00 48 00 01";
const wire::Reply F002_WRITTEN = reply("10 11 02 00 02");
const wire::Reply ENTERED = reply("06 08 FF 00 01");
const wire::Reply BUSY = reply("01 01 01");
const wire::Reply STORED = reply("01 01 00");

TEST_F(Mx2Parameters, readBringsValueAndUnit)
{
  ReadParameterJob job(mx2_, 1, *mx2_.findParameter("F002", false));
  EXPECT_EQ(frame(job), "01 03 11 02 00 02");
  EXPECT_EQ(job.done(reply("03 04 00 00 03 E8")), Progress::Done);
  EXPECT_TRUE(job.answer().success);
  EXPECT_DOUBLE_EQ(job.answer().value, 10.0);
  EXPECT_EQ(job.answer().unit, "s");
  EXPECT_THAT(job.answer().message, HasSubstr("F002"));
}

TEST_F(Mx2Parameters, refusedReadFailsWithTheDrivesWords)
{
  ReadParameterJob job(mx2_, 1, *mx2_.findParameter("F002", false));
  job.next();
  EXPECT_EQ(job.done(exception(0x83, 0x02)), Progress::Done);
  EXPECT_FALSE(job.answer().success);
  EXPECT_EQ(job.answer().error_id, 0x8302);
  EXPECT_THAT(job.answer().message, AllOf(HasSubstr("F002"), HasSubstr("address not found")));
}

TEST_F(Mx2Parameters, plainWriteReachesTheRamAndSaysSo)
{
  WriteParameterJob job = write("F002", 1000, false);
  EXPECT_EQ(frame(job), WRITE_F002);
  EXPECT_EQ(job.done(F002_WRITTEN), Progress::Done);
  EXPECT_TRUE(job.answer().success);
  EXPECT_THAT(job.answer().message, AllOf(HasSubstr("F002"), HasSubstr("RAM")));
  EXPECT_THAT(ram_changes_, ElementsAre("F002"));
}

TEST_F(Mx2Parameters, persistentWriteEntersAndWaitsUntilTheEepromIsDone)
{
  WriteParameterJob job = write("F002", 1000, true);
  ASSERT_EQ(frame(job), WRITE_F002);
  EXPECT_EQ(job.done(F002_WRITTEN), Progress::GoesOn);
  EXPECT_EQ(frame(job), ENTER);
  EXPECT_EQ(job.done(ENTERED), Progress::GoesOn);
  for (int poll = 0; poll < 5; ++poll)
  {
    EXPECT_GT(job.pause(), Duration::zero());
    ASSERT_EQ(frame(job), READ_BUSY);
    ASSERT_EQ(job.done(BUSY), Progress::GoesOn);
  }
  EXPECT_EQ(frame(job), READ_BUSY);
  EXPECT_EQ(job.done(STORED), Progress::Done);
  EXPECT_TRUE(job.answer().success);
}

TEST_F(Mx2Parameters, persistentWriteNamesEveryRamChangeMadeHere)
{
  ram_changes_ = { "A003", "F003" };
  WriteParameterJob job = write("F002", 1000, true);
  job.next();
  job.done(F002_WRITTEN);
  job.next();
  job.done(ENTERED);
  job.next();
  job.done(STORED);
  EXPECT_THAT(job.answer().message, AllOf(HasSubstr("A003"), HasSubstr("F002"), HasSubstr("F003")));
  EXPECT_THAT(ram_changes_, IsEmpty());
}

TEST_F(Mx2Parameters, refusedWriteStoresNothing)
{
  WriteParameterJob job = write("F002", 1000, true);
  job.next();
  EXPECT_EQ(job.done(exception(0x90, 0x21)), Progress::Done);
  EXPECT_FALSE(job.answer().success);
  EXPECT_EQ(job.answer().error_id, 0x9021);
  EXPECT_THAT(job.answer().message, AllOf(HasSubstr("F002"), HasSubstr("outside the drive's range")));
  EXPECT_THAT(ram_changes_, IsEmpty());
}

TEST_F(Mx2Parameters, refusedStoreSaysThatTheRamIsWritten)
{
  WriteParameterJob job = write("F002", 1000, true);
  job.next();
  job.done(F002_WRITTEN);
  job.next();
  EXPECT_EQ(job.done(exception(0x86, 0x22)), Progress::Done);
  EXPECT_FALSE(job.answer().success);
  EXPECT_EQ(job.answer().error_id, 0x8622);
  EXPECT_THAT(job.answer().message, AllOf(HasSubstr("RAM"), HasSubstr("not stored")));
  EXPECT_THAT(ram_changes_, UnorderedElementsAre("F002"));
}

TEST_F(Mx2Parameters, lostWriteFails)
{
  WriteParameterJob job = write("F002", 1000, false);
  job.next();
  EXPECT_EQ(job.lost(lost()), Progress::Done);
  EXPECT_FALSE(job.answer().success);
  EXPECT_EQ(job.answer().error_id, 0x0205);
}

TEST(WriteParameterJob, writeThatReachesTheEepromSaysSo)
{
  drive::Profile profile = drive::loadProfile("omron_mx2", drive::profileDirectory());
  profile.writes = drive::Writes::Eeprom;
  const drive::Drive drive(profile);
  std::set<std::string> ram_changes;
  WriteParameterJob job(drive, 1, *drive.findParameter("F002", true), 1000, true, ram_changes);
  EXPECT_EQ(frame(job), WRITE_F002);
  EXPECT_EQ(job.done(F002_WRITTEN), Progress::Done);
  EXPECT_THAT(job.answer().message, AllOf(HasSubstr("EEPROM"), Not(HasSubstr("RAM"))));
  EXPECT_THAT(ram_changes, IsEmpty());
}

TEST(WriteParameterJob, rxKeepsThePauseOfItsProfileAfterTheStore)
{
  const drive::Drive rx = shipped("omron_rx");
  std::set<std::string> ram_changes;
  WriteParameterJob job(rx, 1, *rx.findParameter("F002", true), 1000, true, ram_changes);
  job.next();
  job.done(F002_WRITTEN);
  ASSERT_EQ(frame(job), ENTER);
  job.done(ENTERED);
  // store: [{enter: 1, pause: 0.5}], since the RX has no confirmed busy flag.
  EXPECT_EQ(job.pause(), Ms(500));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

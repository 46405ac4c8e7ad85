// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Which slow reads go with a refresh (contract, 3.10 and 4.1).

#include "bus/inverter/slow_turns.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::ElementsAre;
using testing::IsEmpty;

class Turns : public testing::Test
{
protected:
  Turns()
  {
    drive::Monitor run;
    run.run_seen = false;
    turns_.noteRun(run, true);
  }

  /// The first fields of the reads that go with a refresh at \p time_ms, which are answered at once.
  std::vector<std::string> take(int time_ms, bool first = false)
  {
    std::vector<std::string> fields;
    for (const std::size_t index : turns_.take(reads_, at(time_ms), first, leave_))
    {
      fields.push_back(reads_[index].block.fields.front());
      reads_[index].ever = true;
      reads_[index].last = at(time_ms);
    }
    return fields;
  }

  const drive::Drive vfs15_ = shipped("toshiba_vfs15");
  StatusReads reads_{ vfs15_ };
  SlowLeave leave_;
  SlowTurns turns_;
};

TEST_F(Turns, firstRefreshIsShort)
{
  EXPECT_THAT(take(0, true), IsEmpty());
}

TEST_F(Turns, oneThatIsSlowedGoesBesideOneThatNeverIs)
{
  EXPECT_THAT(take(0), ElementsAre("run_seen", testing::_));
  EXPECT_THAT(take(10), ElementsAre("restarted", testing::_));
  EXPECT_THAT(take(20), ElementsAre(testing::_));
  EXPECT_THAT(take(30), IsEmpty());
}

TEST_F(Turns, thoseThatAreNeverSlowedComeOnceASecondWhateverTheShareIs)
{
  leave_.open = false;
  EXPECT_THAT(take(0), ElementsAre("run_seen"));
  EXPECT_THAT(take(10), ElementsAre("restarted"));
  EXPECT_THAT(take(899), IsEmpty());
  EXPECT_THAT(take(900), ElementsAre("run_seen"));
  EXPECT_THAT(take(910), ElementsAre("restarted"));
}

TEST_F(Turns, thoseThatAreSlowedComeOnceInTheirPeriod)
{
  leave_.period = Ms(5000);
  take(0);
  take(10);
  take(20);
  EXPECT_THAT(take(4999), ElementsAre("run_seen"));
  EXPECT_THAT(take(5000), ElementsAre("restarted", testing::_));
}

TEST_F(Turns, bothGoFirstOnceEach)
{
  turns_.askForRun();
  turns_.suspectRestart();
  EXPECT_THAT(take(0), ElementsAre("run_seen", "restarted"));
}

TEST_F(Turns, warningGoesBeforeOtherSlowValuesOnce)
{
  const auto warning = [this] { return turns_.asksForWarning(reads_, at(0)); };
  leave_.period = Ms(60000);
  take(0);
  take(10);
  take(20);
  EXPECT_FALSE(warning());
  turns_.askForWarning();
  EXPECT_TRUE(warning());
  StatusRead read;
  read.block.fields = { "torque" };
  turns_.noteWarning(read);
  EXPECT_TRUE(warning());
  EXPECT_EQ(take(30).size(), 1U);
  read.block.fields = { "overload_warning", "warning_code" };
  turns_.noteWarning(read);
  EXPECT_FALSE(warning());
}

TEST_F(Turns, thoseThatAreLeftOutAreNotTaken)
{
  for (std::size_t index = 0; index < reads_.size(); ++index)
  {
    reads_[index].left_out_until = at(1000);
  }
  EXPECT_THAT(take(999), IsEmpty());
  EXPECT_EQ(take(1000).size(), 2U);
}

TEST_F(Turns, ourRunIsAskedForBeforeEverythingElse)
{
  ASSERT_THAT(take(0), testing::Contains("run_seen"));
  turns_.askForRun();
  EXPECT_THAT(take(10), ElementsAre("run_seen"));
  EXPECT_THAT(take(20, true), ElementsAre("run_seen")) << "in the first refresh, too, and until it was told";
  drive::Monitor told;
  told.run_seen = true;
  turns_.noteRun(told, true);
  EXPECT_THAT(take(30), testing::Contains("restarted"));
}

TEST_F(Turns, driveThatCannotTellRunIsNotAskedForIt)
{
  turns_.forget();
  turns_.noteRun(drive::Monitor(), false);
  EXPECT_THAT(take(0, true), IsEmpty());
}

TEST_F(Turns, restartThatIsSuspectedIsAskedForFirst)
{
  turns_.suspectRestart();
  EXPECT_THAT(take(0), ElementsAre("restarted"));
  drive::Monitor other;
  other.run_seen = true;
  turns_.noteRestart(other);
  EXPECT_THAT(take(10), ElementsAre("restarted"));
  drive::Monitor told;
  told.restarted = false;
  turns_.noteRestart(told);
  EXPECT_THAT(take(20), testing::Not(testing::Contains("restarted")));
}

TEST_F(Turns, afterAReturnOurRunIsAskedForAgainButARestartIsNotSuspected)
{
  turns_.suspectRestart();
  turns_.forget();
  EXPECT_THAT(take(0, true), ElementsAre("run_seen"));
}

TEST_F(Turns, onlyTheFirstWordOfALeftoverRunIsWaitedFor)
{
  StatusRead run;
  run.block.fields = { "run_seen" };
  StatusRead voltage;
  voltage.block.fields = { "output_voltage" };
  EXPECT_FALSE(turns_.waitedFor(run));
  turns_.askForRun();
  EXPECT_TRUE(turns_.waitedFor(run));
  EXPECT_FALSE(turns_.waitedFor(voltage));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

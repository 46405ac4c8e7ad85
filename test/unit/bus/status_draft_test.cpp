// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What a refresh under way has told (contract, section 2, 4.1 and 8.15).

#include "bus/inverter/status_draft.h"

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
using Kind = StatusRead::Kind;

StatusRead read(Kind kind, const std::string& field)
{
  StatusRead read;
  read.kind = kind;
  read.block.fields = { field };
  return read;
}

class Draft : public testing::Test
{
protected:
  Draft()
  {
    draft_.restart();
    running_.values.running = true;
    voltage_.values.output_voltage = 230.0;
    run_.values.run_seen = true;
    restarted_.values.restarted = true;
  }

  StatusDraft draft_;
  StatusRead running_ = read(Kind::Fast, "running");
  StatusRead voltage_ = read(Kind::Slow, "output_voltage");
  StatusRead run_ = read(Kind::Slow, "run_seen");
  StatusRead restarted_ = read(Kind::Slow, "restarted");
};

TEST_F(Draft, fastValuesAreItsOwnAndSlowOnesAreNot)
{
  draft_.take(voltage_, reply("03 02 00 00"));
  draft_.take(running_, reply("03 02 00 00"));
  EXPECT_EQ(draft_.words().monitor.running, true);
  EXPECT_FALSE(draft_.words().monitor.output_voltage);
}

TEST_F(Draft, whatDecidesOverSafetyCountsThoughItIsSlow)
{
  draft_.take(run_, reply("03 02 00 00"));
  draft_.take(restarted_, reply("03 02 00 00"));
  EXPECT_EQ(draft_.words().monitor.run_seen, true);
  EXPECT_EQ(draft_.words().monitor.restarted, true);
  draft_.restartNoted();
  EXPECT_FALSE(draft_.words().monitor.restarted);
}

TEST_F(Draft, runWordsAreAsOldAsTheirOldestRequest)
{
  EXPECT_EQ(draft_.words().sent_at, TimePoint::max());
  draft_.take(voltage_, reply("03 02 00 00", at(10), at(0)));
  EXPECT_EQ(draft_.words().sent_at, TimePoint::max());
  draft_.take(run_, reply("03 02 00 00", at(30), at(20)));
  draft_.take(running_, reply("03 02 00 00", at(50), at(40)));
  EXPECT_EQ(draft_.words().sent_at, at(20));
}

TEST_F(Draft, stampIsTheArrivalOfTheLastFastReply)
{
  draft_.take(running_, reply("03 02 00 00", at(10)));
  draft_.take(voltage_, reply("03 02 00 00", at(20)));
  EXPECT_EQ(draft_.stamp(), at(10));
  draft_.heard(at(30));
  EXPECT_EQ(draft_.stamp(), at(30));
}

TEST_F(Draft, sufficesOnceItTellsWhetherTheMotorRuns)
{
  EXPECT_FALSE(draft_.suffices(false));
  draft_.heard(at(10));
  EXPECT_TRUE(draft_.suffices(false));
  EXPECT_FALSE(draft_.suffices(true));
  draft_.take(running_, reply("03 02 00 00", at(20)));
  EXPECT_TRUE(draft_.suffices(true));
  draft_.restart();
  EXPECT_FALSE(draft_.suffices(false));
}

TEST_F(Draft, reasonOfATripIsDueOnce)
{
  EXPECT_FALSE(draft_.takeFaultDue());
  StatusRead tripped = read(Kind::Fast, "faulted");
  tripped.values.faulted = true;
  draft_.take(tripped, reply("03 02 00 00"));
  EXPECT_TRUE(draft_.takeFaultDue());
  EXPECT_FALSE(draft_.takeFaultDue());
  draft_.restart();
  draft_.take(tripped, reply("03 02 00 00"));
  EXPECT_TRUE(draft_.takeFaultDue());
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Whether a drive brings the words that its user chose (contract, 3.10).

#include "bus/inverter/chosen_block.h"

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
using testing::IsEmpty;

class Vfs15Block : public testing::Test
{
protected:
  Vfs15Block()
  {
    block_.use(vfs15_.chosenRead({ 1, 2, 3, 4, 14 }));
    direct_.raw_status = 0x4000;
  }

  /// A reply whose first word, FD01, is \p status.
  bool received(const std::string& status)
  {
    return block_.received(reply("03 0A " + status + " 13 88 00 64 00 00 00 00"), drive::Ratings(), direct_);
  }

  const drive::Drive vfs15_ = shipped("toshiba_vfs15");
  ChosenBlock block_{ vfs15_ };
  drive::Monitor direct_;
};

TEST_F(Vfs15Block, usingTheSameAgainChangesNothing)
{
  EXPECT_FALSE(block_.use(vfs15_.chosenRead({ 1, 2, 3, 4, 14 })));
  EXPECT_TRUE(block_.use(vfs15_.chosenRead({ 1, 2, 3, 14, 4 })));
  EXPECT_TRUE(block_.use(std::nullopt));
  EXPECT_FALSE(block_.use(std::nullopt));
  EXPECT_FALSE(block_.read());
}

TEST_F(Vfs15Block, firstReplyMustHaveTheStatusOfTheDirectRead)
{
  EXPECT_FALSE(received("44 00"));
  EXPECT_TRUE(received("40 00"));
  EXPECT_TRUE(received("44 00")) << "once it is proven the status may change";
}

TEST_F(Vfs15Block, whatADirectReadHasNotToldProvesNothingAgainstIt)
{
  direct_ = drive::Monitor();
  EXPECT_TRUE(received("44 00"));
}

TEST_F(Vfs15Block, oneRefusalForGoodOrTwoForTheMomentAreTooMany)
{
  EXPECT_TRUE(block_.refused(true));
  block_.use(std::nullopt);
  block_.use(vfs15_.chosenRead({ 1, 2, 3, 4, 14 }));
  EXPECT_FALSE(block_.refused(false));
  ASSERT_TRUE(received("40 00"));
  EXPECT_FALSE(block_.refused(false)) << "in a row";
  EXPECT_TRUE(block_.refused(false));
}

TEST_F(Vfs15Block, dropIsToldOnce)
{
  EXPECT_FALSE(block_.takeRefusal());
  block_.drop();
  EXPECT_FALSE(block_.read());
  EXPECT_TRUE(block_.takeRefusal());
  EXPECT_FALSE(block_.takeRefusal());
}

TEST_F(Vfs15Block, wordsWithoutAFieldAreShownByTheirTitleWhileItIsInUse)
{
  block_.use(vfs15_.chosenRead({ 1, 2, 3, 4, 8 }));
  ASSERT_TRUE(received("40 00"));
  EXPECT_EQ(block_.values().size(), 1U);
  block_.forget();
  EXPECT_THAT(block_.values(), IsEmpty());
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

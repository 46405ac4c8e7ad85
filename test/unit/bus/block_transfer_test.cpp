// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Block read and block write are used while the drive has selected exactly what is configured (contract, 3.10).

#include "bus/inverter/block_transfer.h"

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
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

class Vfs15BlockTransfer : public testing::Test
{
protected:
  static InverterConfig config(bool configure_block)
  {
    InverterConfig config = inverterConfig();
    config.configure_block = configure_block;
    return config;
  }

  const drive::Drive vfs15_ = shipped("toshiba_vfs15");
  const InverterConfig config_ = config(false);
  const InverterConfig configuring_ = config(true);
  const BlockSlots fitting_{ { 1, 2, 3, 4, 14 }, { 1, 3 } };
  const BlockSlots as_delivered_{ { 0, 0, 0, 0, 0 }, { 0, 0 } };
  BlockTransfer block_{ vfs15_, config_ };
};

TEST_F(Vfs15BlockTransfer, isUsedWithExactlyTheConfiguredWords)
{
  EXPECT_TRUE(block_.fits(fitting_));
  const auto read = block_.read(fitting_);
  ASSERT_TRUE(read);
  EXPECT_EQ("01 03 18 75 00 05", printed(vfs15_.read(1, *read)));
  EXPECT_FALSE(block_.fits(as_delivered_));
  EXPECT_FALSE(block_.read(as_delivered_));
}

TEST_F(Vfs15BlockTransfer, isNotUsedInAnotherOrderNorBeforeAllIsKnown)
{
  EXPECT_FALSE(block_.fits(BlockSlots{ { 2, 1, 3, 4, 14 }, { 1, 3 } }));
  EXPECT_FALSE(block_.fits(BlockSlots{ { 1, 2, 3, 4, 14 }, { 3, 1 } }));
  EXPECT_FALSE(block_.read(std::nullopt));
}

TEST_F(Vfs15BlockTransfer, isNotUsedAfterItWasDroppedUntilTheDriveHasComeBack)
{
  block_.drop("the drive refuses it");
  EXPECT_TRUE(block_.fits(fitting_));
  EXPECT_FALSE(block_.read(fitting_));
  EXPECT_EQ("block read and write are not used: the drive refuses it", block_.whyNot(fitting_));
  block_.tryAgain();
  EXPECT_TRUE(block_.read(fitting_));
}

TEST_F(Vfs15BlockTransfer, saysWhatTheDriveHasSelectedInstead)
{
  EXPECT_THAT(block_.whyNot(as_delivered_), HasSubstr("0, 0 and 0, 0, 0, 0, 0 instead of 1, 3 and 1, 2, 3, 4, 14"));
  EXPECT_THAT(block_.whyNot(fitting_), HasSubstr("switch the drive off and on"));
}

TEST_F(Vfs15BlockTransfer, writesNothingUnlessTheUserWantsIt)
{
  EXPECT_THAT(block_.takeWrites(as_delivered_), IsEmpty());
}

TEST_F(Vfs15BlockTransfer, writesWhatDiffersAndOnlyOnce)
{
  BlockTransfer block(vfs15_, configuring_);
  EXPECT_THAT(block.takeWrites(std::nullopt), IsEmpty()) << "what is selected is not known yet";
  EXPECT_THAT(block.takeWrites(BlockSlots{ { 1, 2, 3, 4, 0 }, { 1, 0 } }),
              ElementsAre(Pair("F871", 3), Pair("F879", 14), Pair("F899", 1)));
  EXPECT_THAT(block.takeWrites(as_delivered_), IsEmpty()) << "each write wears the EEPROM";
}

TEST_F(Vfs15BlockTransfer, writesNothingWhereAllFits)
{
  BlockTransfer block(vfs15_, configuring_);
  EXPECT_THAT(block.takeWrites(fitting_), IsEmpty());
  EXPECT_FALSE(block.takeWrites(as_delivered_).empty()) << "that was no attempt";
}

TEST_F(Vfs15BlockTransfer, knowsTheParametersThatSelectItsWords)
{
  EXPECT_TRUE(block_.isSelectedBy("F870"));
  EXPECT_TRUE(block_.isSelectedBy("F879"));
  EXPECT_FALSE(block_.isSelectedBy("F899"));
}

TEST(Mx2BlockTransfer, isNeverUsedByADriveWithoutOne)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  const InverterConfig config = inverterConfig();
  BlockTransfer block(mx2, config);
  EXPECT_FALSE(block.fits(std::nullopt));
  EXPECT_FALSE(block.read(std::nullopt));
  EXPECT_THAT(block.takeWrites(std::nullopt), IsEmpty());
  EXPECT_FALSE(block.isSelectedBy("F870"));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

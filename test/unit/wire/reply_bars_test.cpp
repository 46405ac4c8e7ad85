// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <gtest/gtest.h>

#include "inverter_bus/wire/reply_bars.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using std::chrono::milliseconds;
using std::chrono::seconds;

class ReplyBarsTest : public testing::Test
{
protected:
  void lose(const std::string& shape, std::uint8_t station = 1)
  {
    bars_.add(shape, station, { now_ - milliseconds(100), ++ticket_ }, now_);
  }

  bool barred(const std::string& shape) const
  {
    return bars_.barredUntil(shape) > now_;
  }

  ReplyBars bars_;
  TimePoint now_ = TimePoint() + std::chrono::hours(1);
  std::uint64_t ticket_ = 0;
};

TEST_F(ReplyBarsTest, aLostRequestBarsItsShapeForOneSecond)
{
  lose("read");
  EXPECT_TRUE(barred("read"));
  EXPECT_FALSE(barred("rea"));
  EXPECT_FALSE(barred("write"));
  now_ += milliseconds(999);
  EXPECT_TRUE(barred("read"));
  now_ += milliseconds(1);
  EXPECT_FALSE(barred("read"));
}

TEST_F(ReplyBarsTest, theLateReplyLiftsTheBar)
{
  lose("read");
  const auto late = bars_.take("read", now_);
  ASSERT_TRUE(late && *late);
  EXPECT_EQ(now_ - milliseconds(100), (*late)->request_end);
  EXPECT_EQ(ticket_, (*late)->ticket);
  EXPECT_FALSE(barred("read"));
  EXPECT_FALSE(bars_.take("read", now_));
}

TEST_F(ReplyBarsTest, aRequestThatWasLostTwiceIsOwedTwoReplies)
{
  lose("stop");
  lose("stop");
  EXPECT_TRUE(bars_.take("stop", now_));
  EXPECT_TRUE(barred("stop"));
  EXPECT_TRUE(bars_.take("stop", now_));
  EXPECT_FALSE(barred("stop"));
}

TEST_F(ReplyBarsTest, whatWasLostLongAgoIsOwedNothingMore)
{
  lose("read");
  now_ += seconds(2);
  lose("read");
  EXPECT_TRUE(bars_.take("read", now_));
  EXPECT_FALSE(barred("read"));
}

TEST_F(ReplyBarsTest, aReplyIsStillLateAfterTheBarHasEnded)
{
  lose("read");
  now_ += seconds(4);
  EXPECT_FALSE(barred("read"));
  EXPECT_TRUE(bars_.take("read", now_));
}

TEST_F(ReplyBarsTest, aReplyIsForeignAfterItsRequestIsForgotten)
{
  lose("read");
  now_ += seconds(6);
  EXPECT_FALSE(bars_.take("read", now_));
}

TEST_F(ReplyBarsTest, aLoopBackLiftsWhatItsStationOwedBefore)
{
  lose("read", 1);
  lose("other", 2);
  bars_.lift(1, now_);
  EXPECT_FALSE(barred("read"));
  EXPECT_TRUE(barred("other"));
}

TEST_F(ReplyBarsTest, aLoopBackLiftsNothingThatWasAskedAfterIt)
{
  lose("read", 1);
  bars_.lift(1, now_ - milliseconds(200));
  EXPECT_TRUE(barred("read"));
}

TEST_F(ReplyBarsTest, aBeginningThatOneShapeHasIsThatShape)
{
  lose("A1");
  EXPECT_TRUE(bars_.mayBeLate("A", now_));
  const auto late = bars_.take("A", now_);
  ASSERT_TRUE(late);
  EXPECT_TRUE(*late);
  EXPECT_FALSE(barred("A1"));
}

TEST_F(ReplyBarsTest, aBeginningThatSeveralShapesHaveLiftsNone)
{
  lose("A1");
  lose("A2");
  const auto late = bars_.take("A", now_);
  ASSERT_TRUE(late);
  EXPECT_FALSE(*late);
  EXPECT_TRUE(barred("A1"));
  EXPECT_TRUE(barred("A2"));
}

TEST_F(ReplyBarsTest, nothingIsLateWithoutAShape)
{
  lose("A1");
  EXPECT_FALSE(bars_.take("", now_));
  EXPECT_FALSE(bars_.mayBeLate("B", now_));
  now_ += seconds(1);
  EXPECT_FALSE(bars_.mayBeLate("A", now_));
}

TEST_F(ReplyBarsTest, clearForgetsEverything)
{
  lose("A1");
  bars_.clear();
  EXPECT_FALSE(barred("A1"));
  EXPECT_FALSE(bars_.take("A1", now_));
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus

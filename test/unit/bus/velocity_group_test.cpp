// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/rules/velocity_group.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

VelocityGroup resolved(const std::vector<std::string>& names, const std::vector<double>& velocities)
{
  // What is near zero differs from one inverter to another: here "lift" stops below 0.5.
  const auto stops = [](std::size_t inverter, double velocity) {
    return velocity == 0.0 || (inverter == 2 && velocity < 0.5 && velocity > -0.5);
  };
  return resolveGroup(names, velocities, { { "left", 0 }, { "right", 1 }, { "lift", 2 } }, stops);
}

TEST(VelocityGroupTest, namesBecomeIndices)
{
  const VelocityGroup group = resolved({ "right", "left" }, { 2.0, -1.0 });
  EXPECT_EQ("", group.problem);
  EXPECT_THAT(group.targets, ElementsAre(Pair(1U, 2.0), Pair(0U, -1.0)));
}

TEST(VelocityGroupTest, anUnknownNameRefusesAllButTheZeros)
{
  const VelocityGroup group = resolved({ "left", "middle", "right" }, { 1.0, 1.0, 0.0 });
  EXPECT_THAT(group.problem, HasSubstr("'middle'"));
  EXPECT_THAT(group.targets, ElementsAre(Pair(1U, 0.0)));
  EXPECT_THAT(group.named, ElementsAre(0U, 1U));
}

TEST(VelocityGroupTest, unequalLengthsRefuseAllButTheZeros)
{
  const VelocityGroup group = resolved({ "left", "right", "lift" }, { 1.0, -0.0 });
  EXPECT_THAT(group.problem, HasSubstr("3 names and 2 velocities"));
  EXPECT_THAT(group.targets, ElementsAre(Pair(1U, 0.0)));
  EXPECT_THAT(group.named, ElementsAre(0U, 1U, 2U));
}

TEST(VelocityGroupTest, aNameThatStandsTwiceRefusesAllButItsZero)
{
  const VelocityGroup group = resolved({ "left", "left", "right" }, { 1.0, 0.0, 2.0 });
  EXPECT_THAT(group.problem, HasSubstr("'left' twice"));
  EXPECT_THAT(group.targets, ElementsAre(Pair(0U, 0.0)));
}

TEST(VelocityGroupTest, whatIsNearZeroOfARefusedGroupStops)
{
  const VelocityGroup group = resolved({ "left", "middle", "lift" }, { 0.3, 1.0, 0.3 });
  EXPECT_THAT(group.problem, HasSubstr("'middle'"));
  EXPECT_THAT(group.targets, ElementsAre(Pair(2U, 0.3)));
}

TEST(VelocityGroupTest, anExactZeroGoesBeforeOneThatIsNearIt)
{
  EXPECT_THAT(resolved({ "lift", "lift" }, { 0.3, 0.0 }).targets, ElementsAre(Pair(2U, 0.0)));
}

TEST(VelocityGroupTest, aMillionNamesMakeOneShortSentence)
{
  std::vector<std::string> names(1000000, "x");
  names[0] = std::string(1000000, 'y') + "\n\x1B[2J";
  names[1] = "left";
  const VelocityGroup group = resolved(names, std::vector<double>(names.size(), 0.0));
  EXPECT_THAT(group.problem, testing::StartsWith("the group names 'yyyy"));
  EXPECT_LT(group.problem.size(), 300U);
  EXPECT_THAT(group.targets, ElementsAre(Pair(0U, 0.0)));
  EXPECT_THAT(group.named, ElementsAre(0U));
}

TEST(VelocityGroupTest, anInvertersNameAMillionTimesStopsItOnce)
{
  const VelocityGroup group = resolved(std::vector<std::string>(1000000, "lift"), std::vector<double>(1000000, 0.0));
  EXPECT_THAT(group.problem, HasSubstr("'lift' twice"));
  EXPECT_THAT(group.targets, ElementsAre(Pair(2U, 0.0)));
}

TEST(VelocityGroupTest, anEmptyGroupIsNothing)
{
  const VelocityGroup group = resolved({}, {});
  EXPECT_EQ("", group.problem);
  EXPECT_THAT(group.targets, IsEmpty());
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

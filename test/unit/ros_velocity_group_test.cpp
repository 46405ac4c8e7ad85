// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/ros/velocity_group.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

VelocityGroup resolveGroup(const std::vector<std::string>& names, const std::vector<double>& velocities)
{
  VelocityCommand message;
  message.name = names;
  message.velocity = velocities;
  return resolve(message, { { "left", 0 }, { "right", 1 }, { "lift", 2 } });
}

TEST(VelocityGroupTest, namesBecomeIndices)
{
  const VelocityGroup group = resolveGroup({ "right", "left" }, { 2.0, -1.0 });
  EXPECT_EQ("", group.problem);
  EXPECT_THAT(group.targets, ElementsAre(Pair(1U, 2.0), Pair(0U, -1.0)));
}

TEST(VelocityGroupTest, anUnknownNameRefusesAllButTheZeros)
{
  const VelocityGroup group = resolveGroup({ "left", "middle", "right" }, { 1.0, 1.0, 0.0 });
  EXPECT_THAT(group.problem, HasSubstr("'middle'"));
  EXPECT_THAT(group.targets, ElementsAre(Pair(1U, 0.0)));
  EXPECT_THAT(group.named, ElementsAre(0U, 1U));
}

TEST(VelocityGroupTest, unequalLengthsRefuseAllButTheZeros)
{
  const VelocityGroup group = resolveGroup({ "left", "right", "lift" }, { 1.0, -0.0 });
  EXPECT_THAT(group.problem, HasSubstr("3 names and 2 velocities"));
  EXPECT_THAT(group.targets, ElementsAre(Pair(1U, 0.0)));
  EXPECT_THAT(group.named, ElementsAre(0U, 1U, 2U));
}

TEST(VelocityGroupTest, aNameThatStandsTwiceRefusesAllButItsZero)
{
  const VelocityGroup group = resolveGroup({ "left", "left", "right" }, { 1.0, 0.0, 2.0 });
  EXPECT_THAT(group.problem, HasSubstr("'left' twice"));
  EXPECT_THAT(group.targets, ElementsAre(Pair(0U, 0.0)));
}

TEST(VelocityGroupTest, anEmptyGroupIsNothing)
{
  const VelocityGroup group = resolveGroup({}, {});
  EXPECT_EQ("", group.problem);
  EXPECT_THAT(group.targets, IsEmpty());
}
}  // namespace
}  // namespace ros_node
}  // namespace inverter_bus

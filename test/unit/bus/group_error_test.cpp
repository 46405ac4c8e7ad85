// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The error of the last refused group (contract, section 2).

#include "bus/report/group_error.h"

#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
TEST(GroupError, theNextAcceptedGroupEndsIt)
{
  GroupError error;
  EXPECT_EQ(error.id(), 0);
  error.note(at(0), 0xA000);
  EXPECT_EQ(error.id(), 0xA000);
  error.clear(at(1), true);
  EXPECT_EQ(error.id(), 0);
}

TEST(GroupError, anotherCommandEndsItOnlyWhenItWasSeen)
{
  GroupError error;
  error.note(at(0), 0xB001);
  error.clear(at(1000), false);
  EXPECT_EQ(error.id(), 0xB001);
  error.clear(at(1001), false);
  EXPECT_EQ(error.id(), 0);
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

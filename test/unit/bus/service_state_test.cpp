// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "bus/inverter/service_state.h"

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace bus
{
namespace
{
TEST(ServiceState, resetAndSetupAreStatesOfTheirOwn)
{
  ServiceState state;
  state.resetBegun();
  EXPECT_TRUE(state.resetting());
  EXPECT_FALSE(state.setupOpen());
  state.setupOpened();
  state.resetEnded();
  EXPECT_FALSE(state.resetting());
  EXPECT_TRUE(state.setupOpen());
  state.setupLeft();
  EXPECT_FALSE(state.setupOpen());
}

TEST(ServiceState, countsWritesToTheEeprom)
{
  ServiceState state;
  EXPECT_EQ(0U, state.eepromWrites());
  state.eepromWritten();
  state.eepromWritten();
  EXPECT_EQ(2U, state.eepromWrites());
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

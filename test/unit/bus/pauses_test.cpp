// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "bus/inverter/pauses.h"

#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr bool FAILED = true;
constexpr bool OK = false;
constexpr bool REFUSED = true;
constexpr bool NOT_REFUSED = false;

TEST(Pauses, atFirstEverythingMayBeAsked)
{
  const Pauses pauses;
  EXPECT_TRUE(pauses.connectAllowed(at(0)));
  EXPECT_TRUE(pauses.settingsAllowed(at(0), NOT_REFUSED));
  EXPECT_LT(pauses.statusNotBefore(), at(0));
}

TEST(Pauses, whileTheStatusIsHeldSettingsOfTheLowestClassAreToo)
{
  Pauses pauses;
  pauses.holdStatus(at(100));
  EXPECT_EQ(at(100), pauses.statusNotBefore());
  EXPECT_FALSE(pauses.settingsAllowed(at(99), NOT_REFUSED));
  EXPECT_TRUE(pauses.settingsAllowed(at(100), NOT_REFUSED));
  EXPECT_TRUE(pauses.connectAllowed(at(99))) << "these come before the first status";
}

TEST(Pauses, heldSettingsWaitInBothClasses)
{
  Pauses pauses;
  pauses.holdSettings(at(100));
  EXPECT_FALSE(pauses.settingsAllowed(at(99), NOT_REFUSED));
  EXPECT_FALSE(pauses.connectAllowed(at(99)));
  EXPECT_TRUE(pauses.connectAllowed(at(100)));
}

TEST(Pauses, aFailedReadAtConnectIsNotRepeatedAtOnce)
{
  Pauses pauses;
  pauses.settingEnded(at(0), FAILED, Ms(0));
  EXPECT_FALSE(pauses.connectAllowed(at(499)));
  EXPECT_TRUE(pauses.connectAllowed(at(500)));
  pauses.settingEnded(at(600), OK, Ms(0));
  EXPECT_TRUE(pauses.connectAllowed(at(600)));
}

TEST(Pauses, whatWasRefusedForTheMomentWaits)
{
  Pauses pauses;
  pauses.settingEnded(at(0), FAILED, Ms(2000));
  EXPECT_FALSE(pauses.settingsAllowed(at(1999), REFUSED));
  EXPECT_TRUE(pauses.settingsAllowed(at(1999), NOT_REFUSED)) << "another setting is left";
  EXPECT_TRUE(pauses.settingsAllowed(at(2000), REFUSED));
}

TEST(Pauses, aDriveThatComesBackIsSettledAtOnce)
{
  Pauses pauses;
  pauses.settingEnded(at(0), FAILED, Ms(0));
  pauses.holdSettings(at(1000));
  pauses.holdStatus(at(1000));
  pauses.forget();
  EXPECT_TRUE(pauses.connectAllowed(at(0)));
  EXPECT_EQ(at(1000), pauses.statusNotBefore()) << "that may guard against a late reply";
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

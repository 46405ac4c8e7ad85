// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Which parameters may be written, and why not (contract, 4.10), on the drives as shipped.

#include "bus/activities/parameter_gate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "inverter_bus/bus/types.h"
#include "support/drive_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using drive::shipped;
using testing::HasSubstr;

constexpr bool PERSIST = true;
constexpr bool RAM = false;
constexpr bool READ_ONLY = true;
constexpr bool RUNS = true;

TEST(ParameterGate, aWriteThatIsAllowedHasItsCounts)
{
  // F002 of an MX2 counts 0.01 s.
  const WriteVerdict verdict = checkWrite(shipped("omron_mx2"), "F002", 1.5, RAM, !READ_ONLY, !RUNS);
  EXPECT_EQ(verdict.error_id, 0);
  EXPECT_EQ(verdict.raw, 150U);
  EXPECT_EQ(verdict.text, "");
}

TEST(ParameterGate, anUnknownNameAndAValueOutOfRangeAreOutOfRange)
{
  EXPECT_EQ(checkWrite(shipped("omron_mx2"), "Z999", 1.0, RAM, !READ_ONLY, !RUNS).error_id, ERROR_OUT_OF_RANGE);
  EXPECT_EQ(checkWrite(shipped("omron_mx2"), "F002", -1.0, RAM, !READ_ONLY, !RUNS).error_id, ERROR_OUT_OF_RANGE);
}

TEST(ParameterGate, readOnlyAccessForbidsEveryWrite)
{
  const WriteVerdict verdict = checkWrite(shipped("omron_mx2"), "F002", 1.5, PERSIST, READ_ONLY, !RUNS);
  EXPECT_EQ(verdict.error_id, ERROR_NOT_OFFERED);
  EXPECT_EQ(verdict.text, "parameter_access is read_only");
}

TEST(ParameterGate, whatIsNotForARunningMotorWaitsForRest)
{
  EXPECT_EQ(checkWrite(shipped("toshiba_vfs15"), "FH", 60.0, PERSIST, !READ_ONLY, !RUNS).error_id, 0);
  const WriteVerdict verdict = checkWrite(shipped("toshiba_vfs15"), "FH", 60.0, PERSIST, !READ_ONLY, RUNS);
  EXPECT_EQ(verdict.error_id, ERROR_NOT_OFFERED);
  EXPECT_THAT(verdict.text, HasSubstr("while the motor runs"));
}

TEST(ParameterGate, settingsOfTheBusItselfAreWrittenToStayOnly)
{
  const WriteVerdict verdict = checkWrite(shipped("omron_mx2"), "C072", 2.0, RAM, !READ_ONLY, !RUNS);
  EXPECT_EQ(verdict.error_id, ERROR_NOT_OFFERED);
  EXPECT_THAT(verdict.text, HasSubstr("with persist only"));
}

TEST(ParameterGate, onADriveThatStoresEveryWriteItMustBeWanted)
{
  const WriteVerdict verdict = checkWrite(shipped("toshiba_vfs15"), "ACC", 5.0, RAM, !READ_ONLY, !RUNS);
  EXPECT_EQ(verdict.error_id, ERROR_NOT_OFFERED);
  EXPECT_THAT(verdict.text, HasSubstr("EEPROM"));
  EXPECT_EQ(checkWrite(shipped("toshiba_vfs15"), "ACC", 5.0, PERSIST, !READ_ONLY, !RUNS).error_id, 0);
}

TEST(ParameterGate, saysWhyAParameterCantBeRead)
{
  const WriteVerdict verdict = whyNotReadable(shipped("omron_mx2"), "Z999");
  EXPECT_EQ(verdict.error_id, ERROR_OUT_OF_RANGE);
  EXPECT_THAT(verdict.text, HasSubstr("'Z999' is no parameter of omron_mx2"));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus

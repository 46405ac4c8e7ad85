// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Requests of any content on a whole bus in virtual time: refused with an error id and words, and nothing is sent. (The
// fuzz target `requests` tries many more.)
#include <gmock/gmock.h>

#include <limits>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const char* const BELTS = R"(
port: /dev/virtual
baud_rate: 19200
scan_list:
  - {name: belt, node: 1, drive: omron_mx2, max_velocity: 50}
  - {name: pump, node: 2, drive: toshiba_vfs15}
)";

constexpr double INFINITE = std::numeric_limits<double>::infinity();
constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t BELT = 0;
constexpr std::size_t PUMP = 1;

/// Requests that write: Modbus functions 05, 06, 0F, 10 and 17.
std::size_t writes(const VirtualBus& bus)
{
  std::size_t count = 0;
  for (const std::string& request : bus.requests())
  {
    const std::string function = request.substr(3, 2);
    count += function == "05" || function == "06" || function == "0F" || function == "10" || function == "17" ? 1 : 0;
  }
  return count;
}

class BadInput : public testing::Test
{
protected:
  void SetUp() override
  {
    bus_.settleIn();
  }

  /// Refused at once, in words, and nothing is written for a second.
  void expectRefused(const VirtualBus::Box& box, std::uint16_t error_id)
  {
    const bus::Answer answer = bus_.wait(box);
    EXPECT_FALSE(answer.success);
    EXPECT_EQ(error_id, answer.error_id) << answer.message;
    EXPECT_FALSE(answer.message.empty());
    EXPECT_LT(answer.message.size(), 500U);
    EXPECT_THAT(answer.message, Not(HasSubstr("\x1B")));
    bus_.run(1.0);
    EXPECT_EQ(0U, writes(bus_)) << answer.message;
  }

  VirtualBus bus_{ BELTS };
};

TEST_F(BadInput, namesOfParametersOfAnyContent)
{
  const std::string names[] = { "",
                                "F002 ",
                                "../../etc/passwd",
                                std::string("F002\0", 5),
                                "\xFF\xFE",
                                "\x1B[2J",
                                std::string(1000000, 'x'),
                                std::string(1000000, '\n'),
                                "0x",
                                "0x10000",
                                "0x" + std::string(1000000, 'F'),
                                "-1" };
  for (const std::string& name : names)
  {
    expectRefused(bus_.readParameter(BELT, name), bus::ERROR_OUT_OF_RANGE);
    expectRefused(bus_.writeParameter(BELT, name, 1.0, false), bus::ERROR_OUT_OF_RANGE);
  }
}

TEST_F(BadInput, aPlaceIsForReadingOnly)
{
  expectRefused(bus_.writeParameter(BELT, "0x1103", 1.0, false), bus::ERROR_OUT_OF_RANGE);
}

TEST_F(BadInput, valuesOfParametersOfAnySize)
{
  for (const double value : { NOT_A_NUMBER, INFINITE, -INFINITE, 1e300, -1e300, -0.1, 1e9, 65536.0, 29.9, 400.1 })
  {
    expectRefused(bus_.writeParameter(BELT, "A003", value, false), bus::ERROR_OUT_OF_RANGE);
  }
}

TEST_F(BadInput, theStationNumberIsWrittenWithPersistOnly)
{
  expectRefused(bus_.writeParameter(BELT, "C072", 3.0, false), bus::ERROR_NOT_OFFERED);
}

TEST_F(BadInput, whatADriveAlwaysStoresIsWrittenWithPersistOnly)
{
  expectRefused(bus_.writeParameter(PUMP, "ACC", 10.0, false), bus::ERROR_NOT_OFFERED);
}

TEST_F(BadInput, whatTheProfileProtectsIsNotWrittenWhileItRuns)
{
  bus_.stream(PUMP, 10.0, 0.1, 10.0);
  ASSERT_TRUE(bus_.runUntil(5.0, [this] { return bus_.status(PUMP).run_command; }));
  const bus::Answer answer = bus_.wait(bus_.writeParameter(PUMP, "FH", 60.0, true));
  EXPECT_EQ(bus::ERROR_NOT_OFFERED, answer.error_id) << answer.message;
  EXPECT_THAT(answer.message, HasSubstr("while the motor runs"));
}

TEST_F(BadInput, velocitiesThatAreNoNumbers)
{
  bus_.command(BELT, 10.0);
  bus_.run(0.2);
  ASSERT_TRUE(bus_.status(BELT).run_command);
  bus_.clearFrames();
  for (const double value : { NOT_A_NUMBER, INFINITE, -INFINITE, 1e300, -1e300, 50.1 })
  {
    EXPECT_EQ(bus::ERROR_OUT_OF_RANGE, bus_.command(BELT, value)) << value;
    EXPECT_EQ(bus::ERROR_OUT_OF_RANGE, bus_.group({ { PUMP, 10.0 }, { BELT, value } })) << value;
  }
  bus_.run(0.1);
  EXPECT_EQ(0U, writes(bus_));
  EXPECT_EQ(10.0, bus_.status(BELT).commanded_velocity);
  EXPECT_EQ(0.0, bus_.status(PUMP).commanded_velocity);
  EXPECT_EQ(bus::ERROR_OUT_OF_RANGE, bus_.status(BELT).error_id);
  EXPECT_FALSE(bus_.status(BELT).error_text.empty());
}

TEST_F(BadInput, anUnknownStopModeStops)
{
  bus_.command(BELT, 10.0);
  bus_.run(0.2);
  ASSERT_EQ(1, bus_.motor("belt", "run_coil"));
  const bus::Answer answer = bus_.wait(bus_.stop(BELT, 255));
  EXPECT_TRUE(answer.success);
  EXPECT_THAT(answer.message, HasSubstr("255"));
  EXPECT_EQ(0, bus_.motor("belt", "run_coil"));
}

TEST_F(BadInput, aHundredThousandStopsThatNobodyWaitsForDelayNoOther)
{
  for (int i = 0; i < 100000; ++i)
  {
    bus_.coordinator().stop(bus_.now(), std::nullopt, 0, bus::AnswerCallback());
  }
  const TimePoint asked = bus_.now();
  EXPECT_TRUE(bus_.wait(bus_.stop(BELT)).success);
  EXPECT_LT(bus_.now() - asked, seconds(0.5));
}

TEST(BadInputReadOnly, noParameterIsWritten)
{
  VirtualBus bus(std::string(BELTS) + "parameter_access: read_only\n");
  bus.settleIn();
  for (const char* name : { "F002", "C072", "A001" })
  {
    for (const bool persist : { false, true })
    {
      const bus::Answer answer = bus.wait(bus.writeParameter(BELT, name, 1.0, persist));
      EXPECT_EQ(bus::ERROR_NOT_OFFERED, answer.error_id) << answer.message;
      EXPECT_THAT(answer.message, HasSubstr("read_only"));
    }
  }
  EXPECT_TRUE(bus.wait(bus.readParameter(BELT, "F002")).success);
  EXPECT_EQ(0U, writes(bus));
}
}  // namespace
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Which rates a UART can run at (contract, 8.13), and where its clock stands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "wire/port/uart_rate.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;

/// Of a PC's 16550A: 16 times 115200.
constexpr unsigned PC_CLOCK = 1843200;

TEST(UartRate, whatTheClockDividesIsTaken)
{
  for (const unsigned rate : { 50U, 1200U, 2400U, 4800U, 9600U, 19200U, 38400U, 57600U, 115200U })
  {
    EXPECT_EQ("", judgeUartRate(PC_CLOCK, rate, rate)) << rate;
  }
}

TEST(UartRate, theReadBackDoesNotProveARate)
{
  // The divisor for 76800 is 1.5: 2 makes 57600.
  EXPECT_THAT(judgeUartRate(PC_CLOCK, 76800, 76800),
              AllOf(HasSubstr("baud rate 76800"), HasSubstr("run at 57600"), HasSubstr("57600 and 115200")));
  // 115200 / 3 = 38400 is 4 % off.
  EXPECT_THAT(judgeUartRate(PC_CLOCK, 40000, 40000), AllOf(HasSubstr("run at 38400"), HasSubstr("38400 and 57600")));
}

TEST(UartRate, twoPercentAreTaken)
{
  EXPECT_EQ("", judgeUartRate(PC_CLOCK, 39150, 39150));
  EXPECT_NE("", judgeUartRate(PC_CLOCK, 39250, 39250));
  EXPECT_EQ("", judgeUartRate(PC_CLOCK, 37700, 37700));
  EXPECT_NE("", judgeUartRate(PC_CLOCK, 37600, 37600));
  EXPECT_EQ("", judgeUartRate(PC_CLOCK, 116000, 116000));
}

TEST(UartRate, aboveTheFastestTheOldOneIsKept)
{
  EXPECT_THAT(judgeUartRate(PC_CLOCK, 230400, 9600),
              AllOf(HasSubstr("baud rate 230400"), HasSubstr("stays at 9600"), HasSubstr("works is 115200")));
  EXPECT_THAT(judgeUartRate(PC_CLOCK, 117000, 115200), HasSubstr("works is 115200"));
}

TEST(UartRate, aFasterClockHasMoreRates)
{
  EXPECT_EQ("", judgeUartRate(16 * 921600, 76800, 76800));
  EXPECT_EQ("", judgeUartRate(16 * 921600, 230400, 230400));
  EXPECT_EQ("", judgeUartRate(48000000, 76800, 76800));
  // 3000000 / 13 = 230769, 0.2 % off.
  EXPECT_EQ("", judgeUartRate(48000000, 230400, 230400));
}

TEST(UartRate, aDriverThatSaysSomethingElseIsBelieved)
{
  EXPECT_THAT(judgeUartRate(PC_CLOCK, 19200, 9600), AllOf(HasSubstr("19200"), HasSubstr("runs at 9600")));
}

TEST(UartRate, elsewhereTheReadBackDecides)
{
  EXPECT_EQ("", judgeRate(76800, 76800));
  EXPECT_EQ("", judgeRate(76800, 76923));
  EXPECT_THAT(judgeRate(4000000, 9600), AllOf(HasSubstr("4000000"), HasSubstr("runs at 9600")));
  EXPECT_NE("", judgeRate(9600, 0));
}

/// A device file and a sysfs of the test's own.
class UartClock : public testing::Test
{
protected:
  UartClock()
  {
    std::string pattern = testing::TempDir() + "uart_clock_XXXXXX";
    root_ = ::mkdtemp(&pattern[0]);
    for (const char* folder : { "/class", "/class/tty", "/dev", "/dev/char" })
    {
      ::mkdir((root_ + folder).c_str(), 0755);
    }
  }

  /// The UART of /dev/null, which stands for a serial port.
  std::string addUart(const std::string& folder, const std::string& type, const std::string& clock) const
  {
    const std::string path = root_ + folder;
    ::mkdir(path.c_str(), 0755);
    write(path + "/type", type);
    write(path + "/uartclk", clock);
    return path;
  }

  static void write(const std::string& file, const std::string& text)
  {
    std::ofstream(file) << text << "\n";
  }

  std::string root_;
};

TEST_F(UartClock, standsInTheFolderOfItsName)
{
  addUart("/class/tty/null", "4", "1843200");
  EXPECT_EQ(1843200U, uartClock("/dev/null", root_).value_or(0));
}

TEST_F(UartClock, isFoundThroughALink)
{
  addUart("/class/tty/null", "4", "1843200");
  ASSERT_EQ(0, ::symlink("/dev/null", (root_ + "/by-id").c_str()));
  EXPECT_EQ(1843200U, uartClock(root_ + "/by-id", root_).value_or(0));
}

TEST_F(UartClock, isFoundByNumberWhereAnotherDeviceHasTheName)
{
  // /dev/null is 1:3 (Linux, devices.txt).
  write(addUart("/class/tty/null", "4", "1000000") + "/dev", "4:65");
  addUart("/dev/char/1:3", "4", "1843200");
  EXPECT_EQ(1843200U, uartClock("/dev/null", root_).value_or(0));
}

TEST_F(UartClock, isUnknownWhereNothingIsDividedByWholeNumbers)
{
  // No UART; 16C950, NS16550A, two of Exar; PL011, i.MX.
  for (const char* type : { "0", "10", "14", "21", "24", "32", "62", "", "x" })
  {
    addUart("/class/tty/null", type, "1843200");
    EXPECT_FALSE(uartClock("/dev/null", root_)) << type;
  }
}

TEST_F(UartClock, isUnknownWithoutAFolderOrANumber)
{
  EXPECT_FALSE(uartClock("/dev/null", root_));
  EXPECT_FALSE(uartClock("/dev/inverter_bus_no_such_port", root_));
  EXPECT_FALSE(uartClock("", root_));
  for (const char* clock : { "", "0", "15", "-1843200" })
  {
    addUart("/class/tty/null", "4", clock);
    EXPECT_FALSE(uartClock("/dev/null", root_)) << clock;
  }
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Drives that are set otherwise than the master talks, or to a station that another one has.

#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulation/line/terminal_settings.h"
#include "support/simulation_test_bus.h"

using namespace inverter_bus::simulation;
using testing::HasSubstr;
using testing::Not;

namespace
{
const char* const READ_STATUS_OF_2 = "02 03 00 02 00 03";

std::string two(const std::string& simulation)
{
  return "baud_rate: 19200\nscan_list: [{name: a, node: 1, drive: omron_mx2}, {name: b, node: 2, drive: omron_mx2}]\n"
         "simulation: {" +
         simulation + "}\n";
}

LineSettings serial(int baud_rate, Parity parity = Parity::None)
{
  LineSettings settings;
  settings.baud_rate = baud_rate;
  settings.parity = parity;
  return settings;
}

/// Both ends of a pseudo-terminal.
class Terminal
{
public:
  Terminal() : near(posix_openpt(O_RDWR | O_NOCTTY))
  {
    if (near >= 0 && grantpt(near) == 0 && unlockpt(near) == 0)
    {
      far = open(ptsname(near), O_RDWR | O_NOCTTY);
    }
  }
  ~Terminal()
  {
    close(near);
    close(far);
  }

  int near;
  int far = -1;
};

/// As a client sets its port; \p checks is what this driver and libmodbus do with parity, and pyserial doesn't.
void setUp(int tty, speed_t speed, bool parity, bool odd, bool checks, bool two_stop_bits)
{
  termios settings{};
  tcgetattr(tty, &settings);
  cfmakeraw(&settings);
  cfsetispeed(&settings, speed);
  cfsetospeed(&settings, speed);
  settings.c_cflag |= parity ? PARENB : 0U;
  settings.c_cflag = odd ? settings.c_cflag | PARODD : settings.c_cflag & ~static_cast<tcflag_t>(PARODD);
  settings.c_cflag = two_stop_bits ? settings.c_cflag | CSTOPB : settings.c_cflag & ~static_cast<tcflag_t>(CSTOPB);
  settings.c_iflag = checks ? settings.c_iflag | INPCK : settings.c_iflag & ~static_cast<tcflag_t>(INPCK);
  tcsetattr(tty, TCSANOW, &settings);
}
}  // namespace

TEST(SimulatedSerial, aDriveOnAnotherBaudRateOrParityHearsGarbageAndIsSilent)
{
  for (const char* wrong : { "baud_rate: 9600", "parity: even", "parity: odd" })
  {
    TestBus bus(two("b: {" + std::string(wrong) + "}"));
    EXPECT_NE("", bus.ask(READ_STATUS)) << wrong;
    EXPECT_EQ("", bus.ask(READ_STATUS_OF_2)) << wrong;
    EXPECT_THAT(bus.command("bus frames 1"), HasSubstr("garbage to b: sent with 19200 baud 8N1")) << wrong;
    EXPECT_EQ("", bus.ask("02 05 00 00 FF 00"));
    EXPECT_EQ("0", bus.shown("b", "run_coil")) << wrong;
  }
}

TEST(SimulatedSerial, stopBitsAreOnlySilence)
{
  TestBus bus(two("b: {stop_bits: 2}"));
  EXPECT_NE("", bus.ask(READ_STATUS_OF_2));
}

TEST(SimulatedSerial, whatTheMasterChangesToCounts)
{
  TestBus bus(two("b: {baud_rate: 9600, parity: even}"));
  bus.bus.setMaster(serial(9600, Parity::Even), bus.now);
  EXPECT_EQ("", bus.ask(READ_STATUS));
  EXPECT_NE("", bus.ask(READ_STATUS_OF_2));
  EXPECT_THAT(bus.command("bus show"), HasSubstr("master=9600/8E1"));
  bus.bus.setMaster(serial(38400), bus.now);
  EXPECT_EQ("", bus.ask(READ_STATUS));
  EXPECT_EQ("", bus.ask(READ_STATUS_OF_2));
}

TEST(SimulatedSerial, theWireTimeIsThatOfTheMaster)
{
  TestBus slow(two("a: {baud_rate: 9600}"));
  slow.bus.setMaster(serial(9600), slow.now);
  const TimePoint start = slow.now;
  slow.ask(READ_STATUS);
  // Eight bytes out and eleven back at 10 bits each.
  EXPECT_GT(toSeconds(slow.last_byte - start), 190.0 / 9600.0);
}

TEST(SimulatedSerial, aSettingOfTheDriveCountsFromItsNextPowerUp)
{
  TestBus bus(oneMx2());
  EXPECT_NE("", bus.ask(READ_STATUS));
  EXPECT_THAT(bus.command("m set C071 5"), HasSubstr("ok"));  // 9600 baud
  EXPECT_NE("", bus.ask(READ_STATUS));
  bus.command("m power_cycle");
  bus.wait(10.0);
  EXPECT_EQ("", bus.ask(READ_STATUS));
  bus.bus.setMaster(serial(9600), bus.now);
  EXPECT_NE("", bus.ask(READ_STATUS));
}

TEST(SimulatedSerial, twoDrivesOnOneStationSpoilEachOthersReplies)
{
  TestBus bus(two("b: {station: 1}"));
  const Bytes reply = *fromHex(bus.askRaw(toHex(withModbusCrc(*fromHex(READ_STATUS)))));
  EXPECT_FALSE(modbusCrcFits(reply));
  EXPECT_THAT(bus.command("bus show"), Not(HasSubstr("collisions=0 ")));
  EXPECT_EQ("", bus.ask(READ_STATUS_OF_2));
  // Both of them obey.
  bus.askRaw(toHex(withModbusCrc(*fromHex(RUN))));
  EXPECT_EQ("1", bus.shown("a", "run_coil"));
  EXPECT_EQ("1", bus.shown("b", "run_coil"));
}

TEST(SimulatedSerial, aDriveThatNoScanListKnowsIsThereToo)
{
  TestBus bus(two("stranger: {model: toshiba_vfs15, station: 7}"));
  EXPECT_NE("", bus.ask("07 03 FD 00 00 01"));
}

TEST(SimulatedSerial, whatIsWrongWithTheMapIsTold)
{
  for (const char* wrong :
       { "b: {baud_rate: 9601.5}", "b: {parity: mark}", "b: {stop_bits: 3}", "b: {station: 256}", "nobody: {load: 1.0}",
         "nobody: {model: omron_mx2}", "b: {nonsense: 1}", "b: {load: '1'}" })
  {
    try
    {
      busConfigFromText(two(wrong));
      ADD_FAILURE() << wrong << " was accepted";
    }
    catch (const ConfigError& error)
    {
      EXPECT_THAT(error.what(), HasSubstr("allowed:")) << wrong;
    }
  }
}

TEST(SimulatedTerminal, showsBaudRateStopBitsAndParityOfItsClient)
{
  Terminal terminal;
  ASSERT_GE(terminal.far, 0);
  struct
  {
    speed_t speed;
    bool parity;
    bool odd;
    bool checks;
    bool two_stop_bits;
    const char* text;
  } const cases[] = { { B9600, false, false, false, false, "9600 baud 8N1" },
                      { B19200, true, false, true, false, "19200 baud 8E1" },
                      { B38400, true, true, true, false, "38400 baud 8O1" },
                      { B115200, true, true, false, true, "115200 baud 8O2" },
                      { B2400, false, false, false, true, "2400 baud 8N2" } };
  for (const auto& one : cases)
  {
    setUp(terminal.far, one.speed, one.parity, one.odd, one.checks, one.two_stop_bits);
    const auto seen = settingsOf(terminal.near, LineSettings());
    ASSERT_TRUE(seen);
    EXPECT_EQ(one.text, seen->text());
  }
}

TEST(SimulatedTerminal, isSetAsItsClientWouldUntilOneComes)
{
  Terminal terminal;
  ASSERT_GE(terminal.far, 0);
  for (const LineSettings& settings : { serial(76800), serial(9600, Parity::Even), serial(4800, Parity::Odd) })
  {
    setTerminal(terminal.far, settings);
    EXPECT_EQ(settings.text(), settingsOf(terminal.near, LineSettings())->text());
  }
  EXPECT_FALSE(settingsOf(-1, LineSettings()));
}

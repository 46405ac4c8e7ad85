// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <tuple>

#include "inverter_bus/wire/line.h"
#include "inverter_bus/wire/serial_port.h"
#include "support/wire_frames.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// For what comes at once: long enough for any machine, and never waited out.
TimePoint soon()
{
  return steady_clock::now() + std::chrono::seconds(10);
}

/// A pseudo-terminal whose other end the test holds.
class SerialPortTest : public testing::Test
{
protected:
  SerialPortTest()
  {
    EXPECT_GE(master_, 0);
    EXPECT_EQ(0, ::grantpt(master_));
    EXPECT_EQ(0, ::unlockpt(master_));
    settings_.device = ::ptsname(master_);
  }

  SerialPortTest(const SerialPortTest&) = delete;
  SerialPortTest& operator=(const SerialPortTest&) = delete;

  ~SerialPortTest() override
  {
    unplug();
  }

  void unplug()
  {
    if (master_ >= 0)
    {
      ::close(master_);
      master_ = -1;
    }
  }

  OpenResult open(Port& port)
  {
    return port.open(error_);
  }

  /// Reads as many bytes as are expected.
  Bytes readFromMaster(std::size_t count) const
  {
    Bytes bytes(count);
    std::size_t size = 0;
    while (size < count)
    {
      const ssize_t part = ::read(master_, bytes.data() + size, count - size);
      if (part <= 0)
      {
        break;
      }
      size += static_cast<std::size_t>(part);
    }
    bytes.resize(size);
    return bytes;
  }

  void writeToMaster(const Bytes& bytes) const
  {
    EXPECT_EQ(static_cast<ssize_t>(bytes.size()), ::write(master_, bytes.data(), bytes.size()));
  }

  Bytes receive(Port& port, std::size_t count) const
  {
    Bytes bytes;
    while (bytes.size() < count && port.receive(bytes, soon()) == ReceiveResult::Data)
    {
    }
    return bytes;
  }

  SerialSettings settings_;
  std::string error_;
  int master_ = ::posix_openpt(O_RDWR | O_NOCTTY);
};

/// Every byte value, those included that a terminal would act on (00, 03, 0A, 0D, 11, 13, 1A, 7F, FF).
Bytes everyByte()
{
  Bytes bytes;
  for (unsigned value = 0; value <= 0xFF; ++value)
  {
    bytes.push_back(static_cast<std::uint8_t>(value));
  }
  return bytes;
}

TEST_F(SerialPortTest, sendsAModbusFrameUnchanged)
{
  const auto port = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  for (const Bytes& frame : { withCrc("01 03 00 00 00 01"), withCrc("01 10 00 0A 00 02 04 0D 11 13 7F"),
                              withCrc("00 06 FA 00 C0 00"), withCrc("03 08 00 00 03 1A") })
  {
    ASSERT_TRUE(port->send(frame));
    EXPECT_EQ(frame, readFromMaster(frame.size()));
  }
}

TEST_F(SerialPortTest, sendsTheLongestModbusFrame)
{
  Bytes frame = everyByte();
  frame.resize(254);
  const std::uint16_t crc = modbusCrc(frame.data(), frame.size());
  frame = frame + Bytes{ static_cast<std::uint8_t>(crc & 0xFF), static_cast<std::uint8_t>(crc >> 8) };
  const auto port = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  ASSERT_TRUE(port->send(frame));
  EXPECT_EQ(frame, readFromMaster(frame.size()));
}

TEST_F(SerialPortTest, sendsAnyBytesWhenPlain)
{
  settings_.transmission = Transmission::Plain;
  const auto port = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  ASSERT_TRUE(port->send(everyByte()));
  EXPECT_EQ(everyByte(), readFromMaster(256));
}

TEST_F(SerialPortTest, receivesEveryByteUnchanged)
{
  const auto port = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  writeToMaster(everyByte());
  EXPECT_EQ(everyByte(), receive(*port, 256));
}

TEST_F(SerialPortTest, appendsWhatItReceives)
{
  const auto port = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  Bytes buffer = hex("AA");
  writeToMaster(hex("55"));
  EXPECT_EQ(ReceiveResult::Data, port->receive(buffer, soon()));
  EXPECT_EQ(hex("AA 55"), buffer);
}

TEST_F(SerialPortTest, silenceEndsAtTheDeadline)
{
  const auto port = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  Bytes buffer;
  const TimePoint deadline = steady_clock::now() + milliseconds(5);
  EXPECT_EQ(ReceiveResult::Silence, port->receive(buffer, deadline));
  EXPECT_GE(steady_clock::now(), deadline);
}

TEST_F(SerialPortTest, aSignalDoesNotEndTheWaiting)
{
  const auto port = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  struct sigaction action = {};
  struct sigaction before = {};
  action.sa_handler = [](int) {};
  ASSERT_EQ(0, ::sigaction(SIGALRM, &action, &before));
  const itimerval every_millisecond{ { 0, 1000 }, { 0, 1000 } };
  ASSERT_EQ(0, ::setitimer(ITIMER_REAL, &every_millisecond, nullptr));
  Bytes buffer;
  const TimePoint deadline = steady_clock::now() + milliseconds(10);
  EXPECT_EQ(ReceiveResult::Silence, port->receive(buffer, deadline));
  EXPECT_GE(steady_clock::now(), deadline);
  const itimerval never{};
  ::setitimer(ITIMER_REAL, &never, nullptr);
  ::sigaction(SIGALRM, &before, nullptr);
}

TEST_F(SerialPortTest, aPastDeadlineTakesWhatIsThere)
{
  const auto port = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  Bytes buffer;
  EXPECT_EQ(ReceiveResult::Silence, port->receive(buffer, TimePoint()));
  writeToMaster(hex("01 02"));
  // The kernel hands bytes from one end to the other in a thread of its own.
  while (port->receive(buffer, TimePoint()) != ReceiveResult::Data)
  {
  }
  EXPECT_EQ(0x01, buffer.at(0));
}

TEST_F(SerialPortTest, whatArrivedBeforeTheOpeningIsDropped)
{
  const int slave = ::open(settings_.device.c_str(), O_RDWR | O_NOCTTY);
  writeToMaster(hex("0A"));
  int available = 0;
  while (available == 0)
  {
    ASSERT_EQ(0, ::ioctl(slave, FIONREAD, &available));
  }
  const auto port = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  Bytes buffer;
  EXPECT_EQ(ReceiveResult::Silence, port->receive(buffer, TimePoint()));
  ::close(slave);
}

TEST_F(SerialPortTest, aSecondOpenFindsItInUse)
{
  const auto first = makeSerialPort(settings_);
  const auto second = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*first)) << error_;
  EXPECT_EQ(OpenResult::InUse, open(*second));
  EXPECT_NE(std::string::npos, error_.find(settings_.device + " is in use"));
  EXPECT_FALSE(second->isOpen());
  EXPECT_TRUE(first->send(withCrc("01 03 00 00 00 01")));
}

TEST_F(SerialPortTest, aSecondOpenLeavesTheSettingsOfTheFirstAlone)
{
  const auto first = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*first)) << error_;
  settings_.baud_rate = 9600;
  const auto second = makeSerialPort(settings_);
  EXPECT_EQ(OpenResult::InUse, open(*second));
  termios attributes{};
  ASSERT_EQ(0, ::tcgetattr(master_, &attributes));
  EXPECT_EQ(static_cast<speed_t>(B19200), ::cfgetospeed(&attributes));
}

TEST_F(SerialPortTest, aSecondOpenThroughALinkFindsItInUse)
{
  const std::string link = testing::TempDir() + "wire_serial_port_test_link";
  ::unlink(link.c_str());
  ASSERT_EQ(0, ::symlink(settings_.device.c_str(), link.c_str()));
  const auto first = makeSerialPort(settings_);
  settings_.device = link;
  const auto second = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*first)) << error_;
  EXPECT_EQ(OpenResult::InUse, open(*second));
  ::unlink(link.c_str());
}

TEST_F(SerialPortTest, sharedPortsAreNotLocked)
{
  const auto first = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*first)) << error_;
  settings_.exclusive = false;
  const auto second = makeSerialPort(settings_);
  EXPECT_EQ(OpenResult::Opened, open(*second)) << error_;
}

TEST_F(SerialPortTest, theLockEndsWithTheClose)
{
  const auto first = makeSerialPort(settings_);
  const auto second = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*first)) << error_;
  first->close();
  first->close();
  EXPECT_FALSE(first->isOpen());
  EXPECT_EQ(OpenResult::Opened, open(*second)) << error_;
}

TEST_F(SerialPortTest, aPseudoTerminalIsNotMadeExclusive)
{
  // TIOCEXCL there would lock everybody out until the other end is closed, long after its owner was killed.
  const auto port = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  const int slave = ::open(settings_.device.c_str(), O_RDWR | O_NOCTTY);
  int exclusive = -1;
  ASSERT_EQ(0, ::ioctl(slave, TIOCGEXCL, &exclusive));
  EXPECT_EQ(0, exclusive);
  ::close(slave);
}

TEST_F(SerialPortTest, theLockEndsWithAKilledOwner)
{
  int ready[2];
  ASSERT_EQ(0, ::pipe(ready));
  const pid_t owner = ::fork();
  ASSERT_GE(owner, 0);
  if (owner == 0)
  {
    const auto port = makeSerialPort(settings_);
    std::string error;
    const char opened = port->open(error) == OpenResult::Opened ? 'y' : 'n';
    const bool told = ::write(ready[1], &opened, 1) == 1;
    while (told)
    {
      ::pause();
    }
    ::_exit(1);
  }
  char opened = 'n';
  ASSERT_EQ(1, ::read(ready[0], &opened, 1));
  EXPECT_EQ('y', opened);
  const auto port = makeSerialPort(settings_);
  EXPECT_EQ(OpenResult::InUse, open(*port));
  ::kill(owner, SIGKILL);
  ::waitpid(owner, nullptr, 0);
  EXPECT_EQ(OpenResult::Opened, open(*port)) << error_;
  ::close(ready[0]);
  ::close(ready[1]);
}

TEST_F(SerialPortTest, opensAgainAfterItsOwnOpen)
{
  const auto port = makeSerialPort(settings_);
  EXPECT_EQ(OpenResult::Opened, open(*port)) << error_;
  EXPECT_EQ(OpenResult::Opened, open(*port)) << error_;
}

TEST_F(SerialPortTest, aMissingDeviceIsNotThere)
{
  settings_.device = "/dev/inverter_bus_no_such_port";
  const auto port = makeSerialPort(settings_);
  EXPECT_EQ(OpenResult::NotThere, open(*port));
  EXPECT_EQ("cannot open /dev/inverter_bus_no_such_port: No such file or directory: plug it in, or check its name",
            error_);
  EXPECT_FALSE(port->isOpen());
  EXPECT_EQ(settings_.device, port->name());
}

TEST_F(SerialPortTest, anEmptyNameIsNotThere)
{
  settings_.device.clear();
  EXPECT_EQ(OpenResult::NotThere, open(*makeSerialPort(settings_)));
}

TEST_F(SerialPortTest, whatIsNoSerialPortIsNotThere)
{
  settings_.device = "/dev/null";
  const auto port = makeSerialPort(settings_);
  EXPECT_EQ(OpenResult::NotThere, open(*port));
  EXPECT_EQ("cannot use /dev/null: it is not a serial port", error_);
}

TEST_F(SerialPortTest, aDirectoryIsNotThere)
{
  settings_.device = "/dev";
  EXPECT_EQ(OpenResult::NotThere, open(*makeSerialPort(settings_)));
}

TEST_F(SerialPortTest, theKernelsSwitchingIsRefusedInWords)
{
  settings_.rs485 = Rs485::Kernel;
  const auto port = makeSerialPort(settings_);
  EXPECT_EQ(OpenResult::NotThere, open(*port));
  EXPECT_NE(std::string::npos, error_.find("RS-485")) << error_;
}

TEST_F(SerialPortTest, rtsSwitchingIsAcceptedOnAPseudoTerminal)
{
  for (const Transmission transmission : { Transmission::Modbus, Transmission::Plain })
  {
    settings_.rs485 = Rs485::RtsHigh;
    settings_.transmission = transmission;
    const auto port = makeSerialPort(settings_);
    ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
    const Bytes frame = withCrc("01 03 00 00 00 01");
    EXPECT_TRUE(port->send(frame));
    EXPECT_EQ(frame, readFromMaster(frame.size()));
  }
}

TEST_F(SerialPortTest, sendingToAClosedPortFails)
{
  const auto port = makeSerialPort(settings_);
  EXPECT_FALSE(port->send(withCrc("01 03 00 00 00 01")));
  Bytes buffer;
  EXPECT_EQ(ReceiveResult::Gone, port->receive(buffer, soon()));
}

TEST_F(SerialPortTest, anUnpluggedPortIsGone)
{
  const auto port = makeSerialPort(settings_);
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  unplug();
  Bytes buffer;
  EXPECT_EQ(ReceiveResult::Gone, port->receive(buffer, soon()));
  EXPECT_FALSE(port->send(withCrc("01 03 00 00 00 01")));
  EXPECT_EQ(OpenResult::NotThere, open(*port));
  EXPECT_FALSE(error_.empty());
}

TEST_F(SerialPortTest, aPortThatTakesNothingMoreIsGone)
{
  for (const Transmission transmission : { Transmission::Modbus, Transmission::Plain })
  {
    settings_.transmission = transmission;
    const auto port = makeSerialPort(settings_);
    ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
    const Bytes frame = withCrc("01 03 00 00 00 01");
    const TimePoint latest = steady_clock::now() + std::chrono::seconds(60);
    // Nobody reads at the other end: its buffer fills up.
    while (port->send(frame) && steady_clock::now() < latest)
    {
    }
    EXPECT_LT(steady_clock::now(), latest);
  }
}

TEST_F(SerialPortTest, carriesALine)
{
  const auto port = makeSerialPort(settings_);
  const auto protocol = makeModbusRtu();
  util::SteadyClock clock;
  Line line(*port, *protocol, clock, LineTiming(settings_.baud_rate, bitsPerCharacter(settings_)));
  ASSERT_EQ(OpenResult::Opened, line.open(error_)) << error_;
  const Bytes request = withCrc("01 03 00 00 00 01");
  std::thread drive([this, &request] {
    EXPECT_EQ(request, readFromMaster(request.size()));
    writeToMaster(withCrc("01 03 02 17 70"));
  });
  Request read = requestOf(request);
  read.response_timeout = std::chrono::seconds(10);
  EXPECT_TRUE(line.settle());
  const Reply reply = line.exchange(read);
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(hex("03 02 17 70"), reply.pdu);
  drive.join();
  unplug();
  EXPECT_EQ(Outcome::PortLost, line.exchange(read).outcome);
  EXPECT_FALSE(line.isOpen());
}

class SerialPortSettings : public SerialPortTest,
                           public testing::WithParamInterface<std::tuple<Parity, unsigned, unsigned, unsigned>>
{
};

TEST_P(SerialPortSettings, areAcceptedOnAPseudoTerminal)
{
  std::tie(settings_.parity, settings_.data_bits, settings_.stop_bits, settings_.baud_rate) = GetParam();
  const auto port = makeSerialPort(settings_);
  // Twice: the second time nothing changes any more, which glibc reports as EINVAL.
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  ASSERT_EQ(OpenResult::Opened, open(*port)) << error_;
  const Bytes frame = withCrc("01 10 00 00 00 01 02 FF 80");
  ASSERT_TRUE(port->send(frame));
  EXPECT_EQ(frame, readFromMaster(frame.size()));
  writeToMaster(frame);
  EXPECT_EQ(frame, receive(*port, frame.size()));
}

INSTANTIATE_TEST_SUITE_P(all, SerialPortSettings,
                         testing::Combine(testing::Values(Parity::None, Parity::Even, Parity::Odd),
                                          testing::Values(7u, 8u), testing::Values(1u, 2u),
                                          testing::Values(2400u, 19200u, 76800u, 115200u)));

TEST(SerialSettings, aCharacterHasStartDataParityAndStopBits)
{
  SerialSettings settings;
  EXPECT_EQ(10u, bitsPerCharacter(settings));
  settings.parity = Parity::Even;
  EXPECT_EQ(11u, bitsPerCharacter(settings));
  settings.stop_bits = 2;
  EXPECT_EQ(12u, bitsPerCharacter(settings));
  settings.data_bits = 7;
  EXPECT_EQ(11u, bitsPerCharacter(settings));
}

TEST(AdapterLatency, isUnknownWithoutAnAdapter)
{
  EXPECT_FALSE(adapterLatency("/dev/null"));
  EXPECT_FALSE(adapterLatency("/dev/inverter_bus_no_such_port"));
  EXPECT_FALSE(adapterLatency(""));
}

TEST(AdapterLatency, isThatOfTheLatencyTimer)
{
  std::string sysfs = testing::TempDir() + "adapter_latency_XXXXXX";
  ASSERT_NE(nullptr, ::mkdtemp(&sysfs[0]));
  std::string folder = sysfs;
  // /dev/null stands for the device.
  for (const char* part : { "/class", "/tty", "/null", "/device" })
  {
    folder += part;
    ASSERT_EQ(0, ::mkdir(folder.c_str(), 0755));
  }
  EXPECT_FALSE(adapterLatency("/dev/null", sysfs));
  std::ofstream(folder + "/latency_timer") << "16\n";
  const auto latency = adapterLatency("/dev/null", sysfs);
  ASSERT_TRUE(latency);
  EXPECT_EQ(milliseconds(16), latency->latency);
  EXPECT_EQ(folder + "/latency_timer", latency->file);
  std::ofstream(folder + "/latency_timer") << "nonsense\n";
  EXPECT_FALSE(adapterLatency("/dev/null", sysfs));
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus

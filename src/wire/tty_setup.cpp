// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "tty_setup.h"

#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>

#include <boost/system/error_code.hpp>
#include <cerrno>
#include <cstring>

namespace inverter_bus
{
namespace wire
{
namespace
{
// Unix 98 pseudo-terminal slaves (Linux Documentation/admin-guide/devices.txt).
constexpr unsigned FIRST_PTS_MAJOR = 136;
constexpr unsigned LAST_PTS_MAJOR = 143;

using boost::asio::serial_port;
using boost::asio::serial_port_base;

serial_port_base::parity parityOption(Parity parity)
{
  switch (parity)
  {
    case Parity::Even:
      return serial_port_base::parity(serial_port_base::parity::even);
    case Parity::Odd:
      return serial_port_base::parity(serial_port_base::parity::odd);
    case Parity::None:
      break;
  }
  return serial_port_base::parity(serial_port_base::parity::none);
}

serial_port_base::stop_bits stopBitsOption(unsigned stop_bits)
{
  return serial_port_base::stop_bits(stop_bits == 2 ? serial_port_base::stop_bits::two
                                                    : serial_port_base::stop_bits::one);
}

/// Raw mode: every byte value passes both ways as it is, and a read returns what is there.
void makeRaw(int tty)
{
  termios attributes{};
  if (::tcgetattr(tty, &attributes) != 0)
  {
    return;
  }
  ::cfmakeraw(&attributes);
  attributes.c_iflag &= ~static_cast<tcflag_t>(IXOFF | IXANY | INPCK);
  attributes.c_iflag |= IGNPAR;
  attributes.c_cflag |= CREAD | CLOCAL;
  // RTS keeps its level at the close, so that a transmitter which it switches stays off.
  attributes.c_cflag &= ~static_cast<tcflag_t>(HUPCL);
  // With 0 a read without data would return 0, which means hang-up here.
  attributes.c_cc[VMIN] = 1;
  attributes.c_cc[VTIME] = 0;
  ::tcsetattr(tty, TCSANOW, &attributes);
}

/// The driver may take a request and do something else without a word: compares what is set with what was asked for.
std::string findDifference(int tty, const SerialSettings& settings)
{
  termios actual{};
  termios wanted{};
  boost::system::error_code ignored;
  if (::tcgetattr(tty, &actual) != 0)
  {
    return std::strerror(errno);
  }
  serial_port_base::baud_rate(settings.baud_rate).store(wanted, ignored);
  serial_port_base::character_size(settings.data_bits).store(wanted, ignored);
  parityOption(settings.parity).store(wanted, ignored);
  stopBitsOption(settings.stop_bits).store(wanted, ignored);
  const tcflag_t differing = actual.c_cflag ^ wanted.c_cflag;
  if (::cfgetospeed(&actual) != ::cfgetospeed(&wanted))
  {
    return "it does not take the baud rate " + std::to_string(settings.baud_rate);
  }
  if ((differing & (PARENB | PARODD)) != 0)
  {
    return "it does not take the parity";
  }
  if ((differing & CSIZE) != 0)
  {
    return "it does not take " + std::to_string(settings.data_bits) + " data bits";
  }
  return (differing & CSTOPB) != 0 ? "it does not take " + std::to_string(settings.stop_bits) + " stop bits" : "";
}
}  // namespace

bool isPseudoTerminal(int tty)
{
  struct stat status = {};
  if (::fstat(tty, &status) != 0 || !S_ISCHR(status.st_mode))
  {
    return false;
  }
  const unsigned number = major(status.st_rdev);
  return number >= FIRST_PTS_MAJOR && number <= LAST_PTS_MAJOR;
}

bool lockTty(int tty, bool pseudo_terminal)
{
  // The lock lies on the device itself, whatever link it was opened through.
  if (::flock(tty, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
  {
    return false;
  }
  if (!pseudo_terminal)
  {
    // Keeps out programs that know no flock.
    ::ioctl(tty, TIOCEXCL);
  }
  return true;
}

void unlockTty(int tty, bool pseudo_terminal)
{
  if (!pseudo_terminal)
  {
    ::ioctl(tty, TIOCNXCL);
  }
  ::flock(tty, LOCK_UN);
}

std::string configureTty(serial_port& port, const SerialSettings& settings, bool pseudo_terminal)
{
  const int tty = port.native_handle();
  makeRaw(tty);
  boost::system::error_code refused;
  port.set_option(serial_port_base::baud_rate(settings.baud_rate), refused);
  if (refused)
  {
    return "it does not take the baud rate " + std::to_string(settings.baud_rate);
  }
  // One by one, and judged together at the end by what has been taken over: a driver that refuses one of them may be
  // content when the others are set.
  port.set_option(serial_port_base::flow_control(serial_port_base::flow_control::none), refused);
  port.set_option(serial_port_base::character_size(settings.data_bits), refused);
  port.set_option(parityOption(settings.parity), refused);
  port.set_option(stopBitsOption(settings.stop_bits), refused);
  // A pseudo-terminal has no bits on a wire: it drops parity and 7 data bits, and glibc then reports EINVAL.
  return pseudo_terminal ? "" : findDifference(tty, settings);
}

std::string enableKernelRs485(int tty)
{
  serial_rs485 configuration{};
  if (::ioctl(tty, TIOCGRS485, &configuration) != 0)
  {
    return std::strerror(errno);
  }
  // Polarity and delays may stand in the device tree: kept, unless there is no polarity at all.
  configuration.flags |= SER_RS485_ENABLED;
  if ((configuration.flags & (SER_RS485_RTS_ON_SEND | SER_RS485_RTS_AFTER_SEND)) == 0)
  {
    configuration.flags |= SER_RS485_RTS_ON_SEND;
  }
  return ::ioctl(tty, TIOCSRS485, &configuration) == 0 ? "" : std::strerror(errno);
}

bool hasRts(int tty)
{
  int lines = 0;
  return ::ioctl(tty, TIOCMGET, &lines) == 0;
}

void requestLowLatency(int tty)
{
  serial_struct information{};
  constexpr int LOW_LATENCY = static_cast<int>(ASYNC_LOW_LATENCY);
  if (::ioctl(tty, TIOCGSERIAL, &information) == 0 && (information.flags & LOW_LATENCY) == 0)
  {
    information.flags |= LOW_LATENCY;
    ::ioctl(tty, TIOCSSERIAL, &information);
  }
}
}  // namespace wire
}  // namespace inverter_bus

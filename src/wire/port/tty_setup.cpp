// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "wire/port/tty_setup.h"

#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>

#include <cerrno>
#include <cstring>

#include "wire/port/tty_attributes.h"
#include "wire/port/uart_rate.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
// Unix 98 pseudo-terminal slaves (Linux Documentation/admin-guide/devices.txt).
constexpr unsigned FIRST_PTS_MAJOR = 136;
constexpr unsigned LAST_PTS_MAJOR = 143;

/// The rate that is used in place of 38400, set by setserial's spd_hi to spd_cust.
constexpr unsigned REPLACED_BAUD_RATE = 38400;

/// Bytes go from the line to the reader and back: no modem, time receiver or joystick driver in between.
bool usePlainDiscipline(int tty)
{
  int discipline = N_TTY;
  if (::ioctl(tty, TIOCGETD, &discipline) != 0 || discipline == N_TTY)
  {
    return true;
  }
  discipline = N_TTY;
  return ::ioctl(tty, TIOCSETD, &discipline) == 0;
}

/// No rate behind 38400, and no collecting of bytes before they are delivered. False if 38400 stays another rate; not
/// every driver knows these flags, and nothing else depends on them.
bool setDriverFlags(int tty)
{
  serial_struct information{};
  constexpr int LOW_LATENCY = static_cast<int>(ASYNC_LOW_LATENCY);
  constexpr int REPLACED_RATE = static_cast<int>(ASYNC_SPD_MASK);
  if (::ioctl(tty, TIOCGSERIAL, &information) != 0)
  {
    return true;
  }
  const int wanted = (information.flags | LOW_LATENCY) & ~REPLACED_RATE;
  if (information.flags != wanted)
  {
    information.flags = wanted;
    ::ioctl(tty, TIOCSSERIAL, &information);
  }
  return ::ioctl(tty, TIOCGSERIAL, &information) != 0 || (information.flags & REPLACED_RATE) == 0;
}

/// The settings that only a real port has. Returns the one that was refused, in words.
std::string configureDriver(int tty, const SerialSettings& settings)
{
  ::ioctl(tty, TIOCCBRK);
  if (!usePlainDiscipline(tty))
  {
    return "another program has given it a line discipline that cannot be removed";
  }
  if (!setDriverFlags(tty) && settings.baud_rate == REPLACED_BAUD_RATE)
  {
    return "it does not accept the baud rate 38400: setserial has put another one in its place (spd_normal ends that)";
  }
  return "";
}

std::string judgeRateOf(const SerialSettings& settings, unsigned actual, const std::string& sysfs)
{
  const auto clock = uartClock(settings.device, sysfs);
  return clock ? judgeUartRate(*clock, settings.baud_rate, actual) : judgeRate(settings.baud_rate, actual);
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

LockResult lockTty(int tty, bool pseudo_terminal)
{
  // The lock is on the device file, whatever link it was opened through.
  if (::flock(tty, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
  {
    return LockResult::Locked;
  }
  if (pseudo_terminal)
  {
    return LockResult::Taken;
  }
  // Root passes TIOCEXCL, and in containers everybody is root. It stays set when its owner is killed for as long as any
  // other process has the port open: then the port is in use, too.
  int exclusive = 0;
  if (::ioctl(tty, TIOCGEXCL, &exclusive) == 0 && exclusive != 0)
  {
    ::flock(tty, LOCK_UN);
    return LockResult::Exclusive;
  }
  // Keeps out programs that know no flock.
  ::ioctl(tty, TIOCEXCL);
  return LockResult::Taken;
}

void unlockTty(int tty, bool pseudo_terminal)
{
  if (!pseudo_terminal)
  {
    ::ioctl(tty, TIOCNXCL);
  }
  ::flock(tty, LOCK_UN);
}

std::string configureTty(int tty, const SerialSettings& settings, bool pseudo_terminal, const std::string& sysfs)
{
  std::string reason = pseudo_terminal ? "" : configureDriver(tty, settings);
  if (!reason.empty())
  {
    return reason;
  }
  // Output that another program has stopped (XOFF) would never leave.
  ::tcflow(tty, TCOON);
  const TtyAttributes attributes = setTtyAttributes(tty, settings, pseudo_terminal);
  if (!attributes.refused.empty() || pseudo_terminal)
  {
    return attributes.refused;
  }
  return judgeRateOf(settings, attributes.baud_rate, sysfs);
}

std::string enableKernelRs485(int tty)
{
  serial_rs485 configuration{};
  if (::ioctl(tty, TIOCGRS485, &configuration) != 0)
  {
    return std::strerror(errno);
  }
  // Polarity and delays may be in the device tree: kept, unless there is no polarity at all.
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
}  // namespace wire
}  // namespace inverter_bus

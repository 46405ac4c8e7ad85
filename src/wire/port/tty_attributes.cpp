// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The only file with the kernel's own termios2, which takes any baud rate (ioctl_tty(2), TCSETS2 and BOTHER). Its header
// and the C library's <termios.h> exclude each other.
#include "wire/port/tty_attributes.h"

#include <asm/termbits.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>

namespace inverter_bus
{
namespace wire
{
namespace
{
struct RateConstant
{
  unsigned baud_rate;
  tcflag_t bits;
};

/// Preferred where there is one: every driver and every program that looks at the port later knows them.
constexpr RateConstant RATE_CONSTANTS[] = {
  { 50, B50 },           { 75, B75 },           { 110, B110 },         { 134, B134 },         { 150, B150 },
  { 200, B200 },         { 300, B300 },         { 600, B600 },         { 1200, B1200 },       { 1800, B1800 },
  { 2400, B2400 },       { 4800, B4800 },       { 9600, B9600 },       { 19200, B19200 },     { 38400, B38400 },
  { 57600, B57600 },     { 115200, B115200 },   { 230400, B230400 },   { 460800, B460800 },   { 500000, B500000 },
  { 576000, B576000 },   { 921600, B921600 },   { 1000000, B1000000 }, { 1152000, B1152000 }, { 1500000, B1500000 },
  { 2000000, B2000000 }, { 2500000, B2500000 }, { 3000000, B3000000 }, { 3500000, B3500000 }, { 4000000, B4000000 }
};

tcflag_t rateBits(unsigned baud_rate)
{
  const auto* const constant = std::find_if(std::begin(RATE_CONSTANTS), std::end(RATE_CONSTANTS),
                                            [&](const RateConstant& known) { return known.baud_rate == baud_rate; });
  return constant == std::end(RATE_CONSTANTS) ? BOTHER : constant->bits;
}

tcflag_t controlFlags(const SerialSettings& settings)
{
  // Not in it: HUPCL, so that RTS keeps its level at the close and a transmitter which it switches stays off.
  tcflag_t flags = CREAD | CLOCAL | rateBits(settings.baud_rate);
  flags |= settings.data_bits == 7 ? CS7 : CS8;
  flags |= settings.stop_bits == 2 ? CSTOPB : 0;
  flags |= settings.parity == Parity::None ? 0 : PARENB;
  flags |= settings.parity == Parity::Odd ? PARODD : 0;
  return flags;
}

/// Raw: every byte value passes both ways as it is, and a read returns what is there.
void apply(const SerialSettings& settings, termios2& attributes)
{
  // With parity, a byte that has it wrong is dropped: the eight-bit check of CompoWay/F would let some pass.
  attributes.c_iflag = IGNPAR | (settings.parity == Parity::None ? 0U : static_cast<tcflag_t>(INPCK));
  attributes.c_oflag = 0;
  attributes.c_lflag = 0;
  attributes.c_cflag = controlFlags(settings);
  attributes.c_ispeed = settings.baud_rate;
  attributes.c_ospeed = settings.baud_rate;
  // With 0 a read without data would return 0, which means hang-up here.
  attributes.c_cc[VMIN] = 1;
  attributes.c_cc[VTIME] = 0;
}

bool isRaw(const termios2& actual, const termios2& wanted)
{
  return actual.c_iflag == wanted.c_iflag && actual.c_oflag == wanted.c_oflag && actual.c_lflag == wanted.c_lflag &&
         actual.c_cc[VMIN] == wanted.c_cc[VMIN] && actual.c_cc[VTIME] == wanted.c_cc[VTIME];
}

/// The driver may take a request and do something else without a word.
std::string findDifference(const termios2& actual, const termios2& wanted, const SerialSettings& settings,
                           bool pseudo_terminal)
{
  const tcflag_t without = pseudo_terminal ? tcflag_t{ PARENB | PARODD | CSIZE | CSTOPB } : tcflag_t{ 0 };
  const tcflag_t differing = (actual.c_cflag ^ wanted.c_cflag) & ~without;
  if (!isRaw(actual, wanted))
  {
    return "it cannot be set to raw mode";
  }
  if ((differing & (PARENB | PARODD | CMSPAR)) != 0)
  {
    return "it does not accept the parity";
  }
  if ((differing & CSIZE) != 0)
  {
    return "it does not accept " + std::to_string(settings.data_bits) + " data bits";
  }
  if ((differing & CSTOPB) != 0)
  {
    return "it does not accept " + std::to_string(settings.stop_bits) + " stop bits";
  }
  if ((differing & CRTSCTS) != 0)
  {
    return "its hardware flow control cannot be switched off";
  }
  return (differing & (CLOCAL | CREAD)) != 0 ? "it does not work without modem lines" : "";
}
}  // namespace

TtyAttributes setTtyAttributes(int tty, const SerialSettings& settings, bool pseudo_terminal)
{
  TtyAttributes result;
  termios2 wanted{};
  if (::ioctl(tty, TCGETS2, &wanted) != 0)
  {
    result.refused = std::strerror(errno);
    return result;
  }
  apply(settings, wanted);
  termios2 actual{};
  if (::ioctl(tty, TCSETS2, &wanted) != 0 || ::ioctl(tty, TCGETS2, &actual) != 0)
  {
    result.refused = std::string("its driver refuses the settings: ") + std::strerror(errno);
    return result;
  }
  result.baud_rate = actual.c_ospeed;
  result.refused = findDifference(actual, wanted, settings, pseudo_terminal);
  return result;
}
}  // namespace wire
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/line/terminal_settings.h"

// termios2 has the rate as a number; its header and <termios.h> exclude each other.
#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <sys/ioctl.h>

namespace inverter_bus
{
namespace simulation
{
std::optional<LineSettings> settingsOf(int descriptor, const LineSettings& assumed)
{
  termios2 terminal{};
  if (ioctl(descriptor, TCGETS2, &terminal) != 0 || terminal.c_ospeed == 0)
  {
    return std::nullopt;
  }
  LineSettings settings = assumed;
  settings.baud_rate = static_cast<int>(terminal.c_ospeed);
  settings.stop_bits = (terminal.c_cflag & CSTOPB) != 0 ? 2 : 1;
  settings.parity = (terminal.c_cflag & PARODD) != 0  ? Parity::Odd
                    : (terminal.c_iflag & INPCK) != 0 ? Parity::Even
                                                      : Parity::None;
  return settings;
}

void setTerminal(int descriptor, const LineSettings& settings)
{
  termios2 terminal{};
  if (ioctl(descriptor, TCGETS2, &terminal) != 0)
  {
    return;
  }
  // As cfmakeraw() does.
  terminal.c_iflag &= ~static_cast<tcflag_t>(IGNBRK | BRKINT | PARMRK | ISTRIP | INLCR | IGNCR | ICRNL | IXON | INPCK);
  terminal.c_oflag &= ~static_cast<tcflag_t>(OPOST);
  terminal.c_lflag &= ~static_cast<tcflag_t>(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
  terminal.c_cflag &= ~static_cast<tcflag_t>(CBAUD | CSIZE | PARENB | PARODD | CSTOPB);
  terminal.c_cflag |= CS8 | BOTHER;
  terminal.c_ispeed = static_cast<speed_t>(settings.baud_rate);
  terminal.c_ospeed = static_cast<speed_t>(settings.baud_rate);
  terminal.c_cflag |= settings.stop_bits == 2 ? CSTOPB : 0U;
  terminal.c_cflag |= settings.parity == Parity::Odd ? PARODD : 0U;
  terminal.c_iflag |= settings.parity == Parity::None ? 0U : static_cast<tcflag_t>(INPCK);
  ioctl(descriptor, TCSETS2, &terminal);
}
}  // namespace simulation
}  // namespace inverter_bus

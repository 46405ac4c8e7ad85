// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "wire/port/uart_rate.h"

#include <linux/serial.h>
#include <linux/serial_core.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "util/text.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
constexpr double TOLERANCE = 0.02;
/// An 8250 samples a bit so many times.
constexpr unsigned SAMPLES_PER_BIT = 16;
/// uart_get_baud_rate() of the kernel goes so much above the fastest rate.
constexpr double KERNEL_TOLERANCE = 0.01;
/// The last number that the kernel gives to a relative of the 8250 (include/linux/serial_core.h).
constexpr long LAST_OF_THE_8250_FAMILY = PORT_16550A_FSL64;

bool dividesByWholeNumbers(long type)
{
  // A prescaler, a multiplier or a fraction: these come closer to a rate than a whole divisor does.
  static constexpr long OTHERS[] = { PORT_16C950, PORT_NS16550A, PORT_XR17D15X, PORT_XR17V35X };
  return type > PORT_UNKNOWN && type <= LAST_OF_THE_8250_FAMILY &&
         std::find(std::begin(OTHERS), std::end(OTHERS), type) == std::end(OTHERS);
}

bool near(double actual, unsigned baud_rate)
{
  return std::abs(actual - baud_rate) <= TOLERANCE * baud_rate;
}

std::string refusal(unsigned baud_rate)
{
  return "it does not accept the baud rate " + std::to_string(baud_rate) + ": ";
}
}  // namespace

std::optional<unsigned> uartClock(const std::string& device, const std::string& sysfs)
{
  const std::string folder = ttyFolder(device, sysfs);
  const auto type = readNumber(folder + "/type");
  const auto clock = readNumber(folder + "/uartclk");
  const bool usable = !folder.empty() && type && dividesByWholeNumbers(*type) && clock && *clock >= SAMPLES_PER_BIT;
  return usable ? std::optional<unsigned>(static_cast<unsigned>(*clock)) : std::nullopt;
}

std::string judgeUartRate(unsigned clock, unsigned baud_rate, unsigned actual)
{
  const double fastest = static_cast<double>(clock) / SAMPLES_PER_BIT;
  if (baud_rate > fastest * (1.0 + KERNEL_TOLERANCE))
  {
    return refusal(baud_rate) + "its UART stays at " + std::to_string(actual) +
           ", its fastest rate and the next one that works is " + util::numberText(std::round(fastest));
  }
  const double divisor = std::max(1.0, std::round(fastest / baud_rate));
  if (near(fastest / divisor, baud_rate))
  {
    return judgeRate(baud_rate, actual);
  }
  const double faster = fastest / std::max(1.0, std::floor(fastest / baud_rate));
  const double slower = fastest / std::ceil(fastest / baud_rate);
  return refusal(baud_rate) + "its UART would run at " + util::numberText(std::round(fastest / divisor)) +
         "; the next rates that work are " + util::numberText(std::round(slower)) + " and " +
         util::numberText(std::round(faster));
}

std::string judgeRate(unsigned baud_rate, unsigned actual)
{
  return near(actual, baud_rate) ? "" : refusal(baud_rate) + "its driver runs at " + std::to_string(actual);
}
}  // namespace wire
}  // namespace inverter_bus

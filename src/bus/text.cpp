// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "text.h"

#include <cstdio>
#include <locale>
#include <sstream>

namespace inverter_bus
{
namespace bus
{
namespace text
{
std::string duration(Duration duration)
{
  const double value = toSeconds(duration);
  char text[32];
  if (value < 1.0)
  {
    std::snprintf(text, sizeof text, "%.3g ms", value * 1e3);
  }
  else
  {
    std::snprintf(text, sizeof text, "%.10g s",
                  static_cast<double>(static_cast<long long>(value * 100.0 + 0.5)) / 100.0);
  }
  return text;
}

std::string number(double value)
{
  constexpr int DIGITS = 9;
  std::ostringstream text;
  // A message looks the same whatever the user's locale writes for a decimal point.
  text.imbue(std::locale::classic());
  text.precision(DIGITS);
  text << value;
  return text.str();
}
}  // namespace text
}  // namespace bus
}  // namespace inverter_bus

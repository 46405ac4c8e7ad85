// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/bus/number_text.h"

#include <locale>
#include <sstream>

namespace inverter_bus
{
namespace bus
{
std::string numberText(double value)
{
  constexpr int DIGITS = 9;
  std::ostringstream text;
  // A message looks the same whatever the user's locale writes for a decimal point.
  text.imbue(std::locale::classic());
  text.precision(DIGITS);
  text << value;
  return text.str();
}
}  // namespace bus
}  // namespace inverter_bus

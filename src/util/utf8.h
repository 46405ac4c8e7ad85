// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_UTIL_UTF8_H
#define INVERTER_BUS_UTIL_UTF8_H

#include <cstddef>
#include <cstdint>
#include <string>

namespace inverter_bus
{
namespace util
{
/// One character of a text.
struct Character
{
  std::size_t length =
      0;  ///< [bytes] 0: no UTF-8 character stands here (surrogates and needlessly long forms are none)
  std::uint32_t code = 0;
};

/// \p place must lie inside \p text.
Character characterAt(const std::string& text, std::size_t place);
}  // namespace util
}  // namespace inverter_bus

#endif  // INVERTER_BUS_UTIL_UTF8_H

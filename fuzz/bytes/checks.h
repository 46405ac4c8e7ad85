// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_H
#define INVERTER_BUS_FUZZ_CHECKS_H

#include <cstddef>
#include <cstdint>
#include <string>

#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace fuzz
{
/// Ends the program with \p what unless \p condition: a finding.
void require(bool condition, const char* what);

/// The same for a message that is to be one line for the user.
void requireOneLine(const std::string& message);

/// The input, taken piece by piece; zeros behind its end.
class ByteSource
{
public:
  ByteSource(const std::uint8_t* data, std::size_t size);

  bool empty() const;
  std::uint8_t byte();
  /// Up to \p count bytes.
  wire::Bytes bytes(std::size_t count);
  wire::Bytes rest();

private:
  const std::uint8_t* data_;
  std::size_t size_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_H

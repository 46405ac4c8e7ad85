// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/link/own_exceptions.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
/// Modbus application protocol V1.1b3, section 7: illegal function, address and value.
constexpr unsigned LAST_COMMON_CODE = 0x03;
constexpr unsigned DEVICE_FAILURE = 0x04;
constexpr unsigned GATEWAY_PATH_UNAVAILABLE = 0x0A;
constexpr unsigned GATEWAY_TARGET_FAILED = 0x0B;
}  // namespace

wire::ExceptionCodes ownExceptions(const std::map<unsigned, std::string>& listed, bool data_lately)
{
  wire::ExceptionCodes own;
  for (unsigned code = 1; listed.empty() && code <= LAST_COMMON_CODE; ++code)
  {
    own.set(code);
  }
  for (const auto& exception : listed)
  {
    const unsigned code = exception.first;
    const bool by_gateway = code == GATEWAY_PATH_UNAVAILABLE || code == GATEWAY_TARGET_FAILED;
    if (code < own.size() && !by_gateway && (code != DEVICE_FAILURE || data_lately))
    {
      own.set(code);
    }
  }
  return own;
}
}  // namespace bus
}  // namespace inverter_bus

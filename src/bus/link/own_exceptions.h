// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_OWN_EXCEPTIONS_H
#define INVERTER_BUS_BUS_OWN_EXCEPTIONS_H

#include <map>
#include <string>

#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace bus
{
/// Exceptions over Modbus TCP that are the drive's own refusal and not a gateway's report of silence (contract, 8.7).
/// \p listed the codes of the drive's profile; none: 01 to 03, which every drive has. \p data_lately: the drive itself has
/// answered with data lately; otherwise 04 is how a gateway reports damaged replies.
wire::ExceptionCodes ownExceptions(const std::map<unsigned, std::string>& listed, bool data_lately);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_OWN_EXCEPTIONS_H

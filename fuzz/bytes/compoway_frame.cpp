// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Frames of CompoWay/F, as they come from a serial line.
#include "line_run.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  static const auto DIALECT = inverter_bus::fuzz::makeCompowayDialect();
  inverter_bus::fuzz::runLine(*DIALECT, data, size);
  return 0;
}

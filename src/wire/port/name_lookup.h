// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_NAME_LOOKUP_H
#define INVERTER_BUS_WIRE_NAME_LOOKUP_H

#include <memory>
#include <string>
#include <vector>

#include "inverter_bus/wire/tcp_port.h"

namespace inverter_bus
{
namespace wire
{
/// Looks up a host name in a thread of its own, for the system's resolver may block for half a minute and cannot be
/// cancelled. (Boost.Asio's asynchronous resolver waits for it at its end.)
class NameLookup
{
public:
  NameLookup(std::string host, NameResolver resolver);

  /// The addresses in numbers, as soon as they are there or at \p deadline; none, and \p error says why, if there are
  /// none. A look-up that is not over by then goes on, and the next call takes its result.
  std::vector<std::string> find(TimePoint deadline, std::string& error);

  /// A look-up has not ended, or its result has not been taken.
  bool goesOn() const;

private:
  struct Lookup;

  bool start(std::string& error);

  std::string host_;
  NameResolver resolver_;
  /// While a look-up goes on or its result has not been taken. Its thread has a share in it, for it may outlive this.
  std::shared_ptr<Lookup> pending_;
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_NAME_LOOKUP_H

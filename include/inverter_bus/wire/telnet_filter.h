// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_TELNET_FILTER_H
#define INVERTER_BUS_WIRE_TELNET_FILTER_H

#include <cstddef>
#include <cstdint>

#include "inverter_bus/wire/port.h"

namespace inverter_bus
{
namespace wire
{
/// Notices that the server at the other end speaks telnet (RFC 854), which eats FFH and the byte behind it, and then
/// writes and reads as telnet does. Two option negotiations (FF FB to FE, option) before the first valid reply of a
/// connection reveal it (contract, 8.11): no frame of a drive begins with FFH.
class TelnetFilter
{
public:
  /// A new connection.
  void forget();
  /// A valid reply came as it was: from now on nothing counts as telnet unless it was found before.
  void proven();
  bool found() const;

  /// The bytes of \p buffer from \p begin on have just arrived: takes out what is telnet's own. At the finding in all of
  /// \p buffer.
  void receive(Bytes& buffer, std::size_t begin);
  /// \p frame as it must be sent.
  Bytes sent(const Bytes& frame) const;

private:
  enum class State
  {
    Data,
    /// FFH came: a command follows, or FFH once more for the byte itself.
    Command,
    /// The option's number follows.
    Option,
    /// Inside a subnegotiation, up to FF F0.
    Subnegotiation,
    SubnegotiationCommand
  };
  /// True if \p byte is data.
  bool takes(std::uint8_t byte);

  State state_ = State::Data;
  unsigned negotiations_ = 0;
  bool looking_ = true;
  bool found_ = false;
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_TELNET_FILTER_H

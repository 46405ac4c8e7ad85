// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_TCP_PORT_H
#define INVERTER_BUS_WIRE_TCP_PORT_H

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/wire/port.h"

namespace inverter_bus
{
namespace wire
{
/// Port number that IANA has given to Modbus TCP.
constexpr std::uint16_t MODBUS_TCP_PORT = 502;

struct TcpAddress
{
  /// Name, IPv4 address, or IPv6 address without brackets.
  std::string host;
  /// 1 to 65535.
  std::uint16_t port = 0;
};

/// "host:port", "host", "[::1]:502" or "[::1]". \p default_port applies where none is given; 0: it must be given.
/// Empty if \p text is not an address, and \p error then says why, in half a sentence.
std::optional<TcpAddress> parseTcpAddress(const std::string& text, std::uint16_t default_port, std::string& error);

/// The addresses of \p host in numbers, best first; none, and \p error says why, if it has none. May block for long: it
/// is called in a thread of its own, which may outlive the port.
using NameResolver = std::function<std::vector<std::string>(const std::string& host, std::string& error)>;

/// Asks the system: /etc/hosts, DNS, mDNS.
std::vector<std::string> resolveName(const std::string& host, std::string& error);

/// A TCP connection to a gateway: Modbus TCP, or a serial device server that passes bytes on as they are.
///
/// open() is Pending for 1 s at most, looking up the name included. A frame that the other side does not acknowledge within 1 s
/// makes the port gone and is thrown away with it, so that no command arrives long after it was sent.
/// \p name as the user wrote it, for messages.
std::unique_ptr<Port> makeTcpPort(const TcpAddress& address, const std::string& name,
                                  NameResolver resolver = resolveName);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_TCP_PORT_H

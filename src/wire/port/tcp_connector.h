// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_TCP_CONNECTOR_H
#define INVERTER_BUS_WIRE_TCP_CONNECTOR_H

#include <boost/asio/ip/tcp.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/wire/tcp_port.h"
#include "wire/port/name_lookup.h"

namespace inverter_bus
{
namespace wire
{
/// setsockopt(2); a system that lacks the option does without it.
void setOption(int socket, int level, int option, int value);

/// The error of \p socket (SO_ERROR), 0: none. Asking clears it.
int socketError(int socket);

/// Makes a connection in small steps: looks up the name, then tries one address after the other. A dead network takes
/// seconds to show, and meanwhile the thread has other duties.
class TcpConnector
{
public:
  enum class Progress
  {
    Connected,
    Failed,
    /// Call step() again.
    Pending
  };

  TcpConnector(const TcpAddress& address, NameResolver resolver);

  /// Goes on, or begins; returns after 40 ms at the latest. All steps of one attempt together take 1 s at most.
  /// \p socket becomes open while the attempt goes on, and is closed when it has failed, for the \p reason said.
  Progress step(boost::asio::ip::tcp::socket& socket, std::string& reason);
  /// Forgets the attempt; the socket is the caller's to close.
  void cancel();
  /// An attempt goes on.
  bool active() const;

private:
  struct Attempt
  {
    TimePoint deadline;
    /// Looked up; empty before.
    std::vector<std::string> addresses;
    /// The address under way, and when the next one's turn is.
    std::size_t index = 0;
    bool calling = false;
    TimePoint call_deadline;
    /// Why the last one failed.
    std::string reason;
  };

  bool lookUp(TimePoint until);
  void call(boost::asio::ip::tcp::socket& socket);
  bool answered(boost::asio::ip::tcp::socket& socket, TimePoint until);
  boost::system::error_code outcome(boost::asio::ip::tcp::socket& socket) const;
  void next(boost::asio::ip::tcp::socket& socket, const std::string& reason);
  boost::asio::ip::tcp::endpoint endpoint(boost::system::error_code& failure) const;

  TcpAddress address_;
  NameLookup lookup_;
  std::optional<Attempt> attempt_;
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_TCP_CONNECTOR_H

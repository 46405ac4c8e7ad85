// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "wire/port/tcp_connector.h"

#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <utility>

#include "wire/port/poll_descriptor.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using boost::asio::ip::tcp;
using std::chrono::steady_clock;

/// The longest time for an attempt: far more than a host on the same network needs.
constexpr std::chrono::seconds LONGEST_OPENING{ 1 };
/// Port::open() must return within 50 ms.
constexpr std::chrono::milliseconds LONGEST_STEP{ 40 };
/// Without an acknowledgement for so long the other side is gone.
constexpr std::chrono::milliseconds LONGEST_SENDING{ 1000 };
/// Probes of a silent connection, in seconds: it is given up after about 5 s.
constexpr int KEEPALIVE_IDLE_S = 2;
constexpr int KEEPALIVE_INTERVAL_S = 1;
constexpr int KEEPALIVE_PROBES = 3;

void configureSocket(int socket)
{
  setOption(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  setOption(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
  setOption(socket, IPPROTO_TCP, TCP_KEEPIDLE, KEEPALIVE_IDLE_S);
  setOption(socket, IPPROTO_TCP, TCP_KEEPINTVL, KEEPALIVE_INTERVAL_S);
  setOption(socket, IPPROTO_TCP, TCP_KEEPCNT, KEEPALIVE_PROBES);
  // Otherwise what was sent into a dead network would be repeated for a quarter of an hour, and an old RUN would arrive
  // when the network is back.
  setOption(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, static_cast<int>(LONGEST_SENDING.count()));
}
}  // namespace

void setOption(int socket, int level, int option, int value)
{
  ::setsockopt(socket, level, option, &value, sizeof(value));
}

int socketError(int socket)
{
  int error = 0;
  socklen_t size = sizeof(error);
  return ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

TcpConnector::TcpConnector(const TcpAddress& address, NameResolver resolver)
  : address_(address), lookup_(address.host, std::move(resolver))
{
}

void TcpConnector::cancel()
{
  attempt_.reset();
}

bool TcpConnector::active() const
{
  return attempt_.has_value();
}

TcpConnector::Progress TcpConnector::step(tcp::socket& socket, std::string& reason)
{
  const TimePoint until = steady_clock::now() + LONGEST_STEP;
  if (!attempt_)
  {
    attempt_ = Attempt();
    attempt_->deadline = steady_clock::now() + LONGEST_OPENING;
  }
  if (attempt_->addresses.empty() && !lookUp(until))
  {
    return Progress::Pending;
  }
  while (attempt_->index < attempt_->addresses.size())
  {
    if (!attempt_->calling)
    {
      call(socket);
    }
    else if (!answered(socket, until))
    {
      return Progress::Pending;
    }
    else if (socket.is_open())
    {
      attempt_.reset();
      return Progress::Connected;
    }
  }
  reason = attempt_->reason;
  attempt_.reset();
  return Progress::Failed;
}

/// False: no answer yet. True without an address: there is none.
bool TcpConnector::lookUp(TimePoint until)
{
  Attempt& attempt = *attempt_;
  attempt.addresses = lookup_.find(std::min(until, attempt.deadline), attempt.reason);
  if (attempt.addresses.empty() && lookup_.goesOn() && steady_clock::now() < attempt.deadline)
  {
    return false;
  }
  const bool nameless = attempt.addresses.empty() && attempt.reason.empty();
  attempt.reason = nameless ? "its name has no address" : attempt.reason;
  return true;
}

tcp::endpoint TcpConnector::endpoint(boost::system::error_code& failure) const
{
  return { boost::asio::ip::make_address(attempt_->addresses[attempt_->index], failure), address_.port };
}

/// As connect(2), in the background. Not by Asio, whose connect waits as long as the system does.
void TcpConnector::call(tcp::socket& socket)
{
  boost::system::error_code failure;
  const tcp::endpoint there = endpoint(failure);
  if (!failure)
  {
    socket.open(there.protocol(), failure);
  }
  if (!failure)
  {
    socket.non_blocking(true, failure);
  }
  if (!failure)
  {
    configureSocket(socket.native_handle());
    if (::connect(socket.native_handle(), there.data(), static_cast<socklen_t>(there.size())) != 0 &&
        errno != EINPROGRESS)
    {
      failure.assign(errno, boost::system::system_category());
    }
  }
  if (failure)
  {
    next(socket, failure.message());
    return;
  }
  // One that does not answer leaves time for the others.
  const TimePoint now = steady_clock::now();
  const auto left = static_cast<int>(attempt_->addresses.size() - attempt_->index);
  attempt_->call_deadline = now + (attempt_->deadline - now) / left;
  attempt_->calling = true;
}

/// False: goes on. True: the socket is connected, or closed and the next address has its turn.
bool TcpConnector::answered(tcp::socket& socket, TimePoint until)
{
  const TimePoint deadline = attempt_->call_deadline;
  const bool silent =
      pollDescriptor(socket.native_handle(), POLLOUT, std::min(until, deadline)) == DescriptorState::Silent;
  if (silent && steady_clock::now() < deadline)
  {
    return false;
  }
  const boost::system::error_code failure =
      silent ? boost::system::error_code(boost::asio::error::timed_out) : outcome(socket);
  if (failure)
  {
    next(socket, failure.message());
  }
  return true;
}

boost::system::error_code TcpConnector::outcome(tcp::socket& socket) const
{
  const int refused = socketError(socket.native_handle());
  if (refused != 0)
  {
    return { refused, boost::system::system_category() };
  }
  boost::system::error_code failure;
  const tcp::endpoint there = endpoint(failure);
  // TCP lets a socket call itself where no program listens on a port of this host.
  const bool itself = socket.local_endpoint(failure) == there;
  return itself ? boost::asio::error::connection_refused : failure;
}

void TcpConnector::next(tcp::socket& socket, const std::string& reason)
{
  boost::system::error_code ignored;
  socket.close(ignored);
  attempt_->reason = reason;
  attempt_->calling = false;
  ++attempt_->index;
}
}  // namespace wire
}  // namespace inverter_bus

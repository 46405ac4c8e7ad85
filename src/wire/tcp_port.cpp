// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/wire/tcp_port.h"

#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/system/error_code.hpp>
#include <cerrno>
#include <utility>

#include "name_lookup.h"
#include "poll_descriptor.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using boost::asio::ip::tcp;

constexpr std::size_t READ_SIZE = 512;
/// Longest that open() takes. The bus has nothing else to do meanwhile but to end.
constexpr std::chrono::seconds LONGEST_OPENING{ 1 };
/// Without an acknowledgement or room for the frame for so long the other side is gone.
constexpr std::chrono::milliseconds LONGEST_SENDING{ 1000 };
/// Probes of a silent connection, in seconds: it is given up after about 5 s.
constexpr int KEEPALIVE_IDLE_S = 2;
constexpr int KEEPALIVE_INTERVAL_S = 1;
constexpr int KEEPALIVE_PROBES = 3;

/// A system that lacks an option does without it.
void setOption(int socket, int level, int option, int value)
{
  ::setsockopt(socket, level, option, &value, sizeof(value));
}

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

/// True if the other side has not acknowledged all that was sent.
bool hasUnsent(int socket)
{
  int bytes = 0;
  return ::ioctl(socket, SIOCOUTQ, &bytes) == 0 && bytes > 0;
}

/// Why connect(2) failed in the background; 0 if it has not.
int errorOf(int socket)
{
  int error = 0;
  socklen_t size = sizeof(error);
  return ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

class TcpPort : public Port
{
public:
  TcpPort(const TcpAddress& address, std::string name, NameResolver resolver)
    : address_(address), name_(std::move(name)), lookup_(address.host, std::move(resolver)), socket_(context_)
  {
  }

  ~TcpPort() override
  {
    TcpPort::close();
  }

  TcpPort(const TcpPort&) = delete;
  TcpPort& operator=(const TcpPort&) = delete;

  OpenResult open(std::string& error) override
  {
    close();
    const TimePoint deadline = std::chrono::steady_clock::now() + LONGEST_OPENING;
    std::string reason;
    const std::vector<std::string> addresses = lookup_.find(deadline, reason);
    reason = addresses.empty() && reason.empty() ? "its name has no address" : reason;
    for (std::size_t i = 0; i < addresses.size(); ++i)
    {
      // One that does not answer leaves time for the others.
      const TimePoint now = std::chrono::steady_clock::now();
      const auto left = static_cast<int>(addresses.size() - i);
      reason = connect(addresses[i], now + (deadline - now) / left);
      if (reason.empty())
      {
        return OpenResult::Opened;
      }
    }
    error = "cannot connect to " + name_ + ": " + reason;
    return OpenResult::NotThere;
  }

  void close() override
  {
    if (!socket_.is_open())
    {
      return;
    }
    boost::system::error_code ignored;
    if (hasUnsent(socket_.native_handle()))
    {
      // The system would go on sending after the close.
      socket_.set_option(tcp::socket::linger(true, 0), ignored);
    }
    socket_.close(ignored);
  }

  void abandon() override
  {
    boost::system::error_code ignored;
    if (socket_.is_open())
    {
      // The close then sends RST and throws away what is still to be sent.
      socket_.set_option(tcp::socket::linger(true, 0), ignored);
    }
    close();
  }

  bool isOpen() const override
  {
    return socket_.is_open();
  }

  Loss lastLoss() const override
  {
    return last_loss_;
  }

  bool isNetwork() const override
  {
    return true;
  }

  std::string name() const override
  {
    return name_;
  }

  bool send(const Bytes& frame) override
  {
    const TimePoint deadline = std::chrono::steady_clock::now() + LONGEST_SENDING;
    std::size_t sent = 0;
    while (socket_.is_open() && sent < frame.size() && waitUntilWritable(socket_.native_handle(), deadline))
    {
      // Asio sends with MSG_NOSIGNAL: no SIGPIPE.
      boost::system::error_code failure;
      sent += socket_.write_some(boost::asio::buffer(frame.data() + sent, frame.size() - sent), failure);
      if (failure && !isTemporary(failure))
      {
        last_loss_ = lossBy(failure);
        return false;
      }
    }
    const bool done = socket_.is_open() && sent == frame.size();
    if (!done && socket_.is_open())
    {
      // No room until the deadline: 0. Otherwise why it has hung up.
      last_loss_ = lossBy({ errorOf(socket_.native_handle()), boost::system::system_category() });
    }
    return done;
  }

  ReceiveResult receive(Bytes& buffer, TimePoint deadline) override
  {
    while (socket_.is_open())
    {
      const DescriptorState state = pollDescriptor(socket_.native_handle(), POLLIN, deadline);
      if (state == DescriptorState::Silent)
      {
        return ReceiveResult::Silence;
      }
      // After a hang-up too: what had arrived before it counts.
      boost::system::error_code failure;
      if (readInto(buffer, failure) > 0)
      {
        return ReceiveResult::Data;
      }
      if (state == DescriptorState::HungUp || !isTemporary(failure))
      {
        last_loss_ = lossBy(failure);
        return ReceiveResult::Gone;
      }
    }
    return ReceiveResult::Gone;
  }

private:
  static bool isTemporary(const boost::system::error_code& failure)
  {
    return failure == boost::asio::error::would_block || failure == boost::asio::error::interrupted;
  }

  /// A host that is alive ends a connection by FIN or RST; a dead one or a dead network by the system's patience.
  static Loss lossBy(const boost::system::error_code& failure)
  {
    const bool by_peer = failure == boost::asio::error::eof || failure == boost::asio::error::connection_reset ||
                         failure == boost::asio::error::broken_pipe;
    return by_peer ? Loss::ClosedByPeer : Loss::Gone;
  }

  /// Returns what went wrong; empty if nothing did.
  std::string connect(const std::string& address, TimePoint deadline)
  {
    boost::system::error_code failure;
    const tcp::endpoint endpoint(boost::asio::ip::make_address(address, failure), address_.port);
    if (!failure)
    {
      socket_.open(endpoint.protocol(), failure);
    }
    if (!failure)
    {
      socket_.non_blocking(true, failure);
    }
    if (!failure)
    {
      configureSocket(socket_.native_handle());
      failure = call(endpoint, deadline);
    }
    if (failure)
    {
      close();
    }
    return failure ? failure.message() : "";
  }

  /// As connect(2), until \p deadline. Not by Asio, whose connect waits as long as the system does.
  boost::system::error_code call(const tcp::endpoint& endpoint, TimePoint deadline)
  {
    const int socket = socket_.native_handle();
    if (::connect(socket, endpoint.data(), static_cast<socklen_t>(endpoint.size())) != 0 && errno != EINPROGRESS)
    {
      return { errno, boost::system::system_category() };
    }
    if (pollDescriptor(socket, POLLOUT, deadline) == DescriptorState::Silent)
    {
      return boost::asio::error::timed_out;
    }
    const int refused = errorOf(socket);
    if (refused != 0)
    {
      return { refused, boost::system::system_category() };
    }
    boost::system::error_code failure;
    // TCP lets a socket call itself where nobody listens on a port of this host.
    const bool itself = socket_.local_endpoint(failure) == endpoint;
    return itself ? boost::asio::error::connection_refused : failure;
  }

  /// Appends what is there to \p buffer and returns how much that was.
  std::size_t readInto(Bytes& buffer, boost::system::error_code& failure)
  {
    std::array<std::uint8_t, READ_SIZE> bytes;
    const std::size_t count = socket_.read_some(boost::asio::buffer(bytes), failure);
    buffer.insert(buffer.end(), bytes.begin(), bytes.begin() + count);
    return count;
  }

  TcpAddress address_;
  std::string name_;
  NameLookup lookup_;
  boost::asio::io_context context_;
  tcp::socket socket_;
  Loss last_loss_ = Loss::Gone;
};
}  // namespace

std::unique_ptr<Port> makeTcpPort(const TcpAddress& address, const std::string& name, NameResolver resolver)
{
  return std::make_unique<TcpPort>(address, name, std::move(resolver));
}
}  // namespace wire
}  // namespace inverter_bus

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

#include "wire/port/poll_descriptor.h"
#include "wire/port/tcp_connector.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using boost::asio::ip::tcp;

constexpr std::size_t READ_SIZE = 512;
/// Without an acknowledgement or room for the frame for so long the other side is gone.
constexpr std::chrono::milliseconds LONGEST_SENDING{ 1000 };

/// True if the other side has not acknowledged all that was sent.
bool hasUnsent(int socket)
{
  int bytes = 0;
  return ::ioctl(socket, SIOCOUTQ, &bytes) == 0 && bytes > 0;
}

/// The peer may hold back the rest of a reply until the first part is acknowledged (Nagle), and the system holds back
/// acknowledgements for 40 ms unless set otherwise, again and again: the option does not last (tcp(7)).
void acknowledgeAtOnce(int socket)
{
  setOption(socket, IPPROTO_TCP, TCP_QUICKACK, 1);
}

class TcpPort : public Port
{
public:
  TcpPort(const TcpAddress& address, std::string name, NameResolver resolver)
    : name_(std::move(name)), connector_(address, std::move(resolver)), socket_(context_)
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
    if (!connector_.active())
    {
      close();
    }
    std::string reason;
    const TcpConnector::Progress progress = connector_.step(socket_, reason);
    if (progress == TcpConnector::Progress::Failed)
    {
      error = "cannot connect to " + name_ + ": " + reason;
      return OpenResult::NotThere;
    }
    return progress == TcpConnector::Progress::Connected ? OpenResult::Opened : OpenResult::Pending;
  }

  void close() override
  {
    connector_.cancel();
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
    return socket_.is_open() && !connector_.active();
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
    while (isOpen() && sent < frame.size() && waitUntilWritable(socket_.native_handle(), deadline))
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
    const bool done = isOpen() && sent == frame.size();
    if (!done && isOpen())
    {
      // No room until the deadline: 0. Otherwise why it has hung up.
      last_loss_ = lossBy({ socketError(socket_.native_handle()), boost::system::system_category() });
    }
    return done;
  }

  ReceiveResult receive(Bytes& buffer, TimePoint deadline) override
  {
    while (isOpen())
    {
      acknowledgeAtOnce(socket_.native_handle());
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

  /// Appends what is there to \p buffer and returns how much that was.
  std::size_t readInto(Bytes& buffer, boost::system::error_code& failure)
  {
    std::array<std::uint8_t, READ_SIZE> bytes;
    const std::size_t count = socket_.read_some(boost::asio::buffer(bytes), failure);
    buffer.insert(buffer.end(), bytes.begin(), bytes.begin() + count);
    // Taking bytes can switch it off again.
    acknowledgeAtOnce(socket_.native_handle());
    return count;
  }

  std::string name_;
  TcpConnector connector_;
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

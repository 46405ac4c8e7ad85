// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <future>
#include <ostream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "inverter_bus/wire/line.h"
#include "inverter_bus/wire/tcp_port.h"
#include "support/wire_frames.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// For what comes at once: long enough for any machine, and never waited out.
constexpr int SOON_MS = 10000;
/// What open() may take, and some reserve for a busy machine.
constexpr milliseconds OPENING_BOUND{ 1500 };

TimePoint soon()
{
  return steady_clock::now() + milliseconds(SOON_MS);
}

/// As often as it takes; no call holds up the thread for long.
template <typename Openable>
OpenResult openWhole(Openable& port, std::string& error)
{
  OpenResult result = OpenResult::Pending;
  while (result == OpenResult::Pending)
  {
    result = port.open(error);
    EXPECT_TRUE(result == OpenResult::Opened || !port.isOpen());
  }
  return result;
}

/// A socket of the test; closed at the end.
class Descriptor
{
public:
  explicit Descriptor(int descriptor = -1) : descriptor_(descriptor)
  {
  }

  Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1))
  {
  }

  Descriptor& operator=(Descriptor&& other) noexcept
  {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }

  ~Descriptor()
  {
    close();
  }

  void close()
  {
    if (descriptor_ >= 0)
    {
      ::close(std::exchange(descriptor_, -1));
    }
  }

  int get() const
  {
    return descriptor_;
  }

private:
  int descriptor_;
};

/// A server on the loop-back interface, as plain as the system offers it.
class Server
{
public:
  /// \p family AF_INET or AF_INET6, \p port 0: any that is free.
  explicit Server(int family = AF_INET, int backlog = 8, std::uint16_t port = 0)
    : listener_(::socket(family, SOCK_STREAM, 0))
  {
    const int on = 1;
    ::setsockopt(listener_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    sockaddr_storage address{};
    address.ss_family = static_cast<sa_family_t>(family);
    if (family == AF_INET)
    {
      reinterpret_cast<sockaddr_in&>(address).sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      reinterpret_cast<sockaddr_in&>(address).sin_port = htons(port);
    }
    else
    {
      reinterpret_cast<sockaddr_in6&>(address).sin6_addr = in6addr_loopback;
    }
    const socklen_t size = family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
    there_ = ::bind(listener_.get(), reinterpret_cast<sockaddr*>(&address), size) == 0 &&
             ::listen(listener_.get(), backlog) == 0;
    socklen_t length = sizeof(address);
    ::getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &length);
    port_ = ntohs(reinterpret_cast<sockaddr_in&>(address).sin_port);
  }

  bool there() const
  {
    return there_;
  }

  std::uint16_t port() const
  {
    return port_;
  }

  int listener() const
  {
    return listener_.get();
  }

  Descriptor accept() const
  {
    pollfd polled{ listener_.get(), POLLIN, 0 };
    EXPECT_EQ(1, ::poll(&polled, 1, SOON_MS));
    return Descriptor(::accept(listener_.get(), nullptr, nullptr));
  }

  void close()
  {
    listener_.close();
  }

private:
  Descriptor listener_;
  bool there_ = false;
  std::uint16_t port_ = 0;
};

Bytes readFrom(const Descriptor& peer, std::size_t count)
{
  Bytes bytes(count);
  std::size_t size = 0;
  pollfd polled{ peer.get(), POLLIN, 0 };
  while (size < count && ::poll(&polled, 1, SOON_MS) == 1)
  {
    const ssize_t part = ::read(peer.get(), bytes.data() + size, count - size);
    if (part <= 0)
    {
      break;
    }
    size += static_cast<std::size_t>(part);
  }
  bytes.resize(size);
  return bytes;
}

void writeTo(const Descriptor& peer, const Bytes& bytes)
{
  EXPECT_EQ(static_cast<ssize_t>(bytes.size()), ::send(peer.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL));
}

/// Makes the close of \p peer a reset.
void reset(Descriptor& peer)
{
  const linger abort{ 1, 0 };
  EXPECT_EQ(0, ::setsockopt(peer.get(), SOL_SOCKET, SO_LINGER, &abort, sizeof(abort)));
  peer.close();
}

class TcpPortTest : public testing::Test
{
protected:
  std::unique_ptr<Port> makePort(const std::string& host, std::uint16_t port, NameResolver resolver = resolveName)
  {
    return makeTcpPort({ host, port }, "tcp://" + host, std::move(resolver));
  }

  Duration timeToOpen(Port& port, OpenResult expected)
  {
    const TimePoint start = steady_clock::now();
    EXPECT_EQ(expected, openWhole(port, error_));
    return steady_clock::now() - start;
  }

  std::string error_;
};

/// A connection that stands.
class ConnectedTcpPort : public TcpPortTest
{
protected:
  ConnectedTcpPort()
  {
    EXPECT_EQ(OpenResult::Opened, openWhole(*port_, error_)) << error_;
    peer_ = server_.accept();
  }

  /// Receives until something else than data comes.
  ReceiveResult receiveAll(Bytes& bytes)
  {
    ReceiveResult result = ReceiveResult::Data;
    while (result == ReceiveResult::Data)
    {
      result = port_->receive(bytes, soon());
    }
    return result;
  }

  Server server_;
  const std::unique_ptr<Port> port_ = makePort("127.0.0.1", server_.port());
  Descriptor peer_;
};

TEST_F(ConnectedTcpPort, passesEveryByteBothWays)
{
  Bytes all(256);
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    all[i] = static_cast<std::uint8_t>(i);
  }
  EXPECT_TRUE(port_->isOpen());
  EXPECT_TRUE(port_->send(all));
  EXPECT_EQ(all, readFrom(peer_, all.size()));
  writeTo(peer_, all);
  Bytes received = hex("55");
  while (received.size() < 257 && port_->receive(received, soon()) == ReceiveResult::Data)
  {
  }
  EXPECT_EQ(hex("55") + all, received);
}

TEST_F(ConnectedTcpPort, waitsUntilTheDeadlineAndNoLonger)
{
  Bytes bytes;
  const TimePoint deadline = steady_clock::now() + milliseconds(20);
  EXPECT_EQ(ReceiveResult::Silence, port_->receive(bytes, deadline));
  EXPECT_GE(steady_clock::now(), deadline);
  EXPECT_EQ(ReceiveResult::Silence, port_->receive(bytes, TimePoint()));
  EXPECT_TRUE(bytes.empty());
}

TEST_F(ConnectedTcpPort, takesWhatHasArrivedBeforeItsDeadlineInThePast)
{
  writeTo(peer_, hex("01 02"));
  Bytes bytes;
  while (port_->receive(bytes, TimePoint()) != ReceiveResult::Data)
  {
    std::this_thread::yield();
  }
  EXPECT_EQ(hex("01 02"), bytes);
}

TEST_F(ConnectedTcpPort, isGoneBehindWhatThePeerSentBeforeItClosed)
{
  writeTo(peer_, hex("01 03 04 12"));
  peer_.close();
  Bytes bytes;
  EXPECT_EQ(ReceiveResult::Gone, receiveAll(bytes));
  EXPECT_EQ(hex("01 03 04 12"), bytes);
  EXPECT_EQ(Loss::ClosedByPeer, port_->lastLoss());
}

TEST_F(ConnectedTcpPort, isGoneWhenThePeerResets)
{
  reset(peer_);
  Bytes bytes;
  EXPECT_EQ(ReceiveResult::Gone, receiveAll(bytes));
  EXPECT_EQ(Loss::ClosedByPeer, port_->lastLoss());
  EXPECT_FALSE(port_->send(hex("01")));
}

TEST_F(ConnectedTcpPort, theFirstFrameBehindAResetShowsWhoClosed)
{
  reset(peer_);
  // The reset may not have been noticed before.
  const TimePoint give_up = soon();
  while (port_->send(hex("01 02")) && steady_clock::now() < give_up)
  {
    std::this_thread::yield();
  }
  EXPECT_EQ(Loss::ClosedByPeer, port_->lastLoss());
}

TEST_F(ConnectedTcpPort, isAbandonedByAReset)
{
  port_->abandon();
  EXPECT_FALSE(port_->isOpen());
  char byte = 0;
  pollfd polled{ peer_.get(), POLLIN, 0 };
  EXPECT_EQ(1, ::poll(&polled, 1, SOON_MS));
  EXPECT_EQ(-1, ::recv(peer_.get(), &byte, 1, 0));
  EXPECT_EQ(ECONNRESET, errno);
  port_->abandon();
}

TEST_F(ConnectedTcpPort, aReplyInTwoPartsIsNotHeldUpByItsOwnAcknowledgement)
{
  // The peer sends its second part when the first one is acknowledged (Nagle), which takes 40 ms unless it is told not to.
  // A new connection acknowledges at once for a while.
  Duration shortest = std::chrono::hours(1);
  for (int round = 0; round < 40; ++round)
  {
    ASSERT_TRUE(port_->send(hex("01 03")));
    Bytes request(2);
    ASSERT_EQ(2, ::recv(peer_.get(), request.data(), request.size(), MSG_WAITALL));
    const TimePoint start = steady_clock::now();
    writeTo(peer_, hex("01 03"));
    writeTo(peer_, hex("04 12"));
    Bytes reply;
    while (reply.size() < 4 && port_->receive(reply, soon()) == ReceiveResult::Data)
    {
    }
    ASSERT_EQ(hex("01 03 04 12"), reply);
    shortest = round < 30 ? shortest : std::min(shortest, Duration(steady_clock::now() - start));
  }
  EXPECT_LT(shortest, milliseconds(30)) << "of ten";
}

TEST_F(ConnectedTcpPort, sendingToAClosedPeerRaisesNoSignal)
{
  static std::atomic<int> raised;
  raised = 0;
  const auto before = std::signal(SIGPIPE, [](int) { ++raised; });
  peer_.close();
  const TimePoint give_up = soon();
  // The peer answers the first frame with a reset; what comes after that cannot be sent.
  while (port_->send(hex("01 02")) && steady_clock::now() < give_up)
  {
    std::this_thread::yield();
  }
  EXPECT_FALSE(port_->send(hex("01 02")));
  std::signal(SIGPIPE, before);
  EXPECT_EQ(0, raised);
}

TEST_F(ConnectedTcpPort, isGoneWhenThePeerTakesNothingForASecond)
{
  const Bytes much(1 << 20);
  const TimePoint start = steady_clock::now();
  bool there = true;
  // As much as the buffers of both sides take, and then one frame too many.
  for (int i = 0; i < 64 && there; ++i)
  {
    there = port_->send(much);
  }
  EXPECT_FALSE(there);
  EXPECT_LE(steady_clock::now() - start, milliseconds(5000));
}

TEST_F(ConnectedTcpPort, throwsAwayWhatWasNotTakenWhenItCloses)
{
  const Bytes much(1 << 20);
  while (port_->send(much))
  {
  }
  port_->close();
  std::array<char, 65536> bytes;
  ssize_t count = 0;
  std::size_t received = 0;
  while ((count = ::read(peer_.get(), bytes.data(), bytes.size())) > 0)
  {
    received += static_cast<std::size_t>(count);
  }
  EXPECT_EQ(-1, count) << "a reset and no orderly end: nothing is delivered later";
  EXPECT_EQ(ECONNRESET, errno);
}

TEST_F(ConnectedTcpPort, endsInOrderWhenEverythingWasTaken)
{
  EXPECT_TRUE(port_->send(hex("01 02")));
  EXPECT_EQ(hex("01 02"), readFrom(peer_, 2));
  writeTo(peer_, hex("03"));
  Bytes bytes;
  EXPECT_EQ(ReceiveResult::Data, port_->receive(bytes, soon()));
  port_->close();
  EXPECT_FALSE(port_->isOpen());
  std::uint8_t byte = 0;
  EXPECT_EQ(0, ::read(peer_.get(), &byte, 1));
}

TEST_F(ConnectedTcpPort, aClosedPortDoesNothing)
{
  port_->close();
  port_->close();
  Bytes bytes;
  EXPECT_FALSE(port_->isOpen());
  EXPECT_FALSE(port_->send(hex("01")));
  EXPECT_EQ(ReceiveResult::Gone, port_->receive(bytes, soon()));
}

TEST_F(ConnectedTcpPort, canBeOpenedAgain)
{
  writeTo(peer_, hex("01 02 03"));
  peer_.close();
  EXPECT_EQ(OpenResult::Opened, openWhole(*port_, error_)) << error_;
  const Descriptor again = server_.accept();
  EXPECT_TRUE(port_->send(hex("04")));
  EXPECT_EQ(hex("04"), readFrom(again, 1));
  writeTo(again, hex("05"));
  Bytes bytes;
  EXPECT_EQ(ReceiveResult::Data, port_->receive(bytes, soon()));
  EXPECT_EQ(hex("05"), bytes) << "nothing is left of the old connection";
}

TEST_F(ConnectedTcpPort, aSignalDoesNotEndTheWaiting)
{
  struct sigaction action = {};
  struct sigaction before = {};
  static std::atomic<int> raised;
  raised = 0;
  action.sa_handler = [](int) { ++raised; };
  ::sigaction(SIGALRM, &action, &before);
  const itimerval every_5_ms{ { 0, 5000 }, { 0, 5000 } };
  ::setitimer(ITIMER_REAL, &every_5_ms, nullptr);
  Bytes bytes;
  const TimePoint deadline = steady_clock::now() + milliseconds(50);
  EXPECT_EQ(ReceiveResult::Silence, port_->receive(bytes, deadline));
  EXPECT_GE(steady_clock::now(), deadline);
  const itimerval never{};
  ::setitimer(ITIMER_REAL, &never, nullptr);
  ::sigaction(SIGALRM, &before, nullptr);
  EXPECT_GT(raised, 0);
}

TEST_F(TcpPortTest, connectsToIpv6)
{
  const Server server(AF_INET6);
  if (!server.there())
  {
    // Without IPv6 it is the way to fail that can be seen.
    EXPECT_NE(OpenResult::Opened, openWhole(*makePort("::1", 1), error_));
    EXPECT_NE("", error_);
    return;
  }
  const auto port = makePort("::1", server.port());
  EXPECT_EQ(OpenResult::Opened, openWhole(*port, error_)) << error_;
  const Descriptor peer = server.accept();
  EXPECT_TRUE(port->send(hex("01")));
  EXPECT_EQ(hex("01"), readFrom(peer, 1));
}

TEST_F(TcpPortTest, connectsToAName)
{
  const Server server;
  const auto port = makePort("localhost", server.port());
  EXPECT_EQ(OpenResult::Opened, openWhole(*port, error_)) << error_;
  EXPECT_GE(server.accept().get(), 0);
  EXPECT_EQ("tcp://localhost", port->name());
}

TEST_F(TcpPortTest, triesAllAddressesOfAName)
{
  const Server server;
  const auto port = makePort("gateway", server.port(), [](const std::string&, std::string&) {
    return std::vector<std::string>{ "127.0.0.2", "::1", "127.0.0.1" };
  });
  EXPECT_EQ(OpenResult::Opened, openWhole(*port, error_)) << error_;
}

/// Sockets of this process that take connections.
int listeningSockets()
{
  int count = 0;
  for (int descriptor = 0; descriptor < 1024; ++descriptor)
  {
    int listening = 0;
    socklen_t size = sizeof(listening);
    const bool socket = ::getsockopt(descriptor, SOL_SOCKET, SO_ACCEPTCONN, &listening, &size) == 0;
    count += socket && listening != 0 ? 1 : 0;
  }
  return count;
}

TEST_F(TcpPortTest, listensNowhere)
{
  const Server server;
  const int before = listeningSockets();
  const auto port = makePort("127.0.0.1", server.port());
  ASSERT_EQ(OpenResult::Opened, openWhole(*port, error_)) << error_;
  EXPECT_EQ(before, listeningSockets());
  EXPECT_GE(before, 1) << "the server of the test itself is to be counted";
}

TEST_F(TcpPortTest, asksForTheConfiguredHostAndCallsItsPortOnly)
{
  Server configured;
  const Server other;
  std::vector<std::string> asked;
  const auto port = makePort("gateway", configured.port(), [&asked](const std::string& host, std::string&) {
    asked.push_back(host);
    return std::vector<std::string>{ "127.0.0.1" };
  });
  ASSERT_EQ(OpenResult::Opened, openWhole(*port, error_)) << error_;
  {
    // Whatever the gateway says, a redirection among it, is bytes of the line.
    const Descriptor peer = configured.accept();
    const std::string elsewhere = "HTTP/1.1 302 Found\r\nLocation: tcp://127.0.0.1:" + std::to_string(other.port());
    writeTo(peer, Bytes(elsewhere.begin(), elsewhere.end()));
    Bytes received;
    EXPECT_EQ(ReceiveResult::Data, port->receive(received, soon()));
  }
  configured.close();
  EXPECT_EQ(OpenResult::NotThere, openWhole(*port, error_));
  EXPECT_EQ((std::vector<std::string>{ "gateway", "gateway" }), asked);
  pollfd called{ other.listener(), POLLIN, 0 };
  EXPECT_EQ(0, ::poll(&called, 1, 0)) << "a server that is not configured was called";
}

TEST_F(TcpPortTest, saysThatTheConnectionWasRefused)
{
  Server server;
  const auto port = makePort("127.0.0.1", server.port());
  server.close();
  EXPECT_LE(timeToOpen(*port, OpenResult::NotThere), OPENING_BOUND);
  EXPECT_EQ("cannot connect to tcp://127.0.0.1: Connection refused", error_);
  EXPECT_FALSE(port->isOpen());
}

TEST_F(TcpPortTest, opensAsSoonAsSomebodyListensAgain)
{
  Server server;
  const auto port = makePort("127.0.0.1", server.port());
  EXPECT_EQ(OpenResult::Opened, openWhole(*port, error_));
  server.close();
  EXPECT_EQ(OpenResult::NotThere, openWhole(*port, error_));
  const Server again(AF_INET, 8, server.port());
  ASSERT_TRUE(again.there());
  EXPECT_EQ(OpenResult::Opened, openWhole(*port, error_)) << error_;
}

TEST_F(TcpPortTest, neverCallsItself)
{
  // TCP joins a socket with itself where nobody listens and the system happens to give the caller the very port number
  // that it calls. Linux goes through the even ones first.
  std::uint16_t number = 1;
  while (number % 2 != 0)
  {
    number = Server().port();
    number = static_cast<std::uint16_t>(number - number % 2);
    number = Server(AF_INET, 8, number).there() ? number : std::uint16_t{ 1 };
  }
  const auto port = makePort("127.0.0.1", number);
  for (int i = 0; i < 16000; ++i)
  {
    ASSERT_EQ(OpenResult::NotThere, openWhole(*port, error_)) << i;
  }
}

/// A server that takes no more connections: the system leaves the call of the port unanswered.
class TcpPortBlackHole : public TcpPortTest
{
protected:
  TcpPortBlackHole()
  {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(server_.port());
    // Until one call stays unanswered.
    bool answered = true;
    while (answered && fillers_.size() < 16)
    {
      fillers_.emplace_back(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
      ::connect(fillers_.back().get(), reinterpret_cast<sockaddr*>(&address), sizeof(address));
      pollfd polled{ fillers_.back().get(), POLLOUT, 0 };
      answered = ::poll(&polled, 1, 100) == 1;
    }
    EXPECT_FALSE(answered) << "the server is not full";
  }

  const Server server_{ AF_INET, 0 };
  std::vector<Descriptor> fillers_;
};

TEST_F(TcpPortBlackHole, openingItIsBounded)
{
  const auto port = makePort("127.0.0.1", server_.port());
  for (int i = 0; i < 2; ++i)
  {
    const Duration time = timeToOpen(*port, OpenResult::NotThere);
    EXPECT_GE(time, milliseconds(900));
    EXPECT_LE(time, OPENING_BOUND);
    EXPECT_EQ("cannot connect to tcp://127.0.0.1: Connection timed out", error_);
    EXPECT_FALSE(port->isOpen());
  }
}

TEST_F(TcpPortBlackHole, openingItLeavesTimeForOtherDuties)
{
  const auto port = makePort("127.0.0.1", server_.port());
  int steps = 1;
  while (port->open(error_) == OpenResult::Pending)
  {
    EXPECT_FALSE(port->isOpen());
    ++steps;
  }
  EXPECT_GE(steps, 10) << "in one second";
}

TEST_F(TcpPortBlackHole, closingEndsTheAttempt)
{
  const auto port = makePort("127.0.0.1", server_.port());
  EXPECT_EQ(OpenResult::Pending, port->open(error_));
  port->close();
  EXPECT_FALSE(port->isOpen());
  EXPECT_EQ(OpenResult::Pending, port->open(error_)) << "begins anew";
}

TEST_F(TcpPortBlackHole, anAddressThatDoesNotAnswerLeavesTimeForTheNext)
{
  // The server is full on both addresses, so that only the time tells that both were tried.
  const auto port = makePort("gateway", server_.port(), [](const std::string&, std::string&) {
    return std::vector<std::string>{ "127.0.0.1", "127.0.0.2" };
  });
  EXPECT_LE(timeToOpen(*port, OpenResult::NotThere), milliseconds(900));
  EXPECT_EQ("cannot connect to tcp://gateway: Connection refused", error_);
}

TEST_F(TcpPortTest, aNameThatDoesNotExistIsReportedInTime)
{
  // RFC 2606 keeps this name free for ever. Where no name server answers, the look-up goes on behind our back.
  const auto port = makePort("nowhere.invalid", 502);
  EXPECT_LE(timeToOpen(*port, OpenResult::NotThere), OPENING_BOUND);
  EXPECT_EQ(0u, error_.find("cannot connect to tcp://nowhere.invalid: ")) << error_;
  EXPECT_GT(error_.size(), std::strlen("cannot connect to tcp://nowhere.invalid: "));
}

TEST_F(TcpPortTest, theReasonOfTheNameServerIsPassedOn)
{
  const auto port = makePort("gateway", 502, [](const std::string& host, std::string& error) {
    error = "Host not found: " + host;
    return std::vector<std::string>();
  });
  EXPECT_EQ(OpenResult::NotThere, openWhole(*port, error_));
  EXPECT_EQ("cannot connect to tcp://gateway: Host not found: gateway", error_);
}

TEST_F(TcpPortTest, aNameWithoutAddressIsReported)
{
  const auto port =
      makePort("gateway", 502, [](const std::string&, std::string&) { return std::vector<std::string>(); });
  EXPECT_EQ(OpenResult::NotThere, openWhole(*port, error_));
  EXPECT_EQ("cannot connect to tcp://gateway: its name has no address", error_);
}

/// A name server that answers when the test says so.
class TcpPortSlowName : public TcpPortTest
{
protected:
  ~TcpPortSlowName() override
  {
    answer();
  }

  void answer()
  {
    if (!answered_)
    {
      answered_ = true;
      may_answer_.set_value();
    }
  }

  NameResolver resolver()
  {
    // The thread of the look-up may outlive this test.
    return [go = may_answer_.get_future().share(), calls = calls_](const std::string&, std::string&) {
      ++*calls;
      go.wait();
      return std::vector<std::string>{ "127.0.0.1" };
    };
  }

  std::promise<void> may_answer_;
  bool answered_ = false;
  const std::shared_ptr<std::atomic<int>> calls_ = std::make_shared<std::atomic<int>>(0);
};

TEST_F(TcpPortSlowName, isWaitedForOneSecondAndTakenLater)
{
  const Server server;
  const auto port = makePort("gateway", server.port(), resolver());
  EXPECT_LE(timeToOpen(*port, OpenResult::NotThere), OPENING_BOUND);
  EXPECT_EQ("cannot connect to tcp://gateway: its name has not been resolved yet", error_);
  EXPECT_LE(timeToOpen(*port, OpenResult::NotThere), OPENING_BOUND);
  EXPECT_EQ(1, *calls_) << "one look-up at a time";
  answer();
  EXPECT_EQ(OpenResult::Opened, openWhole(*port, error_)) << error_;
  EXPECT_EQ(1, *calls_);
  EXPECT_EQ(OpenResult::Opened, openWhole(*port, error_)) << error_;
  EXPECT_EQ(2, *calls_) << "the address may have changed";
}

TEST_F(TcpPortSlowName, doesNotHoldUpTheEnd)
{
  auto port = makePort("gateway", 502, resolver());
  EXPECT_EQ(OpenResult::NotThere, openWhole(*port, error_));
  const TimePoint start = steady_clock::now();
  port.reset();
  EXPECT_LE(steady_clock::now() - start, milliseconds(500));
}

/// A line over TCP, with a gateway that answers in a thread of its own.
class TcpPortLine : public ConnectedTcpPort
{
protected:
  Reply exchange(Protocol& protocol, const Request& request)
  {
    util::SteadyClock clock;
    Line line(*port_, protocol, clock, LineTiming(115200, 10, milliseconds(2000)));
    return line.exchange(request);
  }

  static Request readRequest()
  {
    Request request = requestOf(withCrc("01 03 00 00 00 02"));
    request.response_timeout = std::chrono::seconds(5);
    return request;
  }
};

TEST_F(TcpPortLine, carriesModbusTcp)
{
  std::thread gateway([this] {
    EXPECT_EQ(hex("00 01 00 00 00 06 01 03 00 00 00 02"), readFrom(peer_, 12));
    writeTo(peer_, hex("00 01 00 00 00 07 01 03 04 12 34 56 78"));
  });
  const auto protocol = makeModbusTcp();
  const Reply reply = exchange(*protocol, readRequest());
  gateway.join();
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(hex("03 04 12 34 56 78"), reply.pdu);
}

/// Has its peer send one more byte whenever somebody waits for bytes.
class BytewisePort : public Port
{
public:
  BytewisePort(Port& port, const Descriptor& peer, Bytes bytes) : port_(port), peer_(peer), bytes_(std::move(bytes))
  {
  }

  OpenResult open(std::string& error) override
  {
    return port_.open(error);
  }

  void close() override
  {
    port_.close();
  }

  bool isOpen() const override
  {
    return port_.isOpen();
  }

  std::string name() const override
  {
    return port_.name();
  }

  bool send(const Bytes& frame) override
  {
    return port_.send(frame);
  }

  ReceiveResult receive(Bytes& buffer, TimePoint deadline) override
  {
    if (sent_ < bytes_.size())
    {
      writeTo(peer_, { bytes_[sent_++] });
    }
    return port_.receive(buffer, deadline);
  }

  std::size_t sent() const
  {
    return sent_;
  }

private:
  Port& port_;
  const Descriptor& peer_;
  Bytes bytes_;
  std::size_t sent_ = 0;
};

TEST_F(TcpPortLine, carriesRtuFramesInPieces)
{
  BytewisePort port(*port_, peer_, withCrc("01 03 04 12 34 56 78"));
  const auto protocol = makeModbusRtu();
  util::SteadyClock clock;
  Line line(port, *protocol, clock, LineTiming(115200, 10, milliseconds(2000)));
  const Reply reply = line.exchange(readRequest());
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(hex("03 04 12 34 56 78"), reply.pdu);
  EXPECT_EQ(9u, port.sent());
  EXPECT_EQ(withCrc("01 03 00 00 00 02"), readFrom(peer_, 8));
}

TEST_F(TcpPortLine, isLostWhenTheGatewayClosesInTheMiddleOfAReply)
{
  std::thread gateway([this] {
    readFrom(peer_, 12);
    writeTo(peer_, hex("00 01 00 00 00 07 01 03 04"));
    peer_.close();
  });
  const auto protocol = makeModbusTcp();
  const Reply reply = exchange(*protocol, readRequest());
  gateway.join();
  EXPECT_EQ(Outcome::PortLost, reply.outcome);
  EXPECT_FALSE(port_->isOpen());
}

struct AddressCase
{
  const char* text;
  std::uint16_t default_port;
  const char* host;
  std::uint16_t port;
};

std::ostream& operator<<(std::ostream& stream, const AddressCase& address)
{
  return stream << address.text;
}

class GoodTcpAddress : public testing::TestWithParam<AddressCase>
{
};

TEST_P(GoodTcpAddress, isTakenApart)
{
  std::string error;
  const auto address = parseTcpAddress(GetParam().text, GetParam().default_port, error);
  ASSERT_TRUE(address) << error;
  EXPECT_EQ(GetParam().host, address->host);
  EXPECT_EQ(GetParam().port, address->port);
  EXPECT_EQ("", error);
}

const AddressCase GOOD[] = {
  { "192.168.1.20:502", 0, "192.168.1.20", 502 },
  { "192.168.1.20", MODBUS_TCP_PORT, "192.168.1.20", 502 },
  { "gateway:4001", 502, "gateway", 4001 },
  { "moxa-7.line_2.local", 502, "moxa-7.line_2.local", 502 },
  { "[::1]:502", 0, "::1", 502 },
  { "[fe80::1%eth0]:65535", 0, "fe80::1%eth0", 65535 },
  { "[2001:db8::7]", 1, "2001:db8::7", 1 },
  { "host:1", 0, "host", 1 },
};

INSTANTIATE_TEST_SUITE_P(forms, GoodTcpAddress, testing::ValuesIn(GOOD));

struct BadAddress
{
  const char* text;
  const char* reason;
};

std::ostream& operator<<(std::ostream& stream, const BadAddress& address)
{
  return stream << address.text;
}

class BadTcpAddress : public testing::TestWithParam<BadAddress>
{
};

TEST_P(BadTcpAddress, isRefusedWithItsReason)
{
  std::string error;
  EXPECT_FALSE(parseTcpAddress(GetParam().text, MODBUS_TCP_PORT, error));
  EXPECT_EQ(GetParam().reason, error);
}

const BadAddress BAD[] = {
  { "", "the host is missing" },
  { ":502", "the host is missing" },
  { "host:", "the host must be followed by a colon and a port number from 1 to 65535, not ':'" },
  { "host:0", "the host must be followed by a colon and a port number from 1 to 65535, not ':0'" },
  { "host:65536", "the host must be followed by a colon and a port number from 1 to 65535, not ':65536'" },
  { "host:99999999999999999999",
    "the host must be followed by a colon and a port number from 1 to 65535, not ':99999999999999999999'" },
  { "host:+1", "the host must be followed by a colon and a port number from 1 to 65535, not ':+1'" },
  { "host:502/x", "the host must be followed by a colon and a port number from 1 to 65535, not ':502/x'" },
  { "[::1]502", "the host must be followed by a colon and a port number from 1 to 65535, not '502'" },
  { "::1", "an IPv6 address is written in brackets: [::1]:502" },
  { "fe80::1:502", "an IPv6 address is written in brackets: [::1]:502" },
  { "[::1", "a closing bracket is missing" },
  { "[]:502", "'' is not an IPv6 address" },
  { "[gateway]:502", "'gateway' is not an IPv6 address" },
  { "[127.0.0.1]", "'127.0.0.1' is not an IPv6 address" },
  { "300.0.0.1", "'300.0.0.1' is not an IPv4 address" },
  { "10.1", "'10.1' is not an IPv4 address" },
  { "//host", "'//host' is not a host name" },
  { "user@host", "'user@host' is not a host name" },
  { "ho st", "'ho st' is not a host name" },
};

INSTANTIATE_TEST_SUITE_P(forms, BadTcpAddress, testing::ValuesIn(BAD));

TEST(TcpAddressTest, aPortWithoutDefaultMustBeGiven)
{
  std::string error;
  EXPECT_FALSE(parseTcpAddress("gateway", 0, error));
  EXPECT_EQ("the port number is missing (host:port)", error);
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus

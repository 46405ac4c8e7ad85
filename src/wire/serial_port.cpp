// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/wire/serial_port.h"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>
#include <boost/system/error_code.hpp>
#include <cerrno>
#include <cstring>

#include "poll_descriptor.h"
#include "transmitter.h"
#include "tty_setup.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
/// More than a Modbus frame, so that one read takes all that has come of one.
constexpr std::size_t READ_SIZE = 512;

class SerialPort : public Port
{
public:
  explicit SerialPort(const SerialSettings& settings)
    : settings_(settings)
    , port_(context_)
    , transmitter_(settings.transmission == Transmission::Modbus ? makeModbusTransmitter(settings)
                                                                 : makePlainTransmitter(settings))
  {
  }

  ~SerialPort() override
  {
    SerialPort::close();
  }

  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  OpenResult open(std::string& error) override
  {
    close();
    const OpenResult result = openAndLock(error);
    if (result != OpenResult::Opened)
    {
      close();
      return result;
    }
    const std::string reason = configure();
    if (!reason.empty())
    {
      error = "cannot use " + settings_.device + ": " + reason;
      close();
      return OpenResult::NotThere;
    }
    ::tcflush(port_.native_handle(), TCIOFLUSH);
    return OpenResult::Opened;
  }

  void close() override
  {
    if (!port_.is_open())
    {
      return;
    }
    transmitter_->detach();
    if (!pseudo_terminal_)
    {
      // A line that is stuck would hold up the close for half a minute. (On a pseudo-terminal this would take bytes
      // from the other side that have long been sent.)
      ::tcflush(port_.native_handle(), TCIOFLUSH);
    }
    if (locked_)
    {
      unlockTty(port_.native_handle(), pseudo_terminal_);
      locked_ = false;
    }
    boost::system::error_code ignored;
    port_.close(ignored);
  }

  bool isOpen() const override
  {
    return port_.is_open();
  }

  std::string name() const override
  {
    return settings_.device;
  }

  bool send(const Bytes& frame) override
  {
    return port_.is_open() && transmitter_->send(frame);
  }

  ReceiveResult receive(Bytes& buffer, TimePoint deadline) override
  {
    while (port_.is_open())
    {
      const DescriptorState state = pollDescriptor(port_.native_handle(), POLLIN, deadline);
      if (state == DescriptorState::Silent)
      {
        return ReceiveResult::Silence;
      }
      // After a hang-up too: what had arrived before it counts.
      const ssize_t count = readInto(buffer);
      if (count > 0)
      {
        return ReceiveResult::Data;
      }
      const bool try_again = count < 0 && (errno == EAGAIN || errno == EINTR);
      if (state == DescriptorState::HungUp || !try_again)
      {
        return ReceiveResult::Gone;
      }
    }
    return ReceiveResult::Gone;
  }

private:
  OpenResult openAndLock(std::string& error)
  {
    // Not by Asio: it would change the settings of a port that another process is using, before the lock is asked for.
    const int tty = ::open(settings_.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (tty < 0)
    {
      const bool busy = errno == EBUSY;
      error = busy ? inUse() : "cannot open " + settings_.device + ": " + std::strerror(errno);
      return busy ? OpenResult::InUse : OpenResult::NotThere;
    }
    boost::system::error_code refused;
    if (::isatty(tty) == 0)
    {
      error = "cannot use " + settings_.device + ": " +
              (errno == ENOTTY ? "it is not a serial port" : std::strerror(errno));
      ::close(tty);
      return OpenResult::NotThere;
    }
    port_.assign(tty, refused);
    if (refused)
    {
      error = "cannot use " + settings_.device + ": " + refused.message();
      ::close(tty);
      return OpenResult::NotThere;
    }
    return lock(error);
  }

  OpenResult lock(std::string& error)
  {
    pseudo_terminal_ = isPseudoTerminal(port_.native_handle());
    if (!settings_.exclusive)
    {
      return OpenResult::Opened;
    }
    locked_ = lockTty(port_.native_handle(), pseudo_terminal_);
    if (!locked_)
    {
      error = inUse();
      return OpenResult::InUse;
    }
    return OpenResult::Opened;
  }

  /// Returns what went wrong; empty if nothing did.
  std::string configure()
  {
    const int tty = port_.native_handle();
    std::string reason = configureTty(port_, settings_, pseudo_terminal_);
    if (!reason.empty())
    {
      return reason;
    }
    if (!pseudo_terminal_)
    {
      requestLowLatency(tty);
    }
    return switchTransmitter(tty);
  }

  std::string switchTransmitter(int tty)
  {
    if (settings_.rs485 == Rs485::Kernel)
    {
      const std::string reason = enableKernelRs485(tty);
      if (!reason.empty())
      {
        return "its driver does not switch an RS-485 transmitter (" + reason + "), rs485: kernel needs one that does";
      }
    }
    // A pseudo-terminal has neither RTS nor a transmitter to switch.
    const bool by_rts = settings_.rs485 == Rs485::RtsHigh || settings_.rs485 == Rs485::RtsLow;
    const bool switch_rts = by_rts && !pseudo_terminal_;
    if (switch_rts && !hasRts(tty))
    {
      return "it has no RTS line to switch an RS-485 transmitter with";
    }
    return transmitter_->attach(tty, switch_rts) ? "" : "its transmitter cannot be set up";
  }

  std::string inUse() const
  {
    return settings_.device + " is in use by another process";
  }

  /// As read(2), appending to \p buffer.
  ssize_t readInto(Bytes& buffer) const
  {
    std::array<std::uint8_t, READ_SIZE> bytes;
    const ssize_t count = ::read(port_.native_handle(), bytes.data(), bytes.size());
    if (count > 0)
    {
      buffer.insert(buffer.end(), bytes.begin(), bytes.begin() + count);
    }
    return count;
  }

  SerialSettings settings_;
  boost::asio::io_context context_;
  // native_handle() is not const in Boost.Asio, though it changes nothing.
  mutable boost::asio::serial_port port_;
  std::unique_ptr<Transmitter> transmitter_;
  bool pseudo_terminal_ = false;
  bool locked_ = false;
};
}  // namespace

std::unique_ptr<Port> makeSerialPort(const SerialSettings& settings)
{
  return std::make_unique<SerialPort>(settings);
}
}  // namespace wire
}  // namespace inverter_bus

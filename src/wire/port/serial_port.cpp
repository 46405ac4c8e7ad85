// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/wire/serial_port.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>

#include "wire/port/open_failure.h"
#include "wire/port/poll_descriptor.h"
#include "wire/port/transmitter.h"
#include "wire/port/tty_setup.h"

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
    if (!abandoned_ || !isTheDevice())
    {
      close();
    }
    abandoned_ = false;
    const OpenResult result = tty_ >= 0 ? OpenResult::Opened : openAndLock(error);
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
    if (locked_)
    {
      ::tcflush(tty_, TCIOFLUSH);
    }
    return OpenResult::Opened;
  }

  /// The next open() renews settings, transmitter and buffers under the lock that is held: a close would let another
  /// process in, and the open after it would move RTS. A pseudo-terminal has neither settings to renew nor RTS: there only
  /// a close is noticed at the other side.
  void abandon() override
  {
    if (pseudo_terminal_)
    {
      close();
    }
    abandoned_ = tty_ >= 0;
  }

  void close() override
  {
    if (tty_ < 0)
    {
      return;
    }
    abandoned_ = false;
    transmitter_->detach();
    if (locked_)
    {
      giveBack();
    }
    ::close(tty_);
    tty_ = -1;
  }

  bool isOpen() const override
  {
    return tty_ >= 0 && !abandoned_;
  }

  std::string name() const override
  {
    return settings_.device;
  }

  bool send(const Bytes& frame) override
  {
    return isOpen() && transmitter_->send(frame);
  }

  ReceiveResult receive(Bytes& buffer, TimePoint deadline) override
  {
    while (isOpen())
    {
      const DescriptorState state = pollDescriptor(tty_, POLLIN, deadline);
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

  std::optional<AdapterLatency> adapterLatency() const override
  {
    return wire::adapterLatency(settings_.device);
  }

private:
  OpenResult openAndLock(std::string& error)
  {
    tty_ = ::open(settings_.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (tty_ < 0)
    {
      const bool busy = errno == EBUSY;
      error = busy ? inUse() : openFailure(settings_.device, errno);
      return busy ? OpenResult::InUse : OpenResult::NotThere;
    }
    if (::isatty(tty_) == 0)
    {
      error = noSerialPort(settings_.device, errno);
      return OpenResult::NotThere;
    }
    pseudo_terminal_ = isPseudoTerminal(tty_);
    return settings_.exclusive ? lock(error) : OpenResult::Opened;
  }

  OpenResult lock(std::string& error)
  {
    const LockResult lock = lockTty(tty_, pseudo_terminal_);
    locked_ = lock == LockResult::Taken;
    if (!locked_)
    {
      error = inUse() + (lock == LockResult::Exclusive
                             ? " (exclusively, through another device file of the port or without a "
                               "lock: a container?)"
                             : "");
    }
    return locked_ ? OpenResult::Opened : OpenResult::InUse;
  }

  /// The open device is still the one with the name: an adapter that came back has another device file.
  bool isTheDevice() const
  {
    struct stat named = {};
    struct stat open = {};
    return ::stat(settings_.device.c_str(), &named) == 0 && ::fstat(tty_, &open) == 0 && named.st_dev == open.st_dev &&
           named.st_ino == open.st_ino;
  }

  /// Only the holder of the lock flushes: another user of the port may have frames on their way.
  void giveBack()
  {
    if (!pseudo_terminal_)
    {
      // A line that is stuck would hold up the close for half a minute. (On a pseudo-terminal this would take bytes
      // from the other side that have long been sent.)
      ::tcflush(tty_, TCIOFLUSH);
    }
    unlockTty(tty_, pseudo_terminal_);
    locked_ = false;
  }

  /// Returns what went wrong; empty if nothing did.
  std::string configure()
  {
    const std::string reason = configureTty(tty_, settings_, pseudo_terminal_);
    return reason.empty() ? switchTransmitter(tty_) : reason;
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
    const ssize_t count = ::read(tty_, bytes.data(), bytes.size());
    if (count > 0)
    {
      buffer.insert(buffer.end(), bytes.begin(), bytes.begin() + count);
    }
    return count;
  }

  SerialSettings settings_;
  std::unique_ptr<Transmitter> transmitter_;
  int tty_ = -1;
  bool pseudo_terminal_ = false;
  bool locked_ = false;
  bool abandoned_ = false;
};
}  // namespace

std::unique_ptr<Port> makeSerialPort(const SerialSettings& settings)
{
  return std::make_unique<SerialPort>(settings);
}
}  // namespace wire
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_PORT_H
#define INVERTER_BUS_WIRE_PORT_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace wire
{
using Bytes = std::vector<std::uint8_t>;

/// Outcome of Port::open().
enum class OpenResult
{
  Opened,
  /// The device does not exist, refuses a setting or gives an I/O error: try again later.
  NotThere,
  /// Another process holds it (flock, TIOCEXCL, EBUSY).
  InUse,
  /// Not decided yet (a name is looked up, a connection is being made): call open() again, at once, until it says
  /// something else. Each call returns within 50 ms, so that other duties go on in between.
  Pending
};

/// How a port got lost.
enum class Loss
{
  None,
  /// Unplugged, I/O error, a network or host that no longer answers.
  Gone,
  /// The other side has ended the connection in good order or refused to go on (end of stream, ECONNRESET, EPIPE): it is
  /// there, and a new connection may do.
  ClosedByPeer
};

/// What Port::receive() brought.
enum class ReceiveResult
{
  Data,
  /// The deadline passed without a byte.
  Silence,
  /// The port is gone (unplugged, hang-up, I/O error, connection closed). Close it and open it again.
  Gone
};

/// How long an adapter collects bytes before it delivers them.
struct AdapterLatency
{
  Duration latency{ 0 };
  /// The file to which root may write another number of milliseconds.
  std::string file;
};

/// Bytes on a line: a serial port, a TCP connection, or a simulated one. Knows nothing of frames.
///
/// Only the bus thread may call it. No call throws, and none blocks longer than it says.
class Port
{
public:
  virtual ~Port() = default;

  /// Opens and locks the port. On failure \p error says in one sentence why.
  virtual OpenResult open(std::string& error) = 0;
  /// Closes; closing a closed port does nothing.
  virtual void close() = 0;
  /// Closes at once and for good: nothing that was sent goes on, and the other side is notified (TCP: RST).
  virtual void abandon()
  {
    close();
  }
  virtual bool isOpen() const = 0;
  /// As the user wrote it, for messages.
  virtual std::string name() const = 0;

  /// Hands a whole frame to the line. Returns false when the port is gone. Does not wait for the last bit (a UART sends
  /// on by itself); it may block for the frame's time on the wire where software switches the transmitter.
  virtual bool send(const Bytes& frame) = 0;

  /// Waits for bytes until \p deadline and appends what is there to \p buffer. A deadline in the past only takes what
  /// has already arrived.
  virtual ReceiveResult receive(Bytes& buffer, TimePoint deadline) = 0;

  /// How it got lost since the last successful open(): asked after send() or receive() have said that it is gone.
  virtual Loss lastLoss() const
  {
    return Loss::Gone;
  }
  /// As far as the driver of an adapter reports it; may change at any time. Reads sysfs.
  virtual std::optional<AdapterLatency> adapterLatency() const
  {
    return std::nullopt;
  }
  /// A network connection: no adapter on the way returns what is sent, and the program at its other end may speak first.
  virtual bool isNetwork() const
  {
    return false;
  }
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_PORT_H

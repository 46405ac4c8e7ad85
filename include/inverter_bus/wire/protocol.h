// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_PROTOCOL_H
#define INVERTER_BUS_WIRE_PROTOCOL_H

#include <cstddef>
#include <memory>
#include <string>

#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace wire
{
/// What a protocol sees at the head of the received bytes.
struct Parsed
{
  enum class Kind
  {
    /// Could become a frame: wait for more.
    Incomplete,
    /// A valid reply to the request: \ref pdu.
    Reply,
    /// A valid exception reply to the request: \ref pdu.
    Exception,
    /// A valid frame (checksum right) that is not the answer to this request.
    Foreign,
    /// The byte at the head cannot begin a valid frame: skip \ref consumed.
    Garbage
  };
  Kind kind = Kind::Incomplete;
  /// Incomplete: what is there agrees with the awaited reply in every byte that is known beforehand (station and
  /// function at least), so that it is the reply itself that has begun.
  bool own = false;
  /// Bytes to take from the head of the buffer (0 with Incomplete).
  std::size_t consumed = 0;
  /// Station that sent the frame (Reply, Exception, Foreign).
  std::uint8_t station = 0;
  /// Reply without framing (Reply, Exception, Foreign).
  Bytes pdu;
  /// The contract's error id of an exception.
  std::uint16_t error_id = 0;
};

/// Framing of one protocol: Modbus RTU now; Modbus TCP and CompoWay/F take the same place. Stateless but for a
/// transaction number, so that the line, the scheduler and everything above never ask which protocol runs.
///
/// Bus thread only.
class Protocol
{
public:
  virtual ~Protocol() = default;

  /// The complete frame for the wire, checksum included.
  virtual Bytes frame(const Request& request) = 0;

  /// Looks at the head of \p size bytes at \p data while \p request waits for its answer. \p request may be null
  /// (nothing was asked): a complete valid frame is then Foreign.
  virtual Parsed parse(const std::uint8_t* data, std::size_t size, const Request* request) const = 0;

  /// Characters of the request's frame and of its longest normal reply (0 for a broadcast), for costs and time-outs.
  virtual std::size_t requestLength(const Request& request) const = 0;
  virtual std::size_t replyLength(const Request& request) const = 0;

  /// Replies of equal shape cannot be told apart: station, function and whatever of the request a reply repeats. Two
  /// requests with equal shapes must not follow each other after a time-out (rule 9 of the scheduler).
  virtual std::string shape(const Request& request) const = 0;
  /// The shape that a frame from the wire would answer to; empty if none. An exception repeats nothing but station and
  /// function: its shape is the beginning that the shapes of all requests which it could answer have in common.
  virtual std::string shapeOfReply(std::uint8_t station, const Bytes& pdu) const = 0;

  /// True if the reply to \p request carries a number that no other reply carries (08H): once it has come, no reply to
  /// an earlier request can follow.
  virtual bool isLoopback(const Request& /*request*/) const
  {
    return false;
  }

  /// Characters of silence that end a frame and precede a request (Modbus RTU: 3.5).
  virtual double gapCharacters() const = 0;
};

/// Modbus RTU (Modbus over serial line V1.02, section 2.5.1): CRC-16 low byte first, functions 01-06, 08, 0F, 10 and
/// 17 hex; every field that a reply repeats is compared with the request.
std::unique_ptr<Protocol> makeModbusRtu();

/// CRC-16/MODBUS (start FFFF hex, polynomial A001 hex reflected).
std::uint16_t modbusCrc(const std::uint8_t* data, std::size_t size);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_PROTOCOL_H

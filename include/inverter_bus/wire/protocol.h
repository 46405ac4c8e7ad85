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
    /// A valid reply to the request: \ref pdu. Behind a gateway also one whose number or unit is not that of the request,
    /// but what some gateways make of it.
    Reply,
    /// A valid exception reply to the request: \ref pdu. As for Reply.
    Exception,
    /// The station says that the request reached it damaged (CompoWay/F end codes 10 to 13): it was not carried out and
    /// may be repeated. \ref error_id says how.
    NotUnderstood,
    /// Bears the transaction number of an earlier request.
    Late,
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
  /// Station that sent the frame (all valid frames).
  std::uint8_t station = 0;
  /// Number that the frame repeats of its request; 0 in protocols without one.
  std::uint16_t transaction = 0;
  /// Reply without framing (all valid frames).
  Bytes pdu;
  /// The contract's error id, where the frame is an exception or a refusal.
  std::uint16_t error_id = 0;
};

/// Framing of one protocol: Modbus RTU, Modbus TCP or CompoWay/F. Stateless but for a transaction number, so that the
/// line, the scheduler and everything above never ask which protocol runs.
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

  /// Characters that the request's frame and its longest normal reply (0 for a broadcast) take on the serial line, be
  /// it behind a gateway; for costs and time-outs.
  virtual std::size_t requestLength(const Request& request) const = 0;
  virtual std::size_t replyLength(const Request& request) const = 0;

  /// Replies of equal shape cannot be told apart: station, function and whatever of the request a reply repeats. Two
  /// requests with equal shapes must not follow each other after a time-out (rule 3.9). Behind a gateway
  /// without station and transaction number: whether these distinguish replies, only the gateway shows (GatewayRecord).
  virtual std::string shape(const Request& request) const = 0;
  /// The shape that the valid frame \p reply from the wire would answer to; empty if none. An exception repeats nothing
  /// but station and function: its shape is the beginning that the shapes of all requests which it could answer have in
  /// common.
  virtual std::string shapeOfReply(const Parsed& reply) const = 0;

  /// Transaction number of the last frame(); 0 in protocols without one.
  virtual std::uint16_t lastNumber() const
  {
    return 0;
  }

  /// True if the reply to \p request carries a number that no other reply carries (08H): once it has come, no reply to
  /// an earlier request can follow.
  virtual bool isLoopback(const Request& /*request*/) const
  {
    return false;
  }

  /// Characters of silence that end a frame and precede a request (Modbus RTU: 3.5).
  virtual double gapCharacters() const = 0;

  /// Characters of silence that a gateway keeps in an exchange by itself, on the line behind it. It passes on whole
  /// replies only, so that the first byte comes when the last one has been on the line. 0: no gateway.
  virtual double gatewayGapCharacters() const
  {
    return 0.0;
  }
};

/// Modbus RTU (Modbus over serial line V1.02, section 2.5.1): CRC-16 low byte first, functions 01-06, 08, 0F, 10 and
/// 17 hex; every field that a reply repeats is compared with the request.
std::unique_ptr<Protocol> makeModbusRtu();

/// Modbus TCP to a gateway with a serial line behind it (Modbus messaging on TCP/IP implementation guide V1.0b, section
/// 3.1): the functions of Modbus RTU behind a header with a transaction number, which runs from 1 to 65535 and starts
/// again. The station is the unit identifier. Numbers, units and the length of an exception are taken as gateways write
/// them (contract, 8.8).
std::unique_ptr<Protocol> makeModbusTcp();

/// CompoWay/F (OMRON I548-E1, sections 2-1 to 2-4): Request::pdu is the command text, Parsed::pdu the response text, in
/// ASCII. Station 0 is a unit like any other; a broadcast goes to XX. Error ids are the response code of the text, or
/// 00EE hex for an end code EE that comes without text.
std::unique_ptr<Protocol> makeCompowayF();

/// CRC-16/MODBUS (start FFFF hex, polynomial A001 hex reflected).
std::uint16_t modbusCrc(const std::uint8_t* data, std::size_t size);
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_PROTOCOL_H

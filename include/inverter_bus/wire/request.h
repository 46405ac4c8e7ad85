// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_REQUEST_H
#define INVERTER_BUS_WIRE_REQUEST_H

#include <bitset>
#include <cstdint>
#include <string>

#include "inverter_bus/wire/port.h"

namespace inverter_bus
{
namespace wire
{
/// Modbus exception codes, by their number.
using ExceptionCodes = std::bitset<256>;

/// All but 0AH and 0BH, by which a gateway says that it could not reach the drive (Modbus application protocol V1.1b3,
/// section 7).
inline ExceptionCodes everyExceptionOfADrive()
{
  return ~(ExceptionCodes().set(0x0A).set(0x0B));
}

/// One question on the bus, without the framing that a protocol puts around it.
struct Request
{
  /// Station number on the bus (0 with \ref broadcast; a normal unit of CompoWay/F otherwise).
  std::uint8_t station = 0;
  /// Modbus: function code and data. CompoWay/F: the command text (MRC, SRC, ...) in ASCII.
  Bytes pdu;
  /// Executed by every drive and answered by none.
  bool broadcast = false;
  /// False where the drive executes without a reply (VF-S15 fault reset): silence is then the normal end.
  bool expects_reply = true;
  /// Silence that the drive wants before the request, counted from the last byte on the line; the protocol's gap is kept
  /// in any case.
  Duration quiet_before{ 0 };
  /// The drive's own reply delay on top of the protocol's gap (C078, F805).
  Duration reply_delay{ 0 };
  /// Silence after the request that counts as lost.
  Duration response_timeout{ seconds(0.1) };
  /// Modbus: exceptions with these codes are the drive's own refusal. Any other one is a gateway's way to say that the
  /// drive has not answered (contract, 8.7): Outcome::Timeout, and Reply::gateway_code says which.
  ExceptionCodes own_exceptions = everyExceptionOfADrive();
};

/// How an exchange ended. Every value says what follows from it.
enum class Outcome
{
  /// A reply that belongs to the request. The drive is alive.
  Ok,
  /// The drive answered with a refusal (Modbus exception, CompoWay/F response code). It is alive: never counts
  /// towards offline and is never repeated.
  Exception,
  /// No byte in time, or a gateway says that the drive has not answered (Reply::gateway_code). Repeated up to `retries`,
  /// the latter never: the gateway has tried. Counts towards offline.
  Timeout,
  /// Bytes came, but no valid reply to this request; or the drive says that the request reached it damaged (error_id is
  /// then its end code, 0010 to 0013 hex). Repeated like a time-out.
  Damaged,
  /// The port is gone. Not the drive's fault; nothing is repeated before the port is open again.
  PortLost
};

/// The end of an exchange.
struct Reply
{
  Outcome outcome = Outcome::Timeout;
  /// Ok: the reply without framing, function code first (CompoWay/F: the response text). Exception: the same (function |
  /// 0x80, code).
  Bytes pdu;
  /// The contract's error id: 0, 0x0205, 0x0206, 0x0207, 0x8xyy or a CompoWay/F code.
  std::uint16_t error_id = 0;
  /// When the first byte of the request was handed to the port.
  TimePoint sent_at;
  /// Arrival of the reply's last byte; with a time-out the end of waiting.
  TimePoint finished_at;
  /// Silence between the end of the request on the wire and the first byte of the reply (Ok and Exception only).
  Duration turnaround{ 0 };
  /// The same until the port handed over the first bytes: adapters and FIFOs collect some (Ok and Exception only).
  Duration heard_after{ 0 };
  /// Running number of the line's requests, from 1; never used twice. A late reply bears that of its request. 0: nothing
  /// was sent.
  std::uint64_t ticket = 0;
  /// Timeout: the exception code by which a gateway said so, which is then finished with the request (nothing of it is
  /// outstanding); 0: no answer.
  std::uint8_t gateway_code = 0;
  /// Timeout: the other end has closed the connection in place of the answer (contract, 8.9), and a new one is opened at
  /// once.
  bool connection_closed = false;
  /// Timeout or Damaged: a stop has ended the wait (contract, 8.4), so it says nothing about the drive.
  bool cut = false;
};

constexpr std::uint16_t ERROR_TIMEOUT = 0x0205;
constexpr std::uint16_t ERROR_DAMAGED = 0x0206;
constexpr std::uint16_t ERROR_PORT_LOST = 0x0207;
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_REQUEST_H

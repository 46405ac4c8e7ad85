// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_DIALECT_H
#define INVERTER_BUS_FUZZ_DIALECT_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "inverter_bus/wire/protocol.h"

namespace inverter_bus
{
namespace fuzz
{
/// A second opinion on a protocol, written from its specification and not from the driver's code: the fuzzer holds the
/// driver's against it.
class Dialect
{
public:
  /// A complete frame at the head of some bytes; length 0: none.
  struct Frame
  {
    std::size_t length = 0;
    std::uint8_t station = 0;
    /// What the frame carries, without framing.
    wire::Bytes content;
  };

  /// What an answer to a request is.
  struct Answer
  {
    /// Incomplete stands for "no answer".
    wire::Parsed::Kind kind = wire::Parsed::Kind::Incomplete;
    std::size_t length = 0;
    std::uint16_t error_id = 0;
  };

  virtual ~Dialect() = default;

  virtual std::unique_ptr<wire::Protocol> makeProtocol() const = 0;
  /// Requests to send, all that the driver makes among them.
  virtual const std::vector<wire::Request>& requests() const = 0;
  /// True if the first \p length bytes are one frame whose framing and checksum are right, in either direction.
  virtual bool isFrame(const std::uint8_t* data, std::size_t length) const = 0;
  /// The answer to \p request that stands complete at the head of \p size bytes. \p number how many requests there have
  /// been, this one included.
  virtual Answer answerAt(const wire::Request& request, std::size_t number, const std::uint8_t* data,
                          std::size_t size) const = 0;
  /// What a frame from isFrame() carries.
  virtual wire::Bytes contentOf(const wire::Bytes& frame) const = 0;
  /// The normal reply to \p request, its data from \p fill as far as that goes, zeros behind.
  virtual wire::Bytes reply(const wire::Request& request, std::size_t number, const wire::Bytes& fill) const = 0;
  /// A refusal of \p request.
  virtual wire::Bytes refusal(const wire::Request& request, std::size_t number, std::uint8_t code) const = 0;
  /// \p bytes with the framing and checksum that make them pass for a frame.
  virtual wire::Bytes seal(const wire::Bytes& bytes, std::size_t number) const = 0;
};

std::unique_ptr<Dialect> makeModbusRtuDialect();
std::unique_ptr<Dialect> makeModbusTcpDialect();
std::unique_ptr<Dialect> makeCompowayDialect();
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_DIALECT_H

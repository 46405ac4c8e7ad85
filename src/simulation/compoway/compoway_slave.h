// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_COMPOWAY_SLAVE_H
#define INVERTER_BUS_SIMULATION_COMPOWAY_SLAVE_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "inverter_bus/simulation/simulated_drive.h"

namespace inverter_bus
{
namespace simulation
{
/// Response codes (MRES SRES) of FINS-mini: 3G3JE manual I548, section 3.
enum class CompowayResponse : std::uint16_t
{
  Normal = 0x0000,
  UnsupportedCommand = 0x0401,
  CommandTooLong = 0x1001,
  CommandTooShort = 0x1002,
  CountMismatch = 0x1003,
  ParameterError = 0x1100,
  AreaTypeError = 0x1101,
  StartOutOfRange = 0x1103,
  EndOutOfRange = 0x1104,
  ResponseTooLong = 0x110B,
  OperationError = 0x2203,
  ReadOnly = 0x3003
};

/// What a brand's CompoWay/F offers.
struct CompowayLimits
{
  std::size_t buffer = 40;      ///< [bytes] of a whole frame, STX to BCC
  std::size_t elements = 2;     ///< most elements of a read or write
  std::size_t echo_bytes = 23;  ///< most bytes of an echoback test
  bool eight_bits = false;      ///< the line has 8 data bits: an echoback test may have A1h-FEh
  std::string model;            ///< of the controller attributes, 10 characters
};

/// A CompoWay/F slave with the services 0101, 0102, 0503, 0601, 0801 and 3005: frame, end codes, lengths, and the order
/// in which errors are found (3G3JE manual I548, sections 2 and 3; where its pages are missing, the OMRON E5CN, which
/// has the same buffer). A brand adds its variable areas and operations.
///
/// Parity and framing errors (end codes 10, 11) and overrun (12) don't happen here: a byte is right or wrong. Where the
/// manuals are silent: an SID other than 0 is a format error; a read beyond an area's end gives 1103; an echoback test
/// with other characters than allowed is a format error; a broadcast is executed when it writes or operates.
class CompowaySlave : public SimulatedDrive
{
public:
  using Limits = CompowayLimits;

  CompowaySlave(std::string name, int station, std::uint64_t seed, TimePoint start, CompowayLimits limits);

  bool addressedBy(const Bytes& frame) const override;
  bool isWholeFrame(const Bytes& frame) const override;
  int largestException() const override;

protected:
  using Response = CompowayResponse;

  bool answersDamaged() const override;
  std::optional<Answer> answer(const Bytes& frame, TimePoint now, bool& good) override;
  bool isBroadcast(const Bytes& frame) const override;
  /// MRC and SRC as one number: 0x0102.
  std::optional<int> functionOf(const Bytes& frame) const override;
  Access accessOf(const Bytes& frame) const override;
  /// \p code is a response code; below 0100h an end code.
  Answer exceptionAnswer(const Bytes& frame, int code) override;
  Bytes foreignReply(const Bytes& reply, bool other_station) override;

  /// From the end of the request to the reply.
  virtual Duration replyDelay() const = 0;

  // Variable areas, by type: C0 to C3.
  virtual bool hasArea(std::uint8_t type) const = 0;
  virtual bool hasAddress(std::uint8_t type, std::uint32_t address) const = 0;
  virtual bool readOnly(std::uint8_t type) const = 0;
  /// Only existing addresses come here.
  virtual Response readVariables(std::uint8_t type, std::uint32_t address, std::size_t count,
                                 std::vector<std::uint32_t>& values) = 0;
  /// Each value lies in its setting range.
  virtual bool accepts(std::uint8_t type, std::uint32_t address, const std::vector<std::uint32_t>& values) const = 0;
  /// Only existing addresses of a writable area and accepted values come here.
  virtual Response writeVariables(std::uint8_t type, std::uint32_t address,
                                  const std::vector<std::uint32_t>& values) = 0;

  /// \p code: command code and related information, four hexadecimal digits.
  virtual Response operate(const std::string& code) = 0;
  /// Operating status and related information, four hexadecimal digits.
  virtual std::string controllerStatus() const = 0;

private:
  /// What the text of a request leads to.
  struct Result
  {
    Response code = Response::Normal;
    std::string data;      // behind the response code
    bool silent = false;   // no reply at all
    bool garbage = false;  // a format error
  };

  std::string endCodeOf(const Bytes& frame, std::string& sub_address) const;
  Result execute(const std::string& text, bool for_all);
  Result read(const std::string& text);
  Result write(const std::string& text);
  Result echo(const std::string& text) const;
  Response checkRead(const std::string& text) const;
  Response checkWrite(const std::string& text, std::vector<std::uint32_t>& values) const;
  Answer reply(const std::string& body, bool exception) const;
  std::string stationText() const;

  CompowayLimits limits_;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_COMPOWAY_SLAVE_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_DRIVE_DRIVE_H
#define INVERTER_BUS_DRIVE_DRIVE_H

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/drive/profile.h"
#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace drive
{
/// What one drive reports, in its own sense (positive = forward) and in SI units. An empty field: it can't tell, or has
/// not told yet.
struct Monitor
{
  std::optional<bool> run_seen;  ///< the RUN command that the drive holds from the bus
  std::optional<bool> operation;
  std::optional<bool> running;
  std::optional<int> direction;  ///< -1, 0, 1
  std::optional<bool> ready;
  std::optional<bool> at_speed;
  std::optional<bool> at_set_frequency;
  std::optional<bool> overload_warning;
  std::optional<bool> pid_deviation;
  std::optional<bool> faulted;
  std::optional<std::uint32_t> raw_status;
  std::optional<std::uint16_t> fault_code;
  std::optional<std::uint32_t> warning_code;
  std::optional<double> output_frequency;  ///< [Hz]
  std::optional<double> output_current;    ///< [A]
  std::optional<double> output_voltage;    ///< [V]
  std::optional<double> dc_voltage;        ///< [V]
  std::optional<double> torque;            ///< [% of rated]
  std::optional<double> temperature;       ///< [degC]
};

/// One read exchange and the monitor fields that it brings.
struct ReadBlock
{
  Space space = Space::Register;
  std::uint16_t number = 0;   ///< first number as printed in the manual
  std::uint16_t address = 0;  ///< first wire address
  unsigned count = 1;
  std::vector<std::string> fields;
};

/// One entry of the trip memory. Empty optional: the drive doesn't keep it.
struct FaultRecord
{
  std::uint16_t code = 0;
  std::string text;
  std::optional<double> output_frequency;  ///< [Hz]
  std::optional<double> output_current;    ///< [A]
  std::optional<double> dc_voltage;        ///< [V]
  std::optional<double> run_hours;
  std::optional<double> power_on_hours;
};

/// A value that was checked for a write, or the reason why it can't be written.
struct Encoded
{
  bool ok = false;
  std::uint32_t raw = 0;
  std::string error;
};

/// Turns intentions into requests and replies into values for the drives of one profile. Immutable, no time, no threads;
/// any thread may call the const functions.
class Drive
{
public:
  explicit Drive(Profile profile);

  const Profile& profile() const;

  // --- status ---------------------------------------------------------------------------------------------------
  /// Reads of every refresh (run bits, frequency, current, direction): for an MX2 one of coils and one of registers.
  const std::vector<ReadBlock>& fastBlocks() const;
  /// Reads that rotate (voltages, torque, temperature, warning).
  const std::vector<ReadBlock>& slowBlocks() const;
  /// Reads that are only made while the drive is tripped (fault code).
  const std::vector<ReadBlock>& faultBlocks() const;
  /// The shortest read that shows run_seen (or running), for the read-back of a stop; empty: the drive can't tell.
  const std::optional<ReadBlock>& runBlock() const;

  wire::Request read(std::uint8_t station, const ReadBlock& block) const;
  /// Puts what \p reply (function code first) says into \p monitor. The reply must have been checked against the request.
  void decode(const ReadBlock& block, const wire::Bytes& reply, Monitor& monitor) const;
  /// True if a status field of this name can be reported by this drive as configured.
  bool reports(const std::string& field) const;

  // --- commands -------------------------------------------------------------------------------------------------
  /// A confirmed sequence; null: the drive lacks it or it isn't confirmed.
  const Sequence* sequence(const std::string& name) const;
  /// Names to confirm before \p name can be used; empty: usable, or not there at all.
  std::string missingFor(const std::string& name) const;
  /// Request that writes \p raw to \p point.
  wire::Request write(std::uint8_t station, const std::string& point, std::uint32_t raw) const;
  /// Set-point of \p frequency_hz (unsigned) in counts of the point `frequency`, rounded to nearest.
  std::uint32_t frequencyCounts(double frequency_hz) const;
  /// [Hz] of one count.
  double frequencyResolution() const;
  /// Loop-back with \p number as data; empty: the drive has none.
  std::optional<wire::Request> loopback(std::uint8_t station, std::uint16_t number) const;

  // --- faults ---------------------------------------------------------------------------------------------------
  /// Reads that bring entry \p index of the trip memory (0 = newest).
  std::vector<ReadBlock> faultReads(std::size_t index) const;
  std::size_t faultEntries() const;
  /// Adds what \p reply of one of those reads says.
  void decodeFault(std::size_t index, const ReadBlock& block, const wire::Bytes& reply, FaultRecord& record) const;
  /// "" for 0, else the text of the table or "unknown trip N": never empty for a code.
  std::string faultText(std::uint16_t code) const;
  std::string warningText(std::uint32_t code) const;

  // --- parameters -----------------------------------------------------------------------------------------------
  /// By the drive's code (upper and lower case count), or for reading `0x1103` = the number printed in the manual.
  std::optional<Parameter> findParameter(const std::string& name, bool for_write) const;
  /// Name to confirm before the parameter can be used; empty: usable, or not there at all.
  std::string missingForParameter(const std::string& name) const;
  /// Why findParameter() finds nothing, in words for the user; empty: it does.
  std::string parameterRefusal(const std::string& name, bool for_write) const;
  wire::Request readParameter(std::uint8_t station, const Parameter& parameter) const;
  double decodeParameter(const Parameter& parameter, const wire::Bytes& reply) const;
  /// The raw value of a parameter reply, unscaled.
  std::uint32_t rawParameter(const Parameter& parameter, const wire::Bytes& reply) const;
  /// Checks \p value against range and resolution ("exact scale": a value between two counts is refused, not rounded).
  Encoded encodeParameter(const Parameter& parameter, double value) const;
  wire::Request writeParameter(std::uint8_t station, const Parameter& parameter, std::uint32_t raw) const;
  /// Read of the busy flag after `store`; empty: none.
  std::optional<wire::Request> readStoreBusy(std::uint8_t station) const;
  bool decodeStoreBusy(const wire::Bytes& reply) const;

  /// "exception 21H: value outside the drive's range" in the drive's own words.
  std::string exceptionText(std::uint16_t error_id) const;

private:
  Profile profile_;
  std::vector<ReadBlock> fast_blocks_;
  std::vector<ReadBlock> slow_blocks_;
  std::vector<ReadBlock> fault_blocks_;
  std::optional<ReadBlock> run_block_;
};
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_DRIVE_DRIVE_H

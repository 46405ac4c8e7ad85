// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_DRIVE_DRIVE_H
#define INVERTER_BUS_DRIVE_DRIVE_H

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/drive/profile.h"
#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace drive
{
/// What one drive reports, in its own sense (positive = forward) and in SI units. An empty field: it can't report it, or has
/// not done so yet.
struct Monitor
{
  std::optional<bool> run_seen;  ///< the RUN command that the drive holds from the bus
  std::optional<bool> operation;
  std::optional<bool> running;
  std::optional<bool> ready;
  std::optional<bool> at_speed;
  std::optional<bool> at_set_frequency;
  std::optional<bool> overload_warning;
  std::optional<bool> pid_deviation;
  std::optional<bool> faulted;
  std::optional<bool> restarted;  ///< the drive has forgotten what it was set to since it last came back
  std::optional<int> direction;   ///< -1, 0, 1
  /// Raw value of \ref faulted that means nothing in the profile; \ref faulted is then empty. Counts as a trip.
  std::optional<std::uint32_t> unknown_trip;
  std::optional<std::uint32_t> raw_status;
  std::optional<std::uint16_t> fault_code;
  std::optional<std::uint32_t> warning_code;
  std::optional<double> output_frequency;  ///< [Hz]
  std::optional<double> output_current;    ///< [A]
  std::optional<double> output_voltage;    ///< [V]
  std::optional<double> dc_voltage;        ///< [V]
  std::optional<double> torque;            ///< [% of rated]
  std::optional<double> temperature;       ///< [degC]

  /// What must be assumed: an unknown state is one; empty: the drive has not reported it.
  std::optional<bool> tripped() const
  {
    return unknown_trip ? std::optional<bool>(true) : faulted;
  }
};

/// One read exchange and the monitor fields that it brings.
struct ReadBlock
{
  Space space = Space::Register;
  std::uint8_t area = 0;      ///< variable type (CompoWay/F)
  std::uint16_t number = 0;   ///< first number as printed in the manual
  std::uint16_t address = 0;  ///< first wire address
  unsigned count = 1;
  std::vector<std::string> fields;
  /// Printed number of each word where the drive's user chose them (block read); empty: they follow each other. 0: none.
  std::vector<std::uint16_t> chosen;
  /// Registers of it that hold coils (map).
  std::vector<MirroredCoils> mirrors;
};

/// A point and the raw value that goes there.
using Word = std::pair<std::string, std::uint32_t>;

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
  /// The shortest read that shows run_seen, for the read-back of a stop; empty: the drive can't report it.
  const std::optional<ReadBlock>& runBlock() const;

  wire::Request read(std::uint8_t station, const ReadBlock& block) const;
  /// Puts the content of \p reply (function code first) into \p monitor. The reply must have been checked against the request.
  /// Quantities in percent of a rating that \p ratings doesn't know stay empty.
  void decode(const ReadBlock& block, const wire::Bytes& reply, Monitor& monitor,
              const Ratings& ratings = Ratings()) const;
  /// One read for \p fields, which must lie close enough together.
  ReadBlock blockOf(const std::vector<std::string>& fields) const;
  /// The same read with another number of words, so that a late reply to one can't be taken for the answer to the other;
  /// empty: there is none. Values beyond a shorter one stay empty.
  std::optional<ReadBlock> variantOf(const ReadBlock& block) const;
  /// The drive can report whether a RUN of the bus is on.
  bool tellsRun() const;

  // --- block read and write ---------------------------------------------------------------------------------------
  /// The read of the words that \p codes select, with the status fields that it brings; empty: the drive has none, a code
  /// is unknown, or none of them selects anything.
  std::optional<ReadBlock> chosenRead(const std::vector<int>& codes) const;
  /// The read that brings what the drive's map lays side by side, with its status fields; empty: there is none, or it is not
  /// confirmed that the drive answers it.
  std::optional<ReadBlock> mappedRead() const;
  /// The reads that bring all parameters of the map.
  std::vector<ReadBlock> mapTableReads() const;
  /// What \p reply, of one of these, says of the map's parameter \p name; empty: it is in another one.
  std::optional<std::uint32_t> mapEntry(const std::string& name, const ReadBlock& block,
                                        const wire::Bytes& reply) const;
  /// Fast or slow reads of the fields that \p block doesn't bring.
  std::vector<ReadBlock> fastBlocksBeside(const ReadBlock& block) const;
  std::vector<ReadBlock> slowBlocksBeside(const ReadBlock& block) const;
  /// True if \p words are exactly the points of the block write.
  bool fitsBlockWrite(const std::vector<Word>& words) const;
  /// All command words in one frame.
  wire::Request writeChosen(std::uint8_t station, const std::vector<Word>& words) const;
  /// The same, with the reply that read(\p block) would bring (17H); without a block write the first of \p words alone, a
  /// register.
  wire::Request writeAndRead(std::uint8_t station, const std::vector<Word>& words, const ReadBlock& block) const;
  /// Titles and values of the chosen words that no status field shows.
  std::vector<std::pair<std::string, std::string>> chosenValues(const ReadBlock& block, const wire::Bytes& reply,
                                                                const Ratings& ratings) const;
  /// True if a status field of this name can be reported by this drive as configured.
  bool reports(const std::string& field) const;

  // --- commands -------------------------------------------------------------------------------------------------
  /// A confirmed sequence; null: the drive lacks it or it isn't confirmed.
  const Sequence* sequence(const std::string& name) const;
  /// Names to confirm before \p name can be used; empty: usable, or not there at all.
  std::string missingFor(const std::string& name) const;
  /// A start is armed, but a stop is not: a mistake in the scan list.
  bool runsWithoutStop() const;
  /// What to do about missingFor(): the names with the places where they are to be found.
  std::string armingAdvice(const std::string& name) const;
  /// What is unconfirmed and what to do about it, for /diagnostics; empty: nothing.
  std::string unconfirmedText() const;
  /// Request for \p step; \p setpoint in counts for the frequency.
  wire::Request command(std::uint8_t station, const Step& step, std::uint32_t setpoint = 0) const;
  /// Writes to this point reach the EEPROM unless the sequence connect could be carried out.
  bool wears(const std::string& point) const;
  /// Request that writes \p raw to \p point.
  wire::Request write(std::uint8_t station, const std::string& point, std::uint32_t raw) const;
  /// The same to all drives of the bus; none answers. (Station 0 alone makes no broadcast: behind its own port a drive may
  /// have that number, and CompoWay/F counts from 0.)
  wire::Request broadcast(const std::string& point, std::uint32_t raw) const;
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
  /// Why \p monitor counts as tripped: the code's text, or the state that the profile does not know with the code's text
  /// after it.
  std::string tripText(const Monitor& monitor) const;
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

  /// CompoWay/F attributes (service 0503); empty on other protocols.
  std::optional<wire::Request> readAttributes(std::uint8_t station) const;
  /// The model text in the reply, without padding.
  std::string decodeModel(const wire::Bytes& reply) const;

  /// "exception 21H: value outside the drive's range" in the drive's own words.
  std::string exceptionText(std::uint16_t error_id) const;

private:
  std::string adviceFor(const std::set<std::string>& marks) const;
  std::string skippableUnconfirmed() const;

  Profile profile_;
  std::vector<ReadBlock> fast_blocks_;
  std::vector<ReadBlock> slow_blocks_;
  std::vector<ReadBlock> fault_blocks_;
  std::optional<ReadBlock> run_block_;
};
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_DRIVE_DRIVE_H

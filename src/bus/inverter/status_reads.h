// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_STATUS_READS_H
#define INVERTER_BUS_BUS_STATUS_READS_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// One read of the status and what it brought last.
struct StatusRead
{
  enum class Kind
  {
    /// Read in every refresh.
    Fast,
    /// Compares what the drive's register map brings with plain reads; behind the fast ones.
    Proof,
    /// Read in each refresh that shows a trip.
    Fault,
    /// Takes turns with others of its kind.
    Slow
  };
  drive::ReadBlock block;
  Kind kind = Kind::Fast;
  /// Not asked for before this time: the drive refuses it, or it could not be read.
  TimePoint left_out_until;
  /// It was answered, most recently at \ref last.
  bool ever = false;
  TimePoint last;
  /// Between its last two answers.
  Duration period{ 0 };
  /// From the first byte of its last request to the last one of its answer.
  Duration took{ 0 };
  drive::Monitor values;

  bool brings(const char* field) const;
  /// It shows whether the motor runs: without such a word there is no status (contract, 8.15).
  bool tellsRun() const;
  /// It takes turns with others within the share of the slow values (contract, 8.3).
  bool isSlowed() const;
};

/// The reads that make the status of one inverter, in the order in which they go: slow ones, those of a trip, fast ones, so
/// that the stamp belongs to the values that matter. Pure. Not thread safe; the bus guards it.
class StatusReads
{
public:
  /// \p drive must outlive it.
  explicit StatusReads(const drive::Drive& drive);

  /// All in full, but across no hole that the drive has shown: \p chosen, where the drive has such a read in use, and what
  /// it doesn't bring. What was read by the same ones still counts.
  void build(const std::optional<drive::ReadBlock>& chosen);
  /// The same, and \p proof: reads that compare.
  void change(const std::optional<drive::ReadBlock>& chosen, const std::vector<drive::ReadBlock>& proof);
  /// The same without a chosen one; nothing that was read counts any more.
  void forget();
  /// The drive refuses this read: two smaller ones take its place, \p for_good: also when all are built again. False: it
  /// brings one value only, and stays.
  bool split(std::size_t index, bool for_good);

  std::size_t size() const;
  StatusRead& operator[](std::size_t index);
  const StatusRead& operator[](std::size_t index) const;
  /// Those of a kind that may be asked for at \p now, in order.
  std::vector<std::size_t> open(StatusRead::Kind kind, TimePoint now) const;
  /// Any of them shows whether the motor runs.
  bool tellRun() const;
  /// The same of those beside \p index that may be asked for at \p now.
  bool othersTellRun(std::size_t index, TimePoint now) const;
  /// For costs.
  std::vector<drive::ReadBlock> blocks(StatusRead::Kind kind) const;

  // --- slow values ------------------------------------------------------------------------------------------------
  /// Those that the share slows are to be read every \p period.
  void planPeriod(Duration period);
  /// How often they are read: as planned, or as seen where that is longer.
  Duration slowPeriod() const;
  /// The wire's time for all of them once, with \p gap before each; \p unread: for one that has not been read yet.
  Duration slowNeeds(Duration gap, Duration unread) const;
  /// Age of the oldest of them; empty: none was read yet.
  std::optional<Duration> slowAge(TimePoint now) const;
  /// Adds the slow values that are not too old to \p monitor.
  void addSlowValues(TimePoint now, drive::Monitor& monitor) const;

private:
  bool halve(std::size_t index);
  void add(const std::vector<drive::ReadBlock>& blocks, StatusRead::Kind kind);

  const drive::Drive& drive_;
  std::vector<StatusRead> reads_;
  /// Those that went when all were built, and may come again.
  std::vector<StatusRead> shelved_;
  Duration planned_{ 0 };
  /// First word and number of words of reads that the drive does not answer as a whole.
  std::set<std::pair<std::uint16_t, unsigned>> holes_;
};

/// Splits a read in two at the widest gap between its values; a block of one value stays as it is.
std::vector<drive::ReadBlock> splitBlock(const drive::Drive& drive, const drive::ReadBlock& block);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_STATUS_READS_H

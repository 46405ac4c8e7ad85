// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_MAPPED_READS_H
#define INVERTER_BUS_BUS_MAPPED_READS_H

#include <optional>
#include <vector>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// What a refresh may do with the drive's register map, as ordered when it began.
struct MapOrders
{
  /// The read that takes the place of what it brings; empty: plain reads.
  std::optional<drive::ReadBlock> read;
  /// RUN has the same value in the words of \ref read as when they were proven; empty: they were proven with RUN on and
  /// off.
  std::optional<bool> proven_with_run;
  /// Mapped words are compared with plain ones in this refresh: the mapped read, and the plain one that is made after it.
  std::vector<drive::ReadBlock> proof;
};

/// How that went.
struct MapOutcome
{
  enum class Verdict
  {
    /// Nothing can be said: the drive's state changed meanwhile, or there was nothing to compare.
    Open,
    Equal,
    Unlike,
    /// The read in use contradicts itself: the frequency, which is no mapped word, and the bit that shows whether the
    /// motor turns.
    Doubtful,
    /// The drive refused the read.
    Refused
  };
  Verdict verdict = Verdict::Open;
  /// RUN as the plain reads showed it.
  bool run = false;
};

/// The reads through a drive's register map during a refresh, and whether they bring what plain reads bring. Pure. Not
/// thread safe; the bus guards it.
class MappedReads
{
public:
  /// For the next refresh. Returns whether the reads change. After drop() that one has plain reads, whatever \p given says.
  bool take(const MapOrders& given);
  const MapOrders& orders() const;

  /// A read of the proof was answered: \p mapped or the plain one after it. \p before is what plain reads of the same
  /// refresh brought before.
  void compare(bool mapped, const drive::Monitor& values, const drive::Monitor& before);
  /// \p values came with the read in use. False: their value of RUN was never proven, or they contradict themselves; they
  /// must not be used.
  bool accepts(const drive::Monitor& values);
  /// The drive refused the mapped read.
  void refused();
  /// The refresh under way starts again, with plain reads.
  void drop();
  /// Once.
  std::optional<MapOutcome> takeOutcome();
  /// Plain reads from now on.
  void forget();

private:
  MapOrders orders_;
  std::optional<std::uint32_t> mapped_word_;
  std::optional<MapOutcome> outcome_;
  bool plain_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_MAPPED_READS_H

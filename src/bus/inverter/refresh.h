// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_REFRESH_H
#define INVERTER_BUS_BUS_REFRESH_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// The status refresh of one inverter: which read is next, and what the drive has said so far with the time of each word.
///
/// Each refresh reads all fast blocks, the fault blocks while the drive is tripped, and at most one slow block that is
/// due. Values belong to the stamp only if they came in one refresh; slow ones leave the status when they are older than
/// one second (contract, section 2).
class Refresh
{
public:
  Refresh(const drive::Drive& drive, std::uint8_t station);

  /// Percent of these become A and V; without them such values stay empty.
  void setRatings(const drive::Ratings& ratings);
  /// Reads the words that the user chose in one exchange, and beside it only what that read doesn't bring; empty: direct
  /// reads. A refresh under way starts again if this changes anything.
  void useBlock(const std::optional<drive::ReadBlock>& block);
  /// The read of chosen words, while it is in use.
  const std::optional<drive::ReadBlock>& block() const;
  /// The drive has refused the read of chosen words, or it brought something else than what was chosen; true once.
  bool takeBlockRefusal();
  /// Titles and values of chosen words that no status field shows.
  const std::vector<std::pair<std::string, std::string>>& chosenValues() const;

  /// The read that is due; starts a new refresh when none is under way.
  const drive::ReadBlock& next(TimePoint now);

  /// The drive has just refused a read of its run words that can't be had in another form; true once.
  bool takeRefusal();

  /// The answer to next(). Returns true when the refresh needs another exchange.
  bool received(const wire::Reply& reply);
  /// The drive refused the read (exception): a block of several values is split, a single value is left out for a while.
  bool refused(const wire::Reply& reply);
  /// The read failed after its repeats: this refresh ends without a result.
  void failed();

  /// True after the last read of a refresh, once.
  bool takeComplete();
  /// Everything that may be shown at \p now.
  drive::Monitor monitor(TimePoint now) const;
  /// The run words of the last complete refresh and when their request left.
  const drive::Monitor& fresh() const;
  TimePoint freshSentAt() const;
  /// The same of the refresh under way: what has come so far.
  const drive::Monitor& words() const;
  TimePoint wordsSentAt() const;
  /// Leaves the read at hand out for a while if it is one of the slow values; false: it is not, or nothing follows it.
  bool skipSlow();
  /// The marker of a restart that was just read is dealt with: the rest of this refresh must not find it once more, after
  /// the drive has been told what it had forgotten.
  void restartNoted();
  /// The drive may have been switched off and on: whether it was is read before any other slow value.
  void suspectRestart();
  /// Whether our RUN is still in force is read before any other slow value.
  void askForRun();
  TimePoint stamp() const;
  bool hasStamp() const;
  /// Nothing that was read counts any more (inverter offline).
  void forget();
  /// All blocks of one refresh without slow ones, for costs.
  std::vector<drive::ReadBlock> fastBlocks() const;
  /// Slow blocks in use.
  std::vector<drive::ReadBlock> slowBlocks() const;

private:
  enum class Class
  {
    Fast,
    Fault,
    Slow
  };
  struct Block
  {
    drive::ReadBlock read;
    Class kind;
    TimePoint last;
    bool ever = false;
    TimePoint left_out_until;
    drive::Monitor values;
  };
  void plan(TimePoint now);
  void planSlow(TimePoint now);
  bool goesFirst(const Block& block) const;
  void buildBlocks();
  void takeRunWords(const Block& block, const wire::Reply& reply);
  bool isChosenWord(const Block& block, const wire::Reply& reply) const;
  bool dropBlock();
  void planFaultReads();
  bool tellsRun(const Block& block) const;
  bool leaveOut(std::size_t index, const wire::Reply& reply);
  bool advance();
  bool postpone();

  const drive::Drive& drive_;
  std::uint8_t station_;
  std::vector<Block> blocks_;
  std::vector<std::size_t> plan_;
  std::size_t position_ = 0;
  std::size_t slow_cursor_ = 0;
  drive::Monitor scratch_;
  TimePoint scratch_sent_at_;
  TimePoint scratch_stamp_;
  TimePoint asked_at_;
  bool fault_planned_ = false;
  /// A run word was read in the refresh under way.
  bool run_read_ = false;
  bool run_refused_ = false;
  drive::Monitor fresh_;
  TimePoint fresh_sent_at_;
  TimePoint stamp_;
  bool has_stamp_ = false;
  bool complete_ = false;
  drive::Ratings ratings_;
  std::optional<drive::ReadBlock> block_;
  std::vector<std::pair<std::string, std::string>> chosen_values_;
  /// It has brought the same status word as a direct read before it.
  bool block_proven_ = false;
  bool block_refused_ = false;
  unsigned block_refusals_ = 0;
  /// The slow words that decide over safety have come since the last return.
  bool run_heard_ = false;
  /// An exchange got lost since the marker of a restart was read.
  bool restart_suspected_ = false;
};

/// Splits a read in two at the widest gap between its values; a block of one value stays as it is.
std::vector<drive::ReadBlock> splitBlock(const drive::Drive& drive, const drive::ReadBlock& block);

/// Adds what \p from knows to \p to.
void mergeMonitor(const drive::Monitor& from, drive::Monitor& to);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_REFRESH_H

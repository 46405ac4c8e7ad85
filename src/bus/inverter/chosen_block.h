// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_CHOSEN_BLOCK_H
#define INVERTER_BUS_BUS_CHOSEN_BLOCK_H

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// The read of words that the drive's user chose (block read), while a refresh uses it: whether the drive brings what was
/// chosen, and takes it at all. Pure. Not thread safe; the bus guards it.
class ChosenBlock
{
public:
  /// \p drive must outlive it.
  explicit ChosenBlock(const drive::Drive& drive);

  /// From now on \p block is read; empty: direct reads. Returns whether that changes anything.
  bool use(const std::optional<drive::ReadBlock>& block);
  /// Empty: not in use.
  const std::optional<drive::ReadBlock>& read() const;
  /// Titles and values of chosen words that no status field shows.
  const std::vector<std::pair<std::string, std::string>>& values() const;

  /// \p reply brought it; \p direct is what direct reads of the same refresh brought before it. False: these are not the
  /// words that were chosen, and it must not be used.
  bool received(const wire::Reply& reply, const drive::Ratings& ratings, const drive::Monitor& direct);
  /// The drive has refused it, for good or for the moment. True: too often.
  bool refused(bool for_good);
  /// It is not used any more, since it brings something else, or the drive refuses it.
  void drop();
  /// drop() was called; true once.
  bool takeRefusal();
  /// The inverter is offline.
  void forget();

private:
  bool isChosenWord(const wire::Reply& reply, const drive::Ratings& ratings, const drive::Monitor& direct) const;

  const drive::Drive& drive_;
  std::optional<drive::ReadBlock> read_;
  std::vector<std::pair<std::string, std::string>> values_;
  /// It has brought the same status word as a direct read before it.
  bool proven_ = false;
  bool dropped_ = false;
  unsigned refusals_ = 0;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_CHOSEN_BLOCK_H

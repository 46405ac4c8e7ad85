// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_BENCH_PROFILE_MEMORY_H
#define INVERTER_BUS_SRC_BENCH_PROFILE_MEMORY_H

#include <cstdint>
#include <map>

#include "inverter_bus/drive/profile.h"

namespace inverter_bus
{
namespace bench
{
/// Registers and coils of the items that a profile names, by their numbers on the wire; nothing else exists.
class ProfileMemory
{
public:
  explicit ProfileMemory(const drive::Profile& profile);

  bool has(drive::Space space, std::uint16_t address) const;
  /// 0 where there is nothing.
  std::uint16_t word(drive::Space space, std::uint16_t address) const;
  void setWord(drive::Space space, std::uint16_t address, std::uint16_t word);

  /// The whole word, double word or row of coils of an item, without its bit and mask.
  std::uint32_t whole(const drive::Item& item) const;
  void setWhole(const drive::Item& item, std::uint32_t raw);
  /// Puts \p raw under the item's bit or mask and leaves the rest of the word.
  void put(const drive::Item& item, std::uint32_t raw);
  static bool covers(const drive::Item& item, drive::Space space, std::uint16_t address);

private:
  using Words = std::map<std::uint16_t, std::uint16_t>;

  void add(const drive::Item& item);
  void addSpan(drive::Space space, const std::pair<unsigned, unsigned>& span, unsigned offset);
  const Words& words(drive::Space space) const;

  Words registers_;
  Words coils_;
};
}  // namespace bench
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_BENCH_PROFILE_MEMORY_H

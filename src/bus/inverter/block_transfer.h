// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_BLOCK_TRANSFER_H
#define INVERTER_BUS_BUS_BLOCK_TRANSFER_H

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/inverter/drive_settings.h"
#include "inverter_bus/bus/configuration.h"

namespace inverter_bus
{
namespace bus
{
/// Whether a drive's block read and block write are used (contract, 3.10): only while the drive has selected exactly the
/// words that are configured, and only as long as it does not refuse them. Pure: what the drive has selected comes in as an
/// argument, nothing where not all of it is known. Not thread safe; the bus guards it.
class BlockTransfer
{
public:
  /// Both must outlive it.
  BlockTransfer(const drive::Drive& drive, const InverterConfig& config);

  /// The drive has selected the configured words, in their order.
  bool fits(const std::optional<BlockSlots>& slots) const;
  /// The block read that a refresh is to use; nothing: direct reads.
  std::optional<drive::ReadBlock> read(const std::optional<BlockSlots>& slots) const;
  /// Raw values of the parameters that make it fit (`configure_block`), in the order of writing. Once, since each write
  /// wears the EEPROM; empty where nothing is to be written.
  std::vector<std::pair<std::string, std::uint32_t>> takeWrites(const std::optional<BlockSlots>& slots);

  /// One of the parameters that select the words was written: what is selected no longer says what the block brings.
  bool isSelectedBy(const std::string& parameter) const;
  /// Neither is used from now on, for the reason \p why.
  void drop(const std::string& why);
  /// The drive was switched off and on, or has come back: whatever was in the way may be gone.
  void tryAgain();
  /// Why they are not used although the drive has reported its selection.
  std::string whyNot(const BlockSlots& slots) const;

private:
  std::vector<int> wantedWriteCodes() const;

  const drive::Drive& drive_;
  const InverterConfig& config_;
  /// Empty: nothing is in the way but the drive's selection.
  std::string dropped_;
  bool configured_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_BLOCK_TRANSFER_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_MAP_TABLE_H
#define INVERTER_BUS_BUS_MAP_TABLE_H

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// What the drive has in the parameters of its register map (contract, 8.17), read in a few exchanges after each connect.
/// It says what the drive will do from its next power-on, not what it does now. Pure. Not thread safe; the bus guards it.
class MapTable
{
public:
  /// \p wanted: the map is to be used; otherwise nothing is read. \p drive must outlive it.
  MapTable(const drive::Drive& drive, bool wanted);

  /// All is read again.
  void restart();
  /// Null: nothing is left to read.
  const drive::ReadBlock* next() const;
  /// The answer to it. One that the drive refuses ends the reading: it has no map.
  void done(const wire::Reply& reply);

  bool known() const;
  bool refused() const;
  /// All of it is as the profile wants it.
  bool fits() const;
  /// The drive has switched its map on, for something else.
  bool inOtherUse() const;
  /// Parameters that are to be written, and their raw values, in the order of writing.
  std::vector<std::pair<std::string, std::uint32_t>> differences() const;
  bool has(const std::string& parameter) const;
  /// What is in the drive, and what is wanted: "P200 = 1, P201 = 0x4001". Only what is not 0 in either and differs.
  std::string text() const;
  std::string wantedText() const;

private:
  std::string differing(bool wanted) const;

  const drive::Drive& drive_;
  std::vector<drive::ReadBlock> reads_;
  std::size_t next_ = 0;
  bool refused_ = false;
  std::map<std::string, std::uint32_t> values_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_MAP_TABLE_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_ITEM_READER_H
#define INVERTER_BUS_SRC_DRIVE_ITEM_READER_H

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/cursor.h"
#include "inverter_bus/drive/profile.h"

namespace inverter_bus
{
namespace drive
{
using config::Cursor;
using config::Entry;
using config::Section;
using config::Value;

/// How the drive counts: difference between the wire address and the number printed in the manual, and the numbers that
/// have names.
struct Numbering
{
  std::int64_t register_offset = 0;
  std::int64_t coil_offset = 0;
  /// The last two digits of a register's number count decimally.
  bool decimal = false;
  /// CompoWay/F: variables instead of coils and registers.
  bool variables = false;
  std::map<std::string, Constant> constants;

  std::int64_t offset(Space space) const;
  /// Printed numbers whose wire address is 0 to 65535.
  std::int64_t lowest(Space space) const;
  std::int64_t highest(Space space) const;
};

/// Which kinds of item are allowed at a place.
struct ItemRules
{
  bool coil = true;
  /// Several coils packed into one word.
  bool packed_coils = false;
  /// One bit of a register.
  bool bit = false;
  /// Raw values with another meaning.
  bool values = false;
  /// resolution, unit, signed.
  bool scale = true;
  /// `of`: percent of a rating.
  bool base = false;
  /// A place that is written: an operation code is possible, the controller status isn't.
  bool written = false;
};

/// Takes the place of an unknown value.
constexpr const char* UNKNOWN = "unknown";

/// Reads the keys of an item: register or coil and what belongs to it, `unconfirmed` and `source`. Other keys of the
/// map are left to the caller, who calls Section::finish(). Empty after a mistake in the address.
std::optional<Item> readItem(Section& map, const Numbering& numbering, const ItemRules& rules);

/// [[first, last], ...] of printed numbers, in ascending order and apart from each other.
std::vector<std::pair<unsigned, unsigned>> readSpans(const Cursor& cursor, const Numbering& numbering, Space space);

/// The largest raw value that an item can hold, sign apart.
std::uint32_t largestRaw(const Item& item);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_ITEM_READER_H

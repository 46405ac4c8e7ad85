// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_BUS_CONFIGURATION_SECTION_H
#define INVERTER_BUS_SRC_BUS_CONFIGURATION_SECTION_H

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/bus/configuration.h"

namespace inverter_bus
{
namespace bus
{
/// Numbers that a key may have, both ends included unless \ref above_minimum.
struct Range
{
  double minimum = 0.0;
  double maximum = 0.0;
  /// The minimum itself is too small.
  bool above_minimum = false;
  std::string unit;
};

/// \p value in one short line of printable characters, for messages.
std::string describe(const Value& value);

class Section;

/// Key `limit` of the bus or of an entry.
Limit readLimit(const Section& section, Limit fallback);

/// What is taken although it should be mended, one line each.
using Remarks = std::vector<std::string>;

/// A map of the configuration that is being judged. Every getter throws drive::ConfigurationError with one line that
/// names place, key, value and what is allowed.
class Section
{
public:
  /// \throws drive::ConfigurationError if \p value is no map
  Section(const Value& value, const std::string& place, std::shared_ptr<Remarks> remarks);

  const std::shared_ptr<Remarks>& remarks() const;
  /// Where this map itself stands.
  const std::string& place() const;

  /// Takes the keys of \p defaults that are not here; messages about them name its place.
  void inherit(const Section& defaults);

  /// \throws drive::ConfigurationError for the first key that is not in \p known
  void refuseUnknownKeys(const std::vector<std::string>& known) const;

  bool has(const std::string& key) const;
  /// Null if the key is not there.
  const Value* find(const std::string& key) const;
  /// Where \p key stands, or would stand.
  std::string placeOf(const std::string& key) const;

  bool boolean(const std::string& key, bool fallback) const;
  std::int64_t integer(const std::string& key, std::int64_t fallback, std::int64_t minimum, std::int64_t maximum) const;
  double number(const std::string& key, double fallback, const Range& range) const;
  std::optional<double> number(const std::string& key, const Range& range) const;
  std::string text(const std::string& key, const std::string& fallback) const;
  /// One of \p allowed.
  std::string choice(const std::string& key, const std::string& fallback,
                     const std::vector<std::string>& allowed) const;
  std::int64_t choice(const std::string& key, std::int64_t fallback, const std::vector<std::int64_t>& allowed) const;

  /// \throws drive::ConfigurationError that \p key must be there
  void require(const std::string& key, const std::string& allowed) const;

  /// \throws drive::ConfigurationError "place: key 'key' = value: problem; allowed: ..."
  [[noreturn]] void fail(const std::string& key, const std::string& problem, const std::string& allowed) const;

private:
  struct Entry
  {
    Value value;
    std::string place;
  };
  /// The number of a value; empty: it is none.
  std::optional<double> numberOf(const std::string& key, const Value& value) const;
  /// \p allowed, and a hint where \p value looks like what is wanted.
  static std::string withHint(const std::string& allowed, const Value& value);

  std::map<std::string, Entry> entries_;
  std::string place_;
  std::shared_ptr<Remarks> remarks_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_BUS_CONFIGURATION_SECTION_H

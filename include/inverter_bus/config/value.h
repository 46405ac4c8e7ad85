// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_CONFIG_VALUE_H
#define INVERTER_BUS_CONFIG_VALUE_H

#include <cstdint>
#include <string>
#include <vector>

namespace inverter_bus
{
namespace config
{
struct Entry;

/// A value of a profile, of a scan list or of the parameter server and all that is in it, before anybody has judged it.
struct Value
{
  enum class Type
  {
    None,
    Boolean,
    Integer,
    Number,
    Text,
    List,
    Map
  };
  Type type = Type::None;
  bool boolean = false;
  std::int64_t integer = 0;
  /// Also set for integers; of those that 64 bits can't hold only this is right (and the type is Number).
  double number = 0.0;
  /// Of anything but lists and maps: as written in the file, or as it would be, without quotes.
  std::string text;
  /// A text in quotes, in a block, or marked with !!str: a text whatever it looks like.
  bool quoted = false;
  /// "file:line" or the scan list entry, for messages; empty: unknown.
  std::string place;
  std::vector<Value> list;
  /// In the order of the file; no key twice.
  std::vector<Entry> map;

  static Value ofBoolean(bool boolean);
  static Value ofInteger(std::int64_t integer);
  static Value ofNumber(double number);
  static Value ofText(const std::string& text);
  static Value ofMap(std::vector<Entry> entries);

  bool isScalar() const;

  /// Null if the key is not there, or this is not a map. 0x21 and 33 are the same key.
  Value* find(const std::string& key);
  const Value* find(const std::string& key) const;
  void erase(const std::string& key);
  /// Takes the entries of \p defaults whose keys are not here.
  void inherit(const Value& defaults);
  /// Makes \p new_place the place of this value and of all in it.
  void moveTo(const std::string& new_place);
};

struct Entry
{
  std::string key;
  Value value;
};
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_CONFIG_VALUE_H

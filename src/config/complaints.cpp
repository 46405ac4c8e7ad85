// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "config/complaints.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace config
{
namespace
{
using Words = std::vector<std::string>;

std::string lowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// "commandTimeout-x" as command, timeout, x.
Words wordsOf(const std::string& key)
{
  Words words(1);
  bool lower = false;
  for (const char c : key)
  {
    const auto byte = static_cast<unsigned char>(c);
    const bool part = std::isalnum(byte) != 0;
    if (!part || (lower && std::isupper(byte) != 0))
    {
      words.emplace_back();
    }
    lower = std::islower(byte) != 0;
    if (part)
    {
      words.back() += static_cast<char>(std::tolower(byte));
    }
  }
  words.erase(std::remove(words.begin(), words.end(), std::string()), words.end());
  return words;
}

/// Insertions, deletions and replacements that make \p b of \p a (Levenshtein).
std::size_t distance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
  {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j)
    {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({ row[j] + 1, row[j - 1] + 1, replaced });
    }
  }
  return row[b.size()];
}
}  // namespace

std::string lineOf(const Spot& spot, const std::string& what)
{
  constexpr std::size_t LONGEST = 1000;
  return util::printable(
      spot.place + ": " + (spot.path.empty() ? "" : "key '" + util::printable(spot.path) + "': ") + what, LONGEST);
}

void Complaints::refuse(const Spot& spot, const Value& value, const std::string& /*problem*/,
                        const std::string& allowed)
{
  const std::string given =
      value.isScalar() ? "value '" + util::printable(value.text) + "'" + (value.quoted ? " (a text, in quotes)" : "")
      : value.type == Value::Type::List ? "is a list"
      : value.type == Value::Type::Map  ? "is a map"
                                        : "has no value";
  complain(spot, given + ": allowed: " + allowed);
}

void Complaints::miss(const Spot& spot, const std::string& /*allowed*/)
{
  complain(spot, "is missing: must be given");
}

void Complaints::refuseKey(const Spot& spot, const Entry& entry, const std::vector<std::string>& known)
{
  const std::string meant = nearest(entry.key, known);
  complain(spot,
           "unknown key: allowed: " + util::joined(known) + (meant.empty() ? "" : " (did you mean '" + meant + "'?)"));
}

void Complaints::remark(const Spot& /*spot*/, const Value& /*value*/, const std::string& /*what*/)
{
}

std::string nearest(const std::string& key, const std::vector<std::string>& known)
{
  constexpr std::size_t SLIPS = 2;
  constexpr std::size_t LONGEST_KEY = 100;  // no known one is half as long
  if (key.size() > LONGEST_KEY)
  {
    return "";
  }
  const std::string lower = lowerCase(key);
  std::string best;
  std::size_t best_distance = SLIPS + 1;
  for (const std::string& candidate : known)
  {
    const std::size_t steps = distance(lower, candidate);
    if (steps < best_distance)
    {
      best = candidate;
      best_distance = steps;
    }
  }
  const Words words = wordsOf(key);
  for (auto candidate = known.begin(); best.empty() && candidate != known.end(); ++candidate)
  {
    const Words others = wordsOf(*candidate);
    best =
        std::find_first_of(words.begin(), words.end(), others.begin(), others.end()) == words.end() ? "" : *candidate;
  }
  return best;
}
}  // namespace config
}  // namespace inverter_bus

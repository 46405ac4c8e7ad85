// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/wire/peer_words.h"

#include <algorithm>

#include "util/printable.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
/// The beginning says what the matter is.
constexpr std::size_t LONGEST = 200;
/// Shorter text comes about by chance.
constexpr std::size_t SHORTEST = 6;

bool isBlank(char character)
{
  return character == ' ' || character == '\t' || character == '\r' || character == '\n' || character == '\0';
}

bool isText(char character)
{
  return isBlank(character) || (character > ' ' && character < '\x7F');
}
}  // namespace

void PeerWords::forget()
{
  said_.clear();
}

void PeerWords::add(const Bytes& bytes)
{
  const std::size_t count = std::min(bytes.size(), LONGEST - said_.size());
  said_.append(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
}

std::string PeerWords::text() const
{
  const auto first = std::find_if_not(said_.begin(), said_.end(), isBlank);
  const auto last = std::find_if_not(said_.rbegin(), said_.rend(), isBlank).base();
  if (last - first < static_cast<std::ptrdiff_t>(SHORTEST) || !std::all_of(first, last, isText))
  {
    return "";
  }
  std::string line;
  for (auto place = first; place != last; ++place)
  {
    // A line break is a blank, and several are one.
    if (!isBlank(*place))
    {
      line += *place;
    }
    else if (line.back() != ' ')
    {
      line += ' ';
    }
  }
  return util::printable(line);
}
}  // namespace wire
}  // namespace inverter_bus

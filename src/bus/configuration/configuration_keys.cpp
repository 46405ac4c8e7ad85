// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/configuration/configuration_keys.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace inverter_bus
{
namespace bus
{
namespace
{
using Keys = std::vector<std::string>;

bool contains(const Keys& keys, const std::string& key)
{
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Of the contract, for a version to come: ignored they would promise what nobody does.
const Keys& laterKeys()
{
  static const Keys KEYS{ "slow_interval", "in_service", "parameters", "parameters_on_difference" };
  return KEYS;
}

/// Of the map `simulation`, which the simulated bus reads.
const Keys& simulationKeys()
{
  static const Keys KEYS{ "model",
                          "station",
                          "turnaround",
                          "start_up_time",
                          "load",
                          "reset_silence",
                          "eeprom_time",
                          "restart_after_timeout",
                          "reverse_word",
                          "monitor_base",
                          "operation_codes",
                          "self_clearing_coils",
                          "area_1_readable",
                          "mapped_reads_in_blocks",
                          "reserved_readable" };
  return KEYS;
}

/// Parameters that many ROS nodes have, and that a launch file sets at its top level for all of them; they are not ours although
/// `baud_rate` shares a word with them.
bool isOrdinaryRosName(const std::string& key)
{
  static const Keys NAMES{ "rate", "publish_rate", "update_rate", "loop_rate", "control_rate" };
  return contains(NAMES, key);
}

/// "commandTimeout-x" as command, timeout, x.
Keys wordsOf(const std::string& key)
{
  Keys words(1);
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

std::string lowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// The nearest of \p known that is at most two letters away, else one with a word in common; empty: none.
std::string nearest(const std::string& key, const Keys& known)
{
  constexpr std::size_t SLIPS = 2;
  constexpr std::size_t LONGEST_KEY = 100;  // none of ours is half as long
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
  const Keys words = wordsOf(key);
  for (auto candidate = known.begin(); best.empty() && candidate != known.end(); ++candidate)
  {
    const Keys others = wordsOf(*candidate);
    best =
        std::find_first_of(words.begin(), words.end(), others.begin(), others.end()) == words.end() ? "" : *candidate;
  }
  return best;
}

Keys allKeys()
{
  Keys keys = busKeys();
  for (const Keys* more : { &entryKeys(), &laterKeys(), &simulationKeys() })
  {
    keys.insert(keys.end(), more->begin(), more->end());
  }
  return keys;
}
}  // namespace

const Keys& busKeys()
{
  /// `simulation` belongs to the simulated bus, which reads the same file.
  static const Keys KEYS{ "port",
                          "protocol",
                          "baud_rate",
                          "parity",
                          "data_bits",
                          "stop_bits",
                          "rs485",
                          "interval",
                          "response_timeout",
                          "gateway_timeout",
                          "pause_in_reply",
                          "limit",
                          "retries",
                          "offline_after",
                          "exclusive",
                          "realtime_priority",
                          "idle_divisor",
                          "parameter_access",
                          "trace_directory",
                          "defaults",
                          "scan_list",
                          "simulation" };
  return KEYS;
}

const Keys& sharedKeys()
{
  static const Keys KEYS{ "drive",
                          "hz_per_unit",
                          "max_velocity",
                          "min_velocity",
                          "command_timeout",
                          "response_timeout",
                          "rated_current",
                          "rated_voltage",
                          "configure_block",
                          "block_read",
                          "configure_map",
                          "stop_unexpected_motion",
                          "release_on_exit",
                          "overrides",
                          "confirm",
                          "limit",
                          "skip" };
  return KEYS;
}

const Keys& entryKeys()
{
  static const Keys KEYS = [] {
    Keys keys = sharedKeys();
    keys.insert(keys.begin(), { "name", "node" });
    return keys;
  }();
  return KEYS;
}

bool isLibraryKey(const std::string& key)
{
  return key == "diagnostic_period";
}

std::string remarkOn(const std::string& key)
{
  if (contains(laterKeys(), key))
  {
    return "a later version offers it, this one does not yet";
  }
  if (contains(entryKeys(), key))
  {
    return "it belongs into scan_list or defaults";
  }
  if (contains(busKeys(), key))
  {
    return "it belongs to the bus, at the top";
  }
  if (contains(simulationKeys(), key))
  {
    return "it belongs into simulation";
  }
  const std::string meant = isOrdinaryRosName(key) ? "" : nearest(key, allKeys());
  return meant.empty() ? "" : "did you mean '" + meant + "'?";
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_BUS_CONFIGURATION_KEYS_H
#define INVERTER_BUS_SRC_BUS_CONFIGURATION_KEYS_H

#include <string>
#include <vector>

namespace inverter_bus
{
namespace bus
{
/// The node's own parameters.
const std::vector<std::string>& busKeys();

/// Keys of a scan list entry that `defaults` may hold too.
const std::vector<std::string>& sharedKeys();

/// Keys of a scan list entry.
const std::vector<std::string>& entryKeys();

/// Parameters that lie below the node's name and belong to a library in it (diagnostic_updater).
bool isLibraryKey(const std::string& key);

/// What to say of \p key, which is unknown where it stands: that a later version offers it, that it belongs elsewhere, which one may
/// be meant. Empty: it resembles none of ours at any level, so that it was not meant for us.
std::string remarkOn(const std::string& key);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_BUS_CONFIGURATION_KEYS_H

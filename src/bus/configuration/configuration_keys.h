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

/// Parameters below the node's name that belong to a library in it (diagnostic_updater).
bool isLibraryKey(const std::string& key);

/// The hint for \p key, which is unknown where it is given: a later version will have it, it belongs elsewhere, or which
/// one may be meant. Empty: it resembles no key of this node at any level, so it was not meant for this node.
std::string remarkOn(const std::string& key);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_BUS_CONFIGURATION_KEYS_H

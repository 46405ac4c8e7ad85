// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_PEER_WORDS_H
#define INVERTER_BUS_WIRE_PEER_WORDS_H

#include <string>

#include "inverter_bus/wire/port.h"

namespace inverter_bus
{
namespace wire
{
/// Text among the bytes that belonged to no frame: a serial server that refuses a client says why before it closes
/// ("Port already in use"), others send a banner, which is as harmless as noise.
class PeerWords
{
public:
  /// A new connection, or a valid reply: what was said before explains nothing that follows.
  void forget();
  void add(const Bytes& bytes);
  /// One line, fit for a message (see util::printable()); empty if it is not a text.
  std::string text() const;

private:
  std::string said_;
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_PEER_WORDS_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_ECHO_FILTER_H
#define INVERTER_BUS_WIRE_ECHO_FILTER_H

#include "inverter_bus/wire/port.h"

namespace inverter_bus
{
namespace wire
{
/// Finds out whether the adapter returns what it sends (local echo) and takes the echo out of the received bytes.
///
/// A reply can equal its request (05, 06 and 08 hex), so that with such a request the echo cannot be told from the reply: the
/// finding comes from unmistakable requests. **The first request after opening must therefore be a read**;
/// it need not be answered, for the echo comes all the same.
class EchoFilter
{
public:
  /// The port was reopened: another adapter may be behind it.
  void forget();
  /// \p frame was sent. \p reply_may_equal: its reply may be the very same bytes.
  void expect(const Bytes& frame, bool reply_may_equal);
  /// Takes the expected echo out of \p buffer, and moves what precedes it to \p damaged. True if it was there.
  bool strip(Bytes& buffer, Bytes& damaged);
  /// True while \p buffer may be the beginning of the expected echo and must not be looked at otherwise.
  bool holds(const Bytes& buffer) const;
  /// A valid reply came. \p clean: nothing but this reply did, so that there was no echo.
  void answered(bool clean);
  bool found() const;

private:
  /// The echo that is still to come; empty if none is expected.
  Bytes expected_;
  bool found_ = false;
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_ECHO_FILTER_H

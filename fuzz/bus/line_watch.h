// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_LINE_WATCH_H
#define INVERTER_BUS_FUZZ_LINE_WATCH_H

#include "fuzz/bus/checks.h"
#include "inverter_bus/simulation/simulated_line.h"

namespace inverter_bus
{
namespace fuzz
{
/// Reports to the checks what happens on the line.
class LineWatch
{
public:
  explicit LineWatch(Checks& checks);

  void opened(TimePoint now);
  void lost(TimePoint now);
  /// The first byte of a request leaves now.
  void sending(TimePoint now, const simulation::Bytes& frame);
  /// Bytes have come out at the master's end.
  void heard(TimePoint now);
  /// The driver has finished the exchange that it began since the last call, if any; nothing is in flight now.
  void stepped(TimePoint now);
  /// A frame of any sender is over.
  void frame(TimePoint now, const simulation::FrameRecord& frame);

private:
  void expireWatchdogs(TimePoint now);
  void checkCommandWords(TimePoint now);
  void endExchange(TimePoint now);
  void takeReply(TimePoint now, const simulation::FrameRecord& frame, std::size_t index);
  void takeAnswer(TimePoint now, std::size_t index, const ReplyFacts& reply);

  Checks& checks_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_LINE_WATCH_H

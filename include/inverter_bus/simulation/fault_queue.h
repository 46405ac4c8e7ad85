// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_FAULT_QUEUE_H
#define INVERTER_BUS_SIMULATION_FAULT_QUEUE_H

#include <cstddef>
#include <optional>
#include <vector>

#include "inverter_bus/simulation/time.h"

namespace inverter_bus
{
namespace simulation
{
/// What can go wrong with one exchange, in the order in which it is done to a reply.
enum class FaultKind
{
  LostRequest,     ///< the drive doesn't hear the request: nothing is executed, nothing answered
  LostReply,       ///< executed, but the reply never comes
  Exception,       ///< not executed; answered with the exception `value`
  ForeignStation,  ///< the reply carries another station number (its check sum is right)
  ForeignShape,    ///< the reply belongs to another kind of request (its check sum is right)
  Damaged,         ///< one byte of the reply is wrong
  Truncated,       ///< only the first `value` bytes of the reply come
  Noise,           ///< `value` random bytes come right before the reply
  Late             ///< the reply comes `value` seconds later
};

/// What a request does to the drive. A frame that does both (17H) writes; a loop-back does neither.
enum class Access
{
  Read,
  Write,
  Neither
};

struct Fault
{
  FaultKind kind = FaultKind::LostReply;
  double value = 0.0;              ///< see FaultKind
  int count = 1;                   ///< how many of the next exchanges it hits; 0: all until `until` or a clear
  std::optional<TimePoint> until;  ///< end of its life
  std::optional<int> function;     ///< hits only requests with this function code
  std::optional<Access> access;    ///< hits only requests that do this
  std::size_t longer_than = 0;     ///< hits only exchanges whose reply has more bytes than this; 0: all
};

/// What decides whether a fault is for an exchange.
struct ExchangeFacts
{
  std::optional<int> function;
  Access access = Access::Neither;
};

/// The injected faults of one drive that wait for an exchange. No threads of its own.
class FaultQueue
{
public:
  void add(const Fault& fault);
  void clear();
  std::size_t size() const;

  /// The faults that hit the exchange at `now`, at most one of each kind, in the order of FaultKind; their
  /// counts go down by one. Those for long replies only are not among them.
  std::vector<Fault> take(const ExchangeFacts& exchange, TimePoint now);
  /// The same of those for long replies only, once the reply is known.
  std::vector<Fault> takeForReply(const ExchangeFacts& exchange, std::size_t reply_size, TimePoint now);

private:
  std::vector<Fault> takeSome(const ExchangeFacts& exchange, std::size_t reply_size, bool long_only, TimePoint now);

  std::vector<Fault> faults_;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_FAULT_QUEUE_H

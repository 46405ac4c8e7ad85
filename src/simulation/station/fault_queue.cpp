// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "inverter_bus/simulation/fault_queue.h"

#include <algorithm>

namespace inverter_bus
{
namespace simulation
{
void FaultQueue::add(const Fault& fault)
{
  faults_.push_back(fault);
}

void FaultQueue::clear()
{
  faults_.clear();
}

std::size_t FaultQueue::size() const
{
  return faults_.size();
}

std::vector<Fault> FaultQueue::take(const ExchangeFacts& exchange, TimePoint now)
{
  return takeSome(exchange, 0, false, now);
}

std::vector<Fault> FaultQueue::takeForReply(const ExchangeFacts& exchange, std::size_t reply_size, TimePoint now)
{
  return takeSome(exchange, reply_size, true, now);
}

std::vector<Fault> FaultQueue::takeSome(const ExchangeFacts& exchange, std::size_t reply_size, bool long_only,
                                        TimePoint now)
{
  std::vector<Fault> hits;
  if (faults_.empty())
  {
    return hits;
  }
  faults_.erase(std::remove_if(faults_.begin(), faults_.end(),
                               [now](const Fault& fault) { return fault.until && *fault.until <= now; }),
                faults_.end());
  for (Fault& fault : faults_)
  {
    const bool again = std::any_of(hits.begin(), hits.end(), [&](const Fault& hit) { return hit.kind == fault.kind; });
    const bool its_size = long_only ? fault.longer_than > 0 && reply_size > fault.longer_than : fault.longer_than == 0;
    const bool meant =
        (!fault.function || fault.function == exchange.function) && (!fault.access || *fault.access == exchange.access);
    if (again || !its_size || !meant)
    {
      continue;
    }
    hits.push_back(fault);
    fault.count = fault.count == 1 ? -1 : std::max(0, fault.count - 1);
  }
  faults_.erase(std::remove_if(faults_.begin(), faults_.end(), [](const Fault& fault) { return fault.count < 0; }),
                faults_.end());
  std::sort(hits.begin(), hits.end(), [](const Fault& a, const Fault& b) { return a.kind < b.kind; });
  return hits;
}
}  // namespace simulation
}  // namespace inverter_bus

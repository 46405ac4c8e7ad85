// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_LINE_VIEW_H
#define INVERTER_BUS_BUS_LINE_VIEW_H

#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace bus
{
/// All that may be asked of the line: questions without side effects, while the next exchange is decided. The bus thread
/// hands it to Coordinator::next(), and from there to the activities that need it; none keeps it, so that what runs in
/// other threads (requests, reports) can't get at a line that is in use. What they need to know of it LineWatch has
/// copied.
class LineView
{
public:
  virtual ~LineView() = default;

  /// Earliest time from \p now on at which no late reply to an earlier request could be taken for the answer to \p request
  /// (contract, 3.9), if nothing comes until then.
  virtual TimePoint mayAskAt(const wire::Request& request, TimePoint now) const = 0;
  /// Time that this exchange occupies the line if it is answered at once.
  virtual Duration cost(const wire::Request& request) const = 0;
  /// Time that it does if it is not answered.
  virtual Duration costUnanswered(const wire::Request& request) const = 0;

  bool mayAsk(const wire::Request& request, TimePoint now) const
  {
    return mayAskAt(request, now) <= now;
  }
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_LINE_VIEW_H

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_LOOPBACK_KNOWLEDGE_H
#define INVERTER_BUS_BUS_LOOPBACK_KNOWLEDGE_H

#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace bus
{
/// Whether the drive really has the loop-back that its profile promises. One that answers it with an exception does not,
/// nor does one that repeatedly leaves it unanswered but answers other requests. Not thread safe; the bus guards it.
class LoopbackKnowledge
{
public:
  /// \p over_tcp: one loop-back that is left unanswered is enough (contract, 8.8). On a line it takes several: one that got
  /// lost there says little, a server's silence much.
  explicit LoopbackKnowledge(bool over_tcp);

  /// How a loop-back ended.
  void note(wire::Outcome outcome);
  /// Another request was answered: only now does an unanswered loop-back count against the loop-back.
  void otherAnswered();
  /// The drive has come back: it may be another one.
  void tryAgain();

  /// Worth sending where its answer is needed.
  bool usable() const;
  /// Worth sending where its answer would be good news.
  bool worthATry() const;
  /// It has been answered before.
  bool proven() const;

private:
  unsigned most_misses_;
  bool works_ = false;
  bool refused_ = false;
  unsigned misses_ = 0;
  /// Counted already: a drive that answers nothing at all misses once.
  bool missed_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_LOOPBACK_KNOWLEDGE_H

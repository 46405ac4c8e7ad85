// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/loopback_knowledge.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// Loop-backs that may be left unanswered; contract, 8.8, for those over TCP.
constexpr unsigned MOST_MISSES = 3;
constexpr unsigned MOST_MISSES_OVER_TCP = 1;
}  // namespace

LoopbackKnowledge::LoopbackKnowledge(bool over_tcp) : most_misses_(over_tcp ? MOST_MISSES_OVER_TCP : MOST_MISSES)
{
}

void LoopbackKnowledge::note(wire::Outcome outcome)
{
  works_ = works_ || outcome == wire::Outcome::Ok;
  refused_ = refused_ || outcome == wire::Outcome::Exception;
  misses_ += missed_ ? 0 : 1;
  missed_ = true;
}

void LoopbackKnowledge::otherAnswered()
{
  missed_ = false;
}

void LoopbackKnowledge::tryAgain()
{
  misses_ = 0;
}

bool LoopbackKnowledge::usable() const
{
  return works_ || !(refused_ || misses_ >= most_misses_);
}

bool LoopbackKnowledge::worthATry() const
{
  return works_ || !refused_;
}

bool LoopbackKnowledge::proven() const
{
  return works_;
}
}  // namespace bus
}  // namespace inverter_bus

// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/connect_steps.h"

namespace inverter_bus
{
namespace bus
{
ConnectSteps::ConnectSteps(const drive::Drive& drive) : drive_(drive)
{
}

void ConnectSteps::restart()
{
  step_ = 0;
  told_ = Told::NotYet;
  error_id_ = 0;
}

const drive::Step* ConnectSteps::next() const
{
  const drive::Sequence* sequence = drive_.sequence("connect");
  return told_ == Told::NotYet && sequence != nullptr ? &sequence->steps[step_] : nullptr;
}

void ConnectSteps::done(const wire::Reply& reply)
{
  if (isLastingRefusal(reply))
  {
    error_id_ = reply.error_id;
    told_ = Told::Refused;
  }
  else if (reply.outcome == wire::Outcome::Ok && ++step_ >= drive_.sequence("connect")->steps.size())
  {
    told_ = Told::Known;
  }
}

bool ConnectSteps::complete() const
{
  // A step that is not confirmed can't be sent.
  return drive_.profile().sequences.count("connect") == 0 || told_ == Told::Known;
}

std::uint16_t ConnectSteps::refusedWith() const
{
  return error_id_;
}
}  // namespace bus
}  // namespace inverter_bus

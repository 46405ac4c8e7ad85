// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/link.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
Link::Link(int offline_after) : offline_after_(offline_after), exchanges_without_data_(offline_after)
{
}

// --- what happened ---------------------------------------------------------------------------------------------------

void Link::exchangeEnded(const wire::Reply& reply)
{
  gateway_code_ = reply.gateway_code;
  exchanges_without_data_ = std::min(exchanges_without_data_ + 1, offline_after_);
}

void Link::answered(const wire::Reply& reply)
{
  last_answer_ = reply.finished_at;
  slowest_reply_ = std::max(slowest_reply_, reply.turnaround);
  if (offline_)
  {
    trial_.begin();
    return;
  }
  error_ = 0;
}

void Link::dataRead()
{
  exchanges_without_data_ = 0;
}

void Link::failed(std::uint16_t error_id)
{
  error_ = error_id;
}

void Link::probed(const wire::Reply& reply)
{
  // One that is answered is no status: what was missing is still missing.
  const bool port_is_back = error_ == wire::ERROR_PORT_LOST;
  const bool answered = reply.outcome == wire::Outcome::Ok;
  if (offline_ && (!answered || port_is_back))
  {
    error_ = answered ? wire::ERROR_TIMEOUT : reply.error_id;
  }
}

void Link::cameLate(Duration delay)
{
  latest_reply_ = std::max(latest_reply_, delay);
}

void Link::goOffline(std::uint16_t error_id)
{
  offline_ = true;
  known_ = false;
  error_ = error_id;
  trial_.drop();
}

bool Link::statusComplete()
{
  const bool back = offline_;
  if (back)
  {
    offline_ = false;
    error_ = 0;
    trial_.drop();
    ++returns_;
  }
  known_ = true;
  ever_known_ = true;
  return back;
}

// --- an offline inverter that answers --------------------------------------------------------------------------------

void Link::noteCost(bool probe, wire::Outcome outcome, Duration cost)
{
  trial_.exchangeEnded(offline_ && probe, outcome, cost);
}

void Link::beginTrial(Duration delay)
{
  if (offline_ && trial_.beginLate())
  {
    slowest_reply_ = std::max(slowest_reply_, delay);
  }
}

Duration Link::endTrial()
{
  return trial_.end();
}

bool Link::onTrial() const
{
  return trial_.underWay();
}

bool Link::silent() const
{
  return offline_ && !trial_.underWay();
}

// --- answers ---------------------------------------------------------------------------------------------------------

bool Link::offline() const
{
  return offline_;
}

bool Link::known() const
{
  return known_;
}

bool Link::everKnown() const
{
  return ever_known_;
}

bool Link::sendsData() const
{
  return exchanges_without_data_ < offline_after_;
}

std::uint16_t Link::error() const
{
  return error_;
}

std::uint8_t Link::gatewayCode() const
{
  return gateway_code_;
}

const std::optional<TimePoint>& Link::lastAnswer() const
{
  return last_answer_;
}

Duration Link::slowestReply() const
{
  return slowest_reply_;
}

Duration Link::latestReply() const
{
  return latest_reply_;
}

std::uint64_t Link::returns() const
{
  return returns_;
}
}  // namespace bus
}  // namespace inverter_bus
